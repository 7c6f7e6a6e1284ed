// SPDX-License-Identifier: Apache-2.0
// Section "commands": how each command is carried out, in steps.
#include <algorithm>
#include <array>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

/// Those that a drive carries out; what jogs and leases need is made of them.
constexpr std::array kCommands{Command::enable,        Command::disable,      Command::quick_stop,
                               Command::halt,          Command::fault_reset,  Command::move_absolute,
                               Command::move_relative, Command::run_velocity, Command::run_torque,
                               Command::home,          Command::set_position, Command::save_parameters};

constexpr std::int16_t kHomingMode = 6;

/// The holding register that a step writes; null: it writes none.
const Place* holding(const Reading& reading, const JsonNode& step, AxisSlot slot) {
  const Object* object = reading.profile.find(step.text("write"), slot);
  const Place* place = object == nullptr || object->is_part() ? nullptr : object->place("modbus-rtu");
  const bool holds = place != nullptr && place->address.sub == static_cast<std::uint8_t>(ModbusTable::holding);
  return holds ? place : nullptr;
}

/// Writes that go in one request: each begins where the one before ends, for as many registers as a request may have.
void check_joined(Reading& reading, const std::vector<JsonNode>& steps, std::size_t i) {
  const auto is_joined = [&](std::size_t k) { return k > 0 && steps[k].flag("joined", false); };
  const std::string at = steps[i].pointer("joined"), name = steps[i].text("write");
  if (!steps[i].flag("joined", false)) return;
  if (i == 0 || steps[i - 1].text("write").empty())
    return reading.fault(at, "goes in one request with a write: the step before must be one");
  const JsonNode rtu = reading.document["protocols"]["modbus-rtu"];
  if (!rtu) return reading.fault(at, "only modbus-rtu writes several objects in one request");
  for (const WriteValue& value : values_in(reading.profile, steps[i])) {
    const auto* quantity = std::get_if<Quantity>(&value);
    if (quantity != nullptr && (*quantity == Quantity::position_actual || !is_of(reading, name, *quantity)))
      reading.fault(steps[i].pointer("value"),
                    "a joined write gives its object a number, or what was asked of the quantity that is written by "
                    "this object");
  }
  const std::int64_t most = rtu.whole("max_registers", 2);
  for (std::size_t axis = 0; axis < reading.profile.axes.size(); ++axis) {
    const auto slot = static_cast<AxisSlot>(axis);
    if (reading.profile.find(name, slot) == nullptr) continue;  // told already
    const Place* mine = holding(reading, steps[i], slot);
    const Place* before = holding(reading, steps[i - 1], slot);
    if (mine == nullptr || before == nullptr || mine->address.index != before->address.index + registers_of(*before))
      reading.fault(at, "object \"{}\" must stand in the holding register behind \"{}\"",
                    reading.profile.find(name, slot)->name, steps[i - 1].text("write"));
    std::int64_t registers = mine == nullptr ? 0 : registers_of(*mine);
    for (std::size_t k = i; is_joined(k); --k)
      if (const Place* place = holding(reading, steps[k - 1], slot)) registers += registers_of(*place);
    if (registers > most)
      reading.fault(at, "makes a request of {} registers, and max_registers is {}", registers, most);
  }
}

void check_steps(Reading& reading, const JsonNode& owner) {
  const std::vector<JsonNode> steps = owner["steps"].elements();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const JsonNode& node = steps[i];
    check_joined(reading, steps, i);
    if (node.has("write") + node.has("wait") + node.has("require") != 1) {
      reading.fault(node.pointer(), "a step is exactly one of \"write\", \"wait\" and \"require\"");
    } else if (node.has("write")) {
      if (!node.has("value")) reading.fault(node.pointer(), "a write needs a \"value\"");
      for (const char* key : {"mask", "equals", "not_equals", "in", "not_in", "ms", "optional", "else"})
        if (node.has(key))
          reading.fault(node.pointer(key),
                        "belongs to \"wait\" and \"require\": a write puts its whole \"value\" there");
      reading.write(node, true, true);
    } else {
      const bool waits = node.has("wait");
      reading.condition(node, waits ? "wait" : "require");
      if (waits && node.whole("ms", 0) <= 0) reading.fault(node.pointer(), "a wait needs a limit: \"ms\"");
      if (node.has("joined")) reading.fault(node.pointer("joined"), "belongs to \"write\"");
      if (!waits && node.has("ms"))
        reading.fault(node.pointer("ms"), "a require is judged once and has no limit; to wait, use \"wait\"");
    }
  }
}

void check_variants(Reading& reading, const JsonNode& node) {
  std::set<std::int64_t> named;
  for (const JsonNode& variant : node["variants"].elements()) {
    const std::string at = variant.pointer("modes");
    for (const std::int64_t mode : variant.wholes("modes")) {
      if (!named.insert(mode).second) reading.fault(at, "mode {} is named twice", mode);
      reading.names_mode(mode, at);
    }
    check_steps(reading, variant);
  }
}

