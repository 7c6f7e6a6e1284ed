// SPDX-License-Identifier: Apache-2.0
// How the state of one axis is known, its modes and its homing.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

model::ObjectId make_object(Resolving& r, AxisSlot slot, const std::string& name, DataType type, bool writable) {
  model::ObjectDef def;
  def.name = r.profile.axes.size() > 1 ? r.profile.axes[r.motor(slot)] + "." + name : name;
  def.slot = slot;
  def.size = type.size;
  def.is_signed = type.is_signed;
  def.writable = writable;
  def.emulated = true;
  r.model.objects.push_back(std::move(def));
  return static_cast<model::ObjectId>(r.model.objects.size() - 1);
}

std::optional<model::Condition> condition(const Resolving& r, const std::optional<ConditionSpec>& spec, AxisSlot slot) {
  return spec ? r.condition(*spec, slot) : std::nullopt;
}

/// A motor whose mode is fixed must not be sent another mode's set-point: where they share a place, a speed of 0 would
/// be the position 0.
bool may_be_zeroed(const Resolving& r, const std::string& name, AxisSlot slot) {
  const auto belongs_to = [&](Quantity quantity) {
    const QuantitySpec* spec = r.profile.find(quantity);
    return spec != nullptr && std::ranges::find(spec->objects, name) != spec->objects.end();
  };
  for (const Quantity quantity : {Quantity::target_velocity, Quantity::target_torque})
    if (belongs_to(quantity) && !r.can_follow(slot, quantity)) return false;
  return true;
}

void resolve_roles(Resolving& r, AxisSlot slot) {
  model::AxisModel& axis = r.model.axes[slot];
  const auto object_of = [&](Quantity quantity) {
    const model::Binding* binding = axis.binding(quantity);
    return binding == nullptr ? model::kNoObject : binding->object;
  };
  axis.statusword = object_of(Quantity::statusword);
  axis.controlword = object_of(Quantity::controlword);
  axis.mode = object_of(Quantity::mode);
  const model::ObjectId display = object_of(Quantity::mode_display);
  axis.mode_display = display == model::kNoObject ? axis.mode : display;
  axis.cia402.mode_display = axis.mode_display != axis.mode;
  const StateSpec& state = r.profile.state;
  axis.cia402.follow_bits = state.follow_bits.value_or(axis.cia402.follow_bits);
  axis.cia402.velocity_modes = state.velocity_modes;
  axis.velocity_lag = state.velocity_lag.value_or(axis.velocity_lag);
  axis.cia402.setpoint_acknowledge = r.profile.state.is_virtual || r.profile.state.setpoint_acknowledge;
  for (std::size_t i = 0; i < r.profile.fault_words.size(); ++i)
    axis.fault_words[i] = r.id(r.profile.fault_words[i], slot);
  for (const std::string& name : r.profile.state.zero_before_enable)
    if (const model::ObjectId id = r.id(name, slot); id != model::kNoObject && may_be_zeroed(r, name, slot))
      axis.zero_before_enable.push_back(id);
  axis.moving = condition(r, r.profile.state.moving, slot);
}

/// Every object once, the fault first: a drive that is there always answers for it.
void add_state_sources(const model::VirtualProperties& facts, model::AxisModel& axis) {
  const auto add = [&](const model::Condition& condition) {
    if (std::ranges::find(axis.state_sources, condition.object) == axis.state_sources.end())
      axis.state_sources.push_back(condition.object);
  };
  add(facts.fault);
  add(facts.enabled);
  for (const std::optional<model::Condition>& more : {axis.moving, facts.reached, facts.limit})
    if (more) add(*more);
}

