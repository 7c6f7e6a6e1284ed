// SPDX-License-Identifier: Apache-2.0
// Commands of one axis: which it can have, and their steps.
#include <algorithm>

#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

/// The mode and the quantities a command cannot do without.
struct Needs {
  std::int16_t mode = 0;
  std::vector<Quantity> quantities;
};

Needs needs_of(Command command, bool is_virtual) {
  switch (command) {
    case Command::move_absolute:
    case Command::move_relative:
      return {1, {Quantity::target_position}};
    case Command::run_velocity:
      return {3, {Quantity::target_velocity}};
    case Command::run_torque:
      return {4, {Quantity::target_torque, Quantity::max_velocity}};
    case Command::home:
      return {6, {Quantity::homing_method}};
    case Command::set_position:
      if (is_virtual) return {0, {Quantity::position_actual}};  // by the drive's own command, in no mode
      return {6, {Quantity::homing_method, Quantity::position_actual}};
    default:
      return {};
  }
}

bool has_mode(const model::AxisModel& axis, std::int16_t mode) {
  return std::ranges::any_of(axis.modes, [&](const auto& row) { return row.first == mode; });
}

std::optional<model::Steps> steps_from(const Resolving& r, const std::vector<StepSpec>& specs, AxisSlot slot) {
  model::Steps out;
  for (const StepSpec& spec : specs) {
    model::Step step;
    step.verb = spec.verb;
    step.object = r.id(spec.object, slot);
    if (step.object == model::kNoObject) return std::nullopt;
    step.limit = spec.limit;
    step.optional = spec.optional;
    step.otherwise = spec.otherwise;
    if (spec.verb != model::Step::Verb::write) {
      const std::optional<model::Condition> until = r.condition(spec.until, slot);
      if (!until) return std::nullopt;
      step.until = *until;
    } else if (const auto* quantity = std::get_if<Quantity>(&spec.values.front())) {
      step.source = model::Step::Source::quantity;
      step.quantity = *quantity;
      if (r.model.axes[slot].binding(*quantity) == nullptr) return std::nullopt;
    } else if (std::holds_alternative<SetPositionValue>(spec.values.front())) {
      step.source = model::Step::Source::set_position;
      step.quantity = Quantity::position_actual;
      if (r.model.axes[slot].binding(step.quantity) == nullptr) return std::nullopt;
    } else {
      const std::optional<std::int64_t> raw = r.raw(spec.values, spec.object, slot);
      if (!raw) return std::nullopt;
      step.literal = *raw;
    }
    out.push_back(std::move(step));
  }
  return out;
}

std::optional<model::CommandDef> command_from(const Resolving& r, const CommandSpec& spec, AxisSlot slot) {
  const model::AxisModel& axis = r.model.axes[slot];
  const Needs needs = needs_of(spec.command, axis.virtual_axis.has_value());
  if (needs.mode != 0 && !has_mode(axis, needs.mode)) return std::nullopt;
  if (std::ranges::any_of(needs.quantities, [&](Quantity q) { return axis.binding(q) == nullptr; }))
    return std::nullopt;
  model::CommandDef out;
  out.zero_only = spec.zero_only;
  out.quick_stop_otherwise = spec.quick_stop_otherwise;
  out.repeat_on_change = spec.repeat_on_change;
  for (const CommandSpec::Variant& variant : spec.variants) {
    std::optional<model::Steps> steps = steps_from(r, variant.steps, slot);
    if (steps)
      out.variants.push_back({variant.modes, std::move(*steps)});
    else if (!spec.quick_stop_otherwise)
      return std::nullopt;
  }
  std::optional<model::Steps> steps = steps_from(r, spec.steps, slot);
  if (!steps) return std::nullopt;
  out.steps = std::move(*steps);
  return out;
}

const CommandSpec* spec_for(const Profile& profile, Command command, const std::string& protocol) {
  const CommandSpec* general = nullptr;
  for (const CommandSpec& spec : profile.commands) {
    if (spec.command != command) continue;
    if (spec.protocol == protocol) return &spec;
    if (spec.protocol.empty()) general = &spec;
  }
  return general;
}

}  // namespace

void resolve_commands(Resolving& r, AxisSlot slot) {
  model::AxisModel& axis = r.model.axes[slot];
  for (std::uint8_t number = 1; number <= kLastCommand; ++number) {
    const auto command = static_cast<Command>(number);
    const CommandSpec* spec = spec_for(r.profile, command, r.input.protocol);
    if (spec == nullptr && command != Command::halt) continue;
    if (spec != nullptr && spec->as_absolute) {
      // Without steps of its own the planner carries it out as the absolute move it comes to.
      if (axis.command(Command::move_absolute)) axis.supported_commands |= 1U << number;
      continue;
    }
    if (spec != nullptr) axis.commands[number] = command_from(r, *spec, slot);
    // "Where a drive has no halt, the profile names the replacement, else quick_stop" (design 3.4).
    if (command == Command::halt && !axis.commands[number]) axis.commands[number].emplace().quick_stop_otherwise = true;
    if (axis.commands[number]) axis.supported_commands |= 1U << number;
  }
}

}  // namespace axisgate::profile
