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

Errc outcome_named(const std::string& name) {
  if (name == "busy") return Errc::busy;
  if (name == "bad_value") return Errc::bad_value;
  if (name == "not_reached") return Errc::not_reached;
  return Errc::state_unsuitable;
}

void read_write_step(Reading& reading, const JsonNode& node, StepSpec& out) {
  out.verb = model::Step::Verb::write;
  out.object = node.text("write");
  const JsonNode value = node["value"];
  if (!value) reading.fault(node.pointer(), "a write needs a \"value\"");
  out.values = reading.values(value);
  reading.each_named(out.object, node.pointer("write"), [&](const Object& object) {
    reading.needs_writable(object, node.pointer("write"));
    for (const ValueSpec& one : out.values) {
      reading.value_fits(one, object, value.pointer());
      reading.value_known(one, object, value.pointer());
    }
  });
}

void read_condition_step(Reading& reading, const JsonNode& node, StepSpec& out) {
  const bool waits = node.has("wait");
  out.verb = waits ? model::Step::Verb::wait : model::Step::Verb::require;
  out.object = node.text(waits ? "wait" : "require");
  out.until = reading.condition(node, out.object);
  const std::int64_t ms = node.whole("ms", 0);
  if (waits && ms <= 0) reading.fault(node.pointer(), "a wait needs a limit: \"ms\"");
  if (!waits && node.has("ms"))
    reading.fault(node.pointer("ms"), "a require is judged once and has no limit; to wait, use \"wait\"");
  out.limit = milliseconds(ms);
  out.optional = node.flag("optional", false);
  out.otherwise = waits ? Errc::not_reached : outcome_named(node.text("else"));
}

std::vector<StepSpec> read_steps(Reading& reading, const JsonNode& owner) {
  std::vector<StepSpec> out;
  for (const JsonNode& node : owner["steps"].elements()) {
    if (node.has("write") + node.has("wait") + node.has("require") != 1) {
      reading.fault(node.pointer(), "a step is exactly one of \"write\", \"wait\" and \"require\"");
      continue;
    }
    StepSpec& step = out.emplace_back();
    step.pointer = node.pointer();
    if (node.has("write"))
      read_write_step(reading, node, step);
    else
      read_condition_step(reading, node, step);
  }
  return out;
}

void read_variants(Reading& reading, const JsonNode& node, CommandSpec& out) {
  std::set<std::int64_t> named;
  for (const JsonNode& entry : node["variants"].elements()) {
    CommandSpec::Variant variant;
    const JsonNode modes = entry["modes"];
    for (const JsonNode& number : modes.elements()) {
      const std::int64_t mode = number.whole().value_or(0);
      if (!named.insert(mode).second) reading.fault(modes.pointer(), "mode {} is named twice", mode);
      reading.names_mode(mode, modes.pointer());
      variant.modes.push_back(static_cast<std::int16_t>(mode));
    }
    variant.steps = read_steps(reading, entry);
    out.variants.push_back(std::move(variant));
  }
}

/// Row 78 is converted as position_actual is: what it is written to must count alike.
void check_set_position_value(Reading& reading, const CommandSpec& command, const StepSpec& step) {
  if (std::ranges::none_of(step.values,
                           [](const ValueSpec& value) { return std::holds_alternative<SetPositionValue>(value); }))
    return;
  const std::string pointer = pointer_to(step.pointer, "value");
  if (command.command != Command::set_position)
    return reading.fault(pointer, "\"set_position_value\" belongs to the steps of set_position");
  const QuantitySpec* actual = reading.profile.find(Quantity::position_actual);
  if (actual == nullptr)
    return reading.fault(pointer, "\"set_position_value\" counts as position_actual, which this profile does not have");
  reading.each_meaning(step.object, [&](const Object& written) {
    reading.each_object_of(Quantity::position_actual, [&](const Object& read) {
      if (written.unit != actual->unit_of(read))
        reading.fault(pointer, "object \"{}\" must have the unit of position_actual", written.name);
    });
  });
}

/// Answered as done, the motor would go on.
void check_stops(Reading& reading, const CommandSpec& command, const JsonNode& node) {
  if (!is_stop(command.command)) return;
  const auto check = [&](const std::vector<StepSpec>& steps, const std::string& pointer) {
    if (std::ranges::find(steps, model::Step::Verb::write, &StepSpec::verb) == steps.end())
      reading.fault(pointer, "write nothing, so they stop nothing");
    else
      check_stops_by_word(reading, command, steps, pointer);
  };
  if (node.has("steps")) check(command.steps, node.pointer("steps"));
  for (std::size_t i = 0; i < command.variants.size(); ++i)
    check(command.variants[i].steps, node["variants"][i].pointer("steps"));
}

