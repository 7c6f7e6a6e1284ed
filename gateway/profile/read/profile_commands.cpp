// SPDX-License-Identifier: Apache-2.0
// Section "commands": how each command is carried out, in steps.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

constexpr std::array<std::pair<std::string_view, Command>, 12> kCommands{{
    {"enable", Command::enable},
    {"disable", Command::disable},
    {"quick_stop", Command::quick_stop},
    {"halt", Command::halt},
    {"fault_reset", Command::fault_reset},
    {"move_absolute", Command::move_absolute},
    {"move_relative", Command::move_relative},
    {"run_velocity", Command::run_velocity},
    {"run_torque", Command::run_torque},
    {"home", Command::home},
    {"set_position", Command::set_position},
    {"save_parameters", Command::save_parameters},
}};

constexpr std::int16_t kHomingMode = 6;

std::optional<Command> command_named(std::string_view name) {
  const auto at = std::find_if(kCommands.begin(), kCommands.end(), [&](const auto& row) { return row.first == name; });
  return at == kCommands.end() ? std::nullopt : std::optional(at->second);
}

Errc outcome_named(const std::string& name) {
  if (name == "busy") return Errc::busy;
  if (name == "bad_value") return Errc::bad_value;
  if (name == "not_reached") return Errc::not_reached;
  return Errc::state_unsuitable;
}

class StepReader {
 public:
  explicit StepReader(Reading& reading) : reading_(reading) {}

  std::vector<StepSpec> read(const json& owner, const std::string& pointer) {
    std::vector<StepSpec> out;
    const json* steps = member(owner, "steps");
    if (steps == nullptr || !steps->is_array()) return out;
    for (std::size_t i = 0; i < steps->size(); ++i) {
      const std::string at = pointer_to(pointer_to(pointer, "steps"), i);
      if (std::optional<StepSpec> step = read_step((*steps)[i], at)) out.push_back(std::move(*step));
    }
    return out;
  }

 private:
  std::optional<StepSpec> read_step(const json& node, const std::string& pointer) {
    const int verbs =
        (member(node, "write") != nullptr) + (member(node, "wait") != nullptr) + (member(node, "require") != nullptr);
    if (verbs != 1) {
      reading_.fault(pointer, "a step is exactly one of \"write\", \"wait\" and \"require\"");
      return std::nullopt;
    }
    StepSpec out;
    out.pointer = pointer;
    if (member(node, "write") != nullptr) {
      write(node, out);
    } else {
      out.verb = member(node, "wait") != nullptr ? model::Step::Verb::wait : model::Step::Verb::require;
      out.object = text_in(node, out.verb == model::Step::Verb::wait ? "wait" : "require");
      out.until = reading_.condition(node, out.object, pointer);
      timing(node, out);
    }
    return out;
  }

  void write(const json& node, StepSpec& out) {
    out.verb = model::Step::Verb::write;
    out.object = text_in(node, "write");
    const std::string at = pointer_to(out.pointer, "value");
    const json* value = member(node, "value");
    if (value == nullptr)
      reading_.fault(out.pointer, "a write needs a \"value\"");
    else
      out.values = reading_.values(*value, at);
    if (!reading_.names_object(out.object, pointer_to(out.pointer, "write"))) return;
    reading_.each_meaning(out.object, [&](const Object& object) {
      if (!object.writable)
        reading_.fault(pointer_to(out.pointer, "write"), "object \"" + object.name + "\" is read-only");
      for (const ValueSpec& one : out.values) {
        reading_.value_fits(one, object, at);
        reading_.value_known(one, object, at);
      }
    });
  }

  void timing(const json& node, StepSpec& out) {
    const std::int64_t ms = whole_in(node, "ms", 0);
    if (out.verb == model::Step::Verb::wait && ms <= 0) reading_.fault(out.pointer, "a wait needs a limit: \"ms\"");
    if (out.verb == model::Step::Verb::require && member(node, "ms") != nullptr)
      reading_.fault(pointer_to(out.pointer, "ms"), "a require is judged once and has no limit; to wait, use \"wait\"");
    out.limit = std::chrono::milliseconds(ms);
    out.optional = flag_in(node, "optional", false);
    out.otherwise = out.verb == model::Step::Verb::wait ? Errc::not_reached : outcome_named(text_in(node, "else"));
  }

