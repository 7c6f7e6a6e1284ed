// Modes, homing, commands and alarms of one axis, and what belongs to the whole drive: setup, checks, fence.
#include <algorithm>

#include "gateway/drive/profile_resolving.hpp"

namespace axisgate::drive {
namespace {

/// A mode whose set-point the gateway cannot give is not offered: what would run then is whatever the drive still
/// holds.
std::optional<Quantity> setpoint_of(std::int16_t mode) {
  switch (mode) {
    case 1:
    case 7:
    case 8:
      return Quantity::target_position;
    case 3:
    case 9:
      return Quantity::target_velocity;
    case 4:
    case 10:
      return Quantity::target_torque;
    case 6:
      return Quantity::homing_method;
    default:
      return std::nullopt;
  }
}

/// The mode and the quantities a command cannot do without.
struct Needs {
  std::int16_t mode = 0;
  std::vector<Quantity> quantities;
};

Needs needs_of(Command command) {
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
      return {6, {Quantity::homing_method, Quantity::position_actual}};
    default:
      return {};
  }
}

bool has_mode(const AxisModel& axis, std::int16_t mode) {
  return std::any_of(axis.modes.begin(), axis.modes.end(), [&](const auto& row) { return row.first == mode; });
}

std::optional<Steps> steps_from(const Resolving& r, const std::vector<StepSpec>& specs, bus::AxisSlot slot) {
  Steps out;
  for (const StepSpec& spec : specs) {
    Step step;
    step.verb = spec.verb;
    step.object = r.id(spec.object, slot);
    if (step.object == kNoObject) return std::nullopt;
    step.limit = spec.limit;
    step.optional = spec.optional;
    step.otherwise = spec.otherwise;
    if (spec.verb != Step::Verb::write) {
      const std::optional<Condition> until = r.condition(spec.until, slot);
      if (!until) return std::nullopt;
      step.until = *until;
    } else if (const auto* quantity = std::get_if<Quantity>(&spec.values.front())) {
      step.source = Step::Source::quantity;
      step.quantity = *quantity;
      if (r.model.axes[slot].binding(*quantity) == nullptr) return std::nullopt;
    } else {
      const std::optional<std::int64_t> raw = r.raw(spec.values, spec.object, slot);
      if (!raw) return std::nullopt;
      step.literal = *raw;
    }
    out.push_back(std::move(step));
  }
  return out;
}

std::optional<CommandDef> command_from(const Resolving& r, const CommandSpec& spec, bus::AxisSlot slot) {
  const AxisModel& axis = r.model.axes[slot];
  const Needs needs = needs_of(spec.command);
  if (needs.mode != 0 && !has_mode(axis, needs.mode)) return std::nullopt;
  if (std::any_of(needs.quantities.begin(), needs.quantities.end(),
                  [&](Quantity q) { return axis.binding(q) == nullptr; }))
    return std::nullopt;
  CommandDef out;
  out.zero_only = spec.zero_only;
  out.quick_stop_otherwise = spec.quick_stop_otherwise;
  for (const CommandSpec::Variant& variant : spec.variants) {
    std::optional<Steps> steps = steps_from(r, variant.steps, slot);
    if (steps)
      out.variants.push_back({variant.modes, std::move(*steps)});
    else if (!spec.quick_stop_otherwise)
      return std::nullopt;
  }
  std::optional<Steps> steps = steps_from(r, spec.steps, slot);
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

void resolve_roles(Resolving& r, bus::AxisSlot slot) {
  AxisModel& axis = r.model.axes[slot];
  const auto object_of = [&](Quantity quantity) {
    const Binding* binding = axis.binding(quantity);
    return binding == nullptr ? kNoObject : binding->object;
  };
  axis.statusword = object_of(Quantity::statusword);
  axis.controlword = object_of(Quantity::controlword);
  axis.mode = object_of(Quantity::mode);
  const ObjectId display = object_of(Quantity::mode_display);
  axis.mode_display = display == kNoObject ? axis.mode : display;
  axis.cia402.mode_display = axis.mode_display != axis.mode;
  axis.cia402.setpoint_acknowledge = r.profile.state.setpoint_acknowledge;
  for (std::size_t i = 0; i < r.profile.fault_words.size(); ++i)
    axis.fault_words[i] = r.id(r.profile.fault_words[i], slot);
  for (const std::string& name : r.profile.state.zero_before_enable)
    if (const ObjectId id = r.id(name, slot); id != kNoObject) axis.zero_before_enable.push_back(id);
  if (r.profile.state.moving) axis.moving = r.condition(*r.profile.state.moving, slot);
}

void resolve_checks(Resolving& r) {
  for (const CheckSpec& spec : r.profile.checks) {
    std::vector<ObjectId> seen;
    for (std::size_t i = 0; i < r.model.axes.size(); ++i) {
      const auto slot = static_cast<bus::AxisSlot>(i);
      std::optional<Condition> bad = r.condition(spec.bad, slot);
      if (!bad || std::find(seen.begin(), seen.end(), bad->object) != seen.end()) continue;
      seen.push_back(bad->object);
      Check out{spec.name, std::move(*bad), spec.alarm, r.model.object(seen.back()).slot, spec.text, {}};
      for (const WriteSpec& write : spec.remedy)
        if (const std::optional<ObjectWrite> one = r.write(write, slot)) out.remedy.push_back(*one);
      if (out.remedy.size() != spec.remedy.size()) out.remedy.clear();  // half a remedy is none
      r.model.checks.push_back(std::move(out));
    }
  }
}

void resolve_setup(Resolving& r) {
  for (const WriteSpec& spec : r.profile.setup) {
    if (!spec.on.empty() && std::find(spec.on.begin(), spec.on.end(), r.input.protocol) == spec.on.end()) continue;
    std::vector<ObjectId> seen;
    for (std::size_t i = 0; i < r.model.axes.size(); ++i) {
      const std::optional<ObjectWrite> write = r.write(spec, static_cast<bus::AxisSlot>(i));
      if (!write || std::find(seen.begin(), seen.end(), write->object) != seen.end()) continue;
      seen.push_back(write->object);
      r.model.setup.push_back(*write);
    }
  }
}

}  // namespace

void resolve_modes(Resolving& r, bus::AxisSlot slot) {
  resolve_roles(r, slot);
  AxisModel& axis = r.model.axes[slot];
  const ResolveAxis& input = r.input.axes[slot];
  axis.number = input.number;
  axis.name = input.name;
  axis.inverted = input.inverted;
  axis.standstill_velocity = input.standstill_velocity;
  axis.homing_timeout = input.homing_timeout;
  axis.homing_method = input.homing_method;
  axis.configured_torque_limit = input.torque_limit.has_value();
  for (const auto& [mode, raw] : r.profile.modes) {
    const std::optional<Quantity> setpoint = setpoint_of(mode);
    if (setpoint && axis.binding(*setpoint) == nullptr) continue;
    axis.modes.emplace_back(mode, raw);
    if (mode >= 1 && mode <= 16) axis.supported_modes |= static_cast<std::uint16_t>(1U << (mode - 1));
  }
  for (const auto& [method, raw] : r.profile.homing.methods) axis.homing_methods.push_back(method);
  if (r.profile.homing.homed) axis.homed = r.condition(*r.profile.homing.homed, slot);
  if (r.profile.homing.failed) axis.homing_failed = r.condition(*r.profile.homing.failed, slot);
  if (input.homing_method && !r.profile.homing.methods.contains(*input.homing_method)) {
    std::string known;
    for (const std::int16_t method : axis.homing_methods) known += (known.empty() ? "" : ", ") + std::to_string(method);
    r.fault("/axes/" + std::to_string(slot) + "/homing_method", "this drive has no homing method " +
                                                                    std::to_string(*input.homing_method) + ": it has " +
                                                                    (known.empty() ? "none" : known));
  }
}

void resolve_commands(Resolving& r, bus::AxisSlot slot) {
  AxisModel& axis = r.model.axes[slot];
  for (std::uint8_t number = 1; number <= kLastCommand; ++number) {
    const auto command = static_cast<Command>(number);
    const CommandSpec* spec = spec_for(r.profile, command, r.input.protocol);
    if (spec == nullptr) continue;
    axis.commands[number] = command_from(r, *spec, slot);
    if (axis.commands[number]) axis.supported_commands |= 1U << number;
  }
}

void resolve_drive(Resolving& r) {
  const ProtocolSpec& protocol = r.profile.protocols.find(r.input.protocol)->second;
  r.model.profile = r.profile.name;
  r.model.title = r.profile.title;
  r.model.protocol = r.input.protocol;
  r.model.node = r.input.node;
  r.model.poll_period = r.input.poll;
  r.model.stops_by_itself = protocol.stops_by_itself;
  r.model.timeout = protocol.timeout;
  r.model.fence.worst_reply = protocol.worst_reply;
  for (const std::string& name : protocol.fence)
    if (const ObjectId id = r.id(name, 0); id != kNoObject) r.model.fence.candidates.push_back(id);
  for (const AlarmSpec& row : r.profile.alarms)
    if (row.bit && r.id(r.profile.fault_words[row.word], 0) != kNoObject)
      r.model.alarms.push_back({row.word, *row.bit, row.code, row.text, row.remedy});
  resolve_setup(r);
  resolve_checks(r);
}

}  // namespace axisgate::drive