/// On a CiA 402 drive the gateway carries it out in homing mode, by method 35: in a mode that moves, a controlword
/// would start the target that the drive still holds.
void check_starts_nothing(Reading& reading, const CommandSpec& command) {
  if (command.command != Command::set_position || reading.profile.state.is_virtual) return;
  bool commands = false;
  each_write(command, [&](const StepSpec& step) {
    commands = commands || is_of(reading, step.object, Quantity::controlword);
    if (is_of(reading, step.object, Quantity::mode))
      reading.fault(pointer_to(step.pointer, "write"),
                    "set_position must not change the mode: an old target could start in it. Leave this step out: "
                    "the gateway goes to homing mode (6) before the first step, and back after the last");
  });
  if (!commands) return;
  if (!reading.profile.modes.contains(kHomingMode) || reading.profile.find(Quantity::homing_method) == nullptr)
    reading.fault(command.pointer,
                  "its steps write the controlword, which in a mode that moves starts an old target, so they are "
                  "carried out in homing mode by method 35: add mode \"6\" to /modes and quantity \"homing_method\", "
                  "or leave set_position out");
}

/// Keys that only one command has.
void read_options(Reading& reading, const JsonNode& node, CommandSpec& out) {
  out.zero_only = node.flag("zero_only", false);
  if (out.zero_only && out.command != Command::set_position)
    reading.fault(node.pointer("zero_only"), "belongs to set_position");
  out.repeat_on_change = node.flag("repeat_on_change", false);
  if (out.repeat_on_change && out.command != Command::run_velocity)
    reading.fault(node.pointer("repeat_on_change"), "belongs to run_velocity");
  out.as_absolute = node.has("as");
  if (out.as_absolute && (out.command != Command::move_relative || node.has("steps") || node.has("variants")))
    reading.fault(node.pointer("as"), "stands for the steps of move_relative, and for no others");
  out.quick_stop_otherwise = node.has("otherwise");
  if (out.quick_stop_otherwise && out.command != Command::halt)
    reading.fault(node.pointer("otherwise"), "only halt can be replaced by quick_stop");
}

void read_command(Reading& reading, const JsonNode& node) {
  CommandSpec out;
  out.pointer = node.pointer();
  const std::string key = node.key();
  const std::size_t at = key.find('@');
  const std::string name = key.substr(0, at);
  const auto* const command = std::ranges::find(kCommands, name, [](Command each) { return axisgate::text(each); });
  if (command == kCommands.end()) {
    std::vector<std::string> known;
    for (const Command each : kCommands) known.emplace_back(axisgate::text(each));
    return reading.fault(node.pointer(), "unknown command \"{}\"{}", name, did_you_mean(name, known));
  }
  out.command = *command;
  if (at != std::string::npos) {
    out.protocol = key.substr(at + 1);
    reading.names_protocol(out.protocol, node.pointer());
  }
  read_options(reading, node, out);
  read_variants(reading, node, out);
  out.steps = read_steps(reading, node);
  each_step(out, [&](const StepSpec& step) { check_set_position_value(reading, out, step); });
  check_starts_nothing(reading, out);
  check_stops(reading, out, node);
  check_never_enables(reading, out);
  check_enable_starts_nothing(reading, out);
  check_turns_nothing(reading, out);
  if (!node.has("steps") && !out.quick_stop_otherwise && !out.as_absolute)
    reading.fault(node.pointer(), "says nothing for modes without a variant: give \"steps\"{}",
                  out.command == Command::halt ? " or \"otherwise\": \"quick_stop\"" : "");
  if (out.quick_stop_otherwise && node.has("steps"))
    reading.fault(node.pointer(), "\"steps\" and \"otherwise\" exclude each other");
  reading.profile.commands.push_back(std::move(out));
}

}  // namespace

void read_commands(Reading& reading) {
  const JsonNode section = reading.document["commands"];
  if (!section.is_object()) return;
  for (const JsonNode& node : section.members()) read_command(reading, node);
  // Without these no axis is safe: nothing could stop it.
  for (const Command command : kCommands)
    if (is_stop(command) && command != Command::halt &&
        std::ranges::find(reading.profile.commands, command, &CommandSpec::command) == reading.profile.commands.end())
      reading.fault("/commands", "command \"{}\" is missing: every drive must have one", axisgate::text(command));
}

}  // namespace axisgate::profile
