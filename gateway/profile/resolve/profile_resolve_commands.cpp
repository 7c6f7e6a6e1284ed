// SPDX-License-Identifier: Apache-2.0
// Commands of one axis: which it can have, and their steps.
#include <algorithm>

#include "gateway/core/name_table.hpp"
#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

/// The mode and the quantities a command cannot do without.
struct Needs {
  std::int16_t mode = 0;
  std::vector<Quantity> quantities;
};

Needs needs_of(Command command, bool is_virtual) {
  using enum Quantity;
  static const std::map<Command, Needs> kNeeds{{Command::move_absolute, {1, {target_position}}},
                                               {Command::move_relative, {1, {target_position}}},
                                               {Command::run_velocity, {3, {target_velocity}}},
                                               {Command::run_torque, {4, {target_torque, max_velocity}}},
                                               {Command::home, {6, {homing_method}}},
                                               {Command::set_position, {6, {homing_method, position_actual}}}};
  // By the drive's own command, in no mode.
  if (is_virtual && command == Command::set_position) return {0, {position_actual}};
  const auto at = kNeeds.find(command);
  return at == kNeeds.end() ? Needs{} : at->second;
}

bool has_mode(const model::AxisModel& axis, std::int16_t mode) {
  return std::ranges::any_of(axis.modes, [&](const auto& row) { return row.first == mode; });
}

constexpr auto kOutcomes =
    names_of<Errc>({{Errc::busy, "busy"}, {Errc::bad_value, "bad_value"}, {Errc::not_reached, "not_reached"}});

/// None of them: what is written cannot be had on this axis.
bool put_value(const Resolving& r, const JsonNode& node, AxisSlot slot, model::Step& out) {
  const WriteValue value = r.value_of(node, slot);
  if (const auto* quantity = std::get_if<Quantity>(&value)) {
    out.source = model::Step::Source::quantity;
    out.quantity = *quantity;
  } else if (std::holds_alternative<SetPositionValue>(value)) {
    out.source = model::Step::Source::set_position;
    out.quantity = Quantity::position_actual;
  } else {
    const std::optional<std::int64_t> raw = r.raw(value, node.text("write"), slot);
    out.literal = raw.value_or(0);
    return raw.has_value();
  }
  return r.model.axes[slot].binding(out.quantity) != nullptr;
}

std::optional<model::Steps> steps_from(const Resolving& r, const JsonNode& owner, AxisSlot slot) {
  using enum model::Step::Verb;
  model::Steps out;
  for (const JsonNode& node : owner["steps"].elements()) {
    model::Step step;
    const char* verb = node.has("write") ? "write" : node.has("wait") ? "wait" : "require";
    step.verb = node.has("write") ? write : node.has("wait") ? wait : require;
    step.object = r.id(node.text(verb), slot);
    if (step.object == model::kNoObject) return std::nullopt;
    step.limit = node.milliseconds("ms", {});
    step.optional = node.flag("optional", false);
    step.otherwise =
        step.verb == wait ? Errc::not_reached : kOutcomes.named(node.text("else")).value_or(step.otherwise);
    if (step.verb == write) {
      if (!put_value(r, node, slot, step)) return std::nullopt;
    } else {
      step.until = r.condition(node, slot, verb).value();  // its object is there
    }
    if (node.flag("joined", false) && r.input.protocol == "modbus-rtu") out.back().joined = true;
    out.push_back(std::move(step));
  }
  return out;
}

std::optional<model::CommandDef> command_from(const Resolving& r, const CommandEntry& entry, AxisSlot slot) {
  const model::AxisModel& axis = r.model.axes[slot];
  const Needs needs = needs_of(entry.command, axis.virtual_axis.has_value());
  if (needs.mode != 0 && !has_mode(axis, needs.mode)) return std::nullopt;
  if (std::ranges::any_of(needs.quantities, [&](Quantity q) { return axis.binding(q) == nullptr; }))
    return std::nullopt;
  model::CommandDef out;
  out.zero_only = entry.node.flag("zero_only", false);
  out.quick_stop_otherwise = entry.node.has("otherwise");
  out.repeat_on_change = entry.node.flag("repeat_on_change", false);
  for (const JsonNode& variant : entry.node["variants"].elements()) {
    std::optional<model::Steps> steps = steps_from(r, variant, slot);
    if (!steps && !out.quick_stop_otherwise) return std::nullopt;
    if (!steps) continue;
    model::CommandDef::Variant& to = out.variants.emplace_back();
    for (const std::int64_t mode : variant.wholes("modes")) to.modes.push_back(static_cast<std::int16_t>(mode));
    to.steps = std::move(*steps);
  }
  std::optional<model::Steps> steps = steps_from(r, entry.node, slot);
  if (!steps) return std::nullopt;
  out.steps = std::move(*steps);
  return out;
}

const CommandEntry* entry_for(const Profile& profile, Command command, const std::string& protocol) {
  const CommandEntry* general = nullptr;
  for (const CommandEntry& entry : profile.commands) {
    if (entry.command != command) continue;
    if (entry.protocol == protocol) return &entry;
    if (entry.protocol.empty()) general = &entry;
  }
  return general;
}

}  // namespace

void resolve_commands(Resolving& r, AxisSlot slot) {
  model::AxisModel& axis = r.model.axes[slot];
  for (std::uint8_t number = 1; number <= kLastCommand; ++number) {
    const auto command = static_cast<Command>(number);
    const CommandEntry* entry = entry_for(r.profile, command, r.input.protocol);
    if (entry == nullptr && command != Command::halt) continue;
    if (entry != nullptr && entry->node.has("as")) {
      // Without steps of its own the planner carries it out as the absolute move it comes to.
      if (axis.command(Command::move_absolute)) axis.supported_commands |= 1U << number;
      continue;
    }
    if (entry != nullptr) axis.commands[number] = command_from(r, *entry, slot);
    // "Where a drive has no halt, the profile names the replacement, else quick_stop" (design 3.4).
    if (command == Command::halt && !axis.commands[number]) axis.commands[number].emplace().quick_stop_otherwise = true;
    if (axis.commands[number]) axis.supported_commands |= 1U << number;
  }
}

}  // namespace axisgate::profile