  Reading& reading_;
};

void read_variants(Reading& reading, const json& node, CommandSpec& out) {
  const json* variants = member(node, "variants");
  if (variants == nullptr || !variants->is_array()) return;
  std::set<std::int64_t> named;
  for (std::size_t i = 0; i < variants->size(); ++i) {
    const std::string at = pointer_to(pointer_to(out.pointer, "variants"), i);
    CommandSpec::Variant variant;
    if (const json* modes = member((*variants)[i], "modes"); modes != nullptr && modes->is_array()) {
      for (const json& entry : *modes) {
        const std::int64_t mode = whole(entry).value_or(0);
        if (!named.insert(mode).second)
          reading.fault(pointer_to(at, "modes"), "mode " + std::to_string(mode) + " is named twice");
        if (!reading.profile.modes.contains(static_cast<std::int16_t>(mode)))
          reading.fault(pointer_to(at, "modes"), "mode " + std::to_string(mode) + " is not under /modes");
        variant.modes.push_back(static_cast<std::int16_t>(mode));
      }
    }
    variant.steps = StepReader(reading).read((*variants)[i], at);
    out.variants.push_back(std::move(variant));
  }
}

/// Row 78 is converted as position_actual is: what it is written to must count alike.
void check_set_position_value(Reading& reading, const CommandSpec& command, const StepSpec& step) {
  if (std::none_of(step.values.begin(), step.values.end(),
                   [](const ValueSpec& value) { return std::holds_alternative<SetPositionValue>(value); }))
    return;
  const std::string pointer = pointer_to(step.pointer, "value");
  if (command.command != Command::set_position)
    return reading.fault(pointer, "\"set_position_value\" belongs to the steps of set_position");
  const QuantitySpec* actual = reading.profile.find(Quantity::position_actual);
  if (actual == nullptr)
    return reading.fault(pointer, "\"set_position_value\" counts as position_actual, which this profile does not have");
  reading.each_meaning(step.object, [&](const Object& written) {
    for (const std::string& name : actual->objects)
      reading.each_meaning(name, [&](const Object& read) {
        if (written.unit != actual->unit_of(read))
          reading.fault(pointer, "object \"" + written.name + "\" must have the unit of position_actual");
      });
  });
}

/// Answered as done, the motor would go on.
void check_stops(Reading& reading, const CommandSpec& command, const json& node) {
  if (!is_stop(command.command)) return;
  const auto check = [&](const std::vector<StepSpec>& steps, const std::string& pointer) {
    if (std::none_of(steps.begin(), steps.end(),
                     [](const StepSpec& step) { return step.verb == model::Step::Verb::write; }))
      reading.fault(pointer_to(pointer, "steps"), "write nothing, so they stop nothing");
    else
      check_stops_by_word(reading, command, steps, pointer_to(pointer, "steps"));
  };
  if (member(node, "steps") != nullptr) check(command.steps, command.pointer);
  for (std::size_t i = 0; i < command.variants.size(); ++i)
    check(command.variants[i].steps, pointer_to(pointer_to(command.pointer, "variants"), i));
}

/// On a CiA 402 drive the gateway carries it out in homing mode, by method 35: in a mode that moves, a controlword
/// would start the target that the drive still holds.
void check_starts_nothing(Reading& reading, const CommandSpec& command) {
  if (command.command != Command::set_position || reading.profile.state.is_virtual) return;
  bool commands = false;
  const auto check = [&](const std::vector<StepSpec>& steps) {
    for (const StepSpec& step : steps) {
      if (step.verb != model::Step::Verb::write) continue;
      commands = commands || is_of(reading, step.object, Quantity::controlword);
      if (is_of(reading, step.object, Quantity::mode))
        reading.fault(pointer_to(step.pointer, "write"),
                      "set_position must not change the mode: an old target could start in it. Leave this step out: "
                      "the gateway goes to homing mode (6) before the first step, and back after the last");
    }
  };
  check(command.steps);
  for (const CommandSpec::Variant& variant : command.variants) check(variant.steps);
  if (!commands) return;
  if (!reading.profile.modes.contains(kHomingMode) || reading.profile.find(Quantity::homing_method) == nullptr)
    reading.fault(command.pointer,
                  "its steps write the controlword, which in a mode that moves starts an old target, so they are "
                  "carried out in homing mode by method 35: add mode \"6\" to /modes and quantity \"homing_method\", "
                  "or leave set_position out");
}