void resolve_machine(Resolving& r, AxisSlot slot) {
  const StateSpec& spec = r.profile.state;
  model::AxisModel& axis = r.model.axes[slot];
  if (!spec.is_virtual) {
    axis.state_sources = {axis.statusword};
    for (const auto& [role, object] : {std::pair("statusword", axis.statusword),
                                       std::pair("controlword", axis.controlword), std::pair("mode", axis.mode)})
      if (object == model::kNoObject)
        r.fault("/profile", fmt::format("profile \"{}\" has no {} on {}, so nothing can be done there", r.profile.name,
                                        role, r.input.protocol));
    return;
  }
  model::VirtualProperties out;
  out.enabled = condition(r, spec.enabled, slot).value();  // load_profile() has seen to it that every protocol has them
  out.fault = condition(r, spec.fault, slot).value();
  out.limit = condition(r, spec.limit, slot);
  out.reached = condition(r, spec.reached, slot);
  out.within = spec.within;
  out.homed_at = condition(r, r.profile.homing.homed_at, slot);
  out.gate_only = spec.gate_only;
  out.quick_stop_energised = spec.quick_stop_energised;
  add_state_sources(out, axis);
  axis.virtual_axis = std::move(out);
}

void resolve_homing(Resolving& r, AxisSlot slot) {
  const HomingSpec& spec = r.profile.homing;
  model::AxisModel& axis = r.model.axes[slot];
  for (const auto& [method, raw] : spec.methods) axis.homing_methods.push_back(method);
  for (const auto& [method, need] : spec.needs) {
    model::HomingNeed out{method, {}, need.equals};
    for (const std::string& name : need.any_of)
      if (const model::ObjectId id = r.id(name, slot); id != model::kNoObject) out.any_of.push_back(id);
    if (!out.any_of.empty()) axis.homing_needs.push_back(std::move(out));
  }
  if (spec.in_mode) axis.homed_mode = *spec.in_mode;
  axis.homed = condition(r, spec.homed, slot);
  axis.homing_failed = condition(r, spec.failed, slot);
  const std::optional<std::int16_t> configured = r.input.axes[slot].homing_method;
  if (!configured || spec.methods.contains(*configured)) return;
  const std::string known = fmt::format("{}", fmt::join(axis.homing_methods, ", "));
  r.fault(fmt::format("/axes/{}/homing_method", slot),
          fmt::format("this drive has no homing method {}: it has {}", *configured, known.empty() ? "none" : known));
}

/// The constant rated_speed_rpm; of a drive with several motors rated_speed_a_rpm, after the motor's name.
std::optional<std::uint32_t> rated_speed(const Resolving& r, AxisSlot slot) {
  std::string name = "rated_speed_rpm";
  if (r.profile.axes.size() > 1) {
    std::string motor = r.profile.axes.at(r.motor(slot));
    for (char& each : motor) each = static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
    name = "rated_speed_" + motor + "_rpm";
  }
  const auto found = r.constants.find(name);
  if (found == r.constants.end()) return std::nullopt;
  const auto registers = (found->second / model::base_per_register(model::Base::rpm, Rational(1))).scale(1);
  const bool fits = registers && range_of(RegisterType::u32).holds(*registers);
  return fits ? std::optional(static_cast<std::uint32_t>(*registers)) : std::nullopt;
}

}  // namespace

void make_objects(Resolving& r, AxisSlot slot) {
  model::AxisModel& axis = r.model.axes[slot];
  axis.statusword = make_object(r, slot, "statusword", {2, false}, false);
  axis.controlword = make_object(r, slot, "controlword", {2, false}, true);
  axis.mode = make_object(r, slot, "mode", {1, true}, true);
}

void resolve_state(Resolving& r, AxisSlot slot) {
  resolve_roles(r, slot);
  model::AxisModel& axis = r.model.axes[slot];
  const ResolveAxis& input = r.input.axes[slot];
  axis.number = input.number;
  axis.name = input.name;
  axis.inverted = input.inverted;
  axis.standstill_velocity = input.standstill_velocity;
  axis.units_per_rev = input.units_per_rev;
  axis.rated_speed = rated_speed(r, slot);
  axis.lease = input.lease;
  axis.watch = input.watch;
  axis.jog_timeout = input.jog_timeout;
  axis.homing_timeout = input.homing_timeout;
  axis.homing_method = input.homing_method;
  axis.configured_torque_limit = input.limits.torque.has_value();
  resolve_machine(r, slot);
  resolve_modes(r, slot);
  resolve_homing(r, slot);
}

}  // namespace axisgate::profile