/// Row 78 is converted as position_actual is: what it is written to must count alike.
void check_set_position_value(Reading& reading, const CommandEntry& command, const JsonNode& step) {
  const auto is_it = [](const WriteValue& value) { return std::holds_alternative<SetPositionValue>(value); };
  if (std::ranges::none_of(values_in(reading.profile, step), is_it)) return;
  const std::string pointer = step.pointer("value");
  if (command.command != Command::set_position)
    return reading.fault(pointer, "\"set_position_value\" belongs to the steps of set_position");
  const QuantitySpec* actual = reading.profile.find(Quantity::position_actual);
  if (actual == nullptr)
    return reading.fault(pointer, "\"set_position_value\" counts as position_actual, which this profile does not have");
  reading.each_meaning(step.text("write"), [&](const Object& written) {
    reading.each_object_of(Quantity::position_actual, [&](const Object& read) {
      if (written.unit != actual->unit_of(read))
        reading.fault(pointer, "object \"{}\" must have the unit of position_actual", written.name);
    });
  });
}

/// On a CiA 402 drive the gateway carries out set_position in homing mode, by method 35.
void check_homing_mode(Reading& reading, const CommandEntry& command) {
  if (command.command != Command::set_position || reading.profile.state.is_virtual) return;
  bool commands = false;
  each_write(command, [&](const JsonNode& step) {
    commands = commands || is_of(reading, step.text("write"), Quantity::controlword);
  });
  if (commands && !(reading.profile.modes.contains(kHomingMode) && reading.profile.find(Quantity::homing_method)))
    reading.fault(command.pointer(),
                  "its steps write the controlword, which in a mode that moves starts an old target, so they are "
                  "carried out in homing mode by method 35: add mode \"6\" to /modes and quantity \"homing_method\", "
                  "or leave set_position out");
}

/// Keys that only one command has.
void check_options(Reading& reading, const CommandEntry& command) {
  const JsonNode& node = command.node;
  if (node.flag("zero_only", false) && command.command != Command::set_position)
    reading.fault(node.pointer("zero_only"), "belongs to set_position");
  if (node.flag("repeat_on_change", false) && command.command != Command::run_velocity)
    reading.fault(node.pointer("repeat_on_change"), "belongs to run_velocity");
  if (node.has("as") && (command.command != Command::move_relative || node.has("steps") || node.has("variants")))
    reading.fault(node.pointer("as"), "stands for the steps of move_relative, and for no others");
  if (node.has("otherwise") && command.command != Command::halt)
    reading.fault(node.pointer("otherwise"), "only halt can be replaced by quick_stop");
}

void read_command(Reading& reading, const JsonNode& node) {
  const std::string key = node.key();
  const std::size_t at = key.find('@');
  const std::string name = key.substr(0, at);
  const auto* const known = std::ranges::find(kCommands, name, [](Command each) { return axisgate::text(each); });
  if (known == kCommands.end()) {
    std::vector<std::string> names;
    for (const Command each : kCommands) names.emplace_back(axisgate::text(each));
    return reading.fault(node.pointer(), "unknown command \"{}\"{}", name, did_you_mean(name, names));
  }
  CommandEntry out{*known, at == std::string::npos ? "" : key.substr(at + 1), node};
  if (at != std::string::npos) reading.names_protocol(out.protocol, node.pointer());
  check_options(reading, out);
  check_variants(reading, node);
  check_steps(reading, node);
  each_write(out, [&](const JsonNode& step) { check_set_position_value(reading, out, step); });
  check_homing_mode(reading, out);
  check_stops(reading, out);
  check_writes(reading, out);
  if (!node.has("steps") && !node.has("otherwise") && !node.has("as"))
    reading.fault(node.pointer(), "says nothing for modes without a variant: give \"steps\"{}",
                  out.command == Command::halt ? " or \"otherwise\": \"quick_stop\"" : "");
  if (node.has("otherwise") && node.has("steps"))
    reading.fault(node.pointer(), "\"steps\" and \"otherwise\" exclude each other");
  reading.profile.commands.push_back(std::move(out));
}

}  // namespace

void read_commands(Reading& reading) {
  if (!reading.document["commands"].is_object()) return;
  for (const JsonNode& node : reading.document["commands"].members()) read_command(reading, node);
  // Without these no axis is safe: nothing could stop it.
  for (const Command command : kCommands)
    if (is_stop(command) && command != Command::halt &&
        std::ranges::find(reading.profile.commands, command, &CommandEntry::command) == reading.profile.commands.end())
      reading.fault("/commands", "command \"{}\" is missing: every drive must have one", axisgate::text(command));
}

}  // namespace axisgate::profile