void check_values(Reading& reading, const CommandSpec& command) {
  for (const StepSpec& step : command.steps) check_set_position_value(reading, command, step);
  for (const CommandSpec::Variant& variant : command.variants)
    for (const StepSpec& step : variant.steps) check_set_position_value(reading, command, step);
}

/// Keys that only one command has.
void read_options(Reading& reading, const json& node, CommandSpec& out) {
  out.zero_only = flag_in(node, "zero_only", false);
  if (out.zero_only && out.command != Command::set_position)
    reading.fault(pointer_to(out.pointer, "zero_only"), "belongs to set_position");
  out.repeat_on_change = flag_in(node, "repeat_on_change", false);
  if (out.repeat_on_change && out.command != Command::run_velocity)
    reading.fault(pointer_to(out.pointer, "repeat_on_change"), "belongs to run_velocity");
  out.as_absolute = member(node, "as") != nullptr;
  if (out.as_absolute && (out.command != Command::move_relative || member(node, "steps") != nullptr ||
                          member(node, "variants") != nullptr))
    reading.fault(pointer_to(out.pointer, "as"), "stands for the steps of move_relative, and for no others");
  out.quick_stop_otherwise = member(node, "otherwise") != nullptr;
  if (out.quick_stop_otherwise && out.command != Command::halt)
    reading.fault(pointer_to(out.pointer, "otherwise"), "only halt can be replaced by quick_stop");
}

void read_command(Reading& reading, const std::string& key, const json& node) {
  CommandSpec out;
  out.pointer = pointer_to("/commands", key);
  const std::size_t at = key.find('@');
  const std::string name = key.substr(0, at);
  if (at != std::string::npos) out.protocol = key.substr(at + 1);
  const std::optional<Command> command = command_named(name);
  if (!command) {
    std::vector<std::string> known;
    for (const auto& [text, unused] : kCommands) known.emplace_back(text);
    return reading.fault(out.pointer, "unknown command \"" + name + "\"" + did_you_mean(name, known));
  }
  out.command = *command;
  if (at != std::string::npos && !reading.profile.protocols.contains(out.protocol))
    reading.fault(out.pointer, "protocol \"" + out.protocol + "\" is not under /protocols" +
                                   did_you_mean(out.protocol, keys_in(reading.profile.protocols)));
  read_options(reading, node, out);
  read_variants(reading, node, out);
  out.steps = StepReader(reading).read(node, out.pointer);
  check_values(reading, out);
  check_starts_nothing(reading, out);
  check_stops(reading, out, node);
  check_never_enables(reading, out);
  check_enable_starts_nothing(reading, out);
  check_turns_nothing(reading, out);
  const bool everywhere = member(node, "steps") != nullptr || out.quick_stop_otherwise || out.as_absolute;
  if (!everywhere)
    reading.fault(out.pointer,
                  "says nothing for modes without a variant: give \"steps\"" +
                      std::string(out.command == Command::halt ? " or \"otherwise\": \"quick_stop\"" : ""));
  if (out.quick_stop_otherwise && member(node, "steps") != nullptr)
    reading.fault(out.pointer, "\"steps\" and \"otherwise\" exclude each other");
  reading.profile.commands.push_back(std::move(out));
}

}  // namespace

void read_commands(Reading& reading) {
  const json* section = member(reading.document, "commands");
  if (section == nullptr || !section->is_object()) return;
  for (const auto& [key, node] : section->items()) read_command(reading, key, node);
  const auto has = [&](Command command) {
    return std::any_of(reading.profile.commands.begin(), reading.profile.commands.end(),
                       [&](const CommandSpec& spec) { return spec.command == command; });
  };
  // Without these no axis is safe: nothing could stop it.
  for (const auto& [name, command] : kCommands)
    if (is_stop(command) && command != Command::halt && !has(command))
      reading.fault("/commands", "command \"" + std::string(name) + "\" is missing: every drive must have one");
}

}  // namespace axisgate::profile
