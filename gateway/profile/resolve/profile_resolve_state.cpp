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
  axis.cia402 = r.profile.state.cia402;
  axis.cia402.mode_display = axis.mode_display != axis.mode;
  const JsonNode state = r.profile.section("state");
  axis.velocity_lag = state.milliseconds("velocity_lag_ms", axis.velocity_lag);
  const std::vector<std::string> words = r.profile.fault_words();
  for (std::size_t i = 0; i < words.size(); ++i) axis.fault_words[i] = r.id(words[i], slot);
  for (const std::string& name : state.names("zero_before_enable"))
    if (const model::ObjectId id = r.id(name, slot); id != model::kNoObject && may_be_zeroed(r, name, slot))
      axis.zero_before_enable.push_back(id);
  axis.moving = r.condition(state["moving"], slot);
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
  model::AxisModel& axis = r.model.axes[slot];
  if (!r.profile.state.is_virtual) {
    axis.state_sources = {axis.statusword};
    for (const auto& [role, object] : {std::pair("statusword", axis.statusword),
                                       std::pair("controlword", axis.controlword), std::pair("mode", axis.mode)})
      if (object == model::kNoObject)
        r.fault("/profile", fmt::format("profile \"{}\" has no {} on {}, so nothing can be done there", r.profile.name,
                                        role, r.input.protocol));
    return;
  }
  const JsonNode state = r.profile.section("state");
  model::VirtualProperties out;
  out.enabled = r.condition(state["enabled"], slot).value();  // load_profile() saw to it that every protocol has them
  out.fault = r.condition(state["fault"], slot).value();
  out.limit = r.condition(state["limit"], slot);
  out.reached = r.condition(state["reached"]["when"], slot);
  out.within = state["reached"].whole("within", 0);
  out.homed_at = r.condition(r.profile.section("homing")["homed_at"], slot);
  out.gate_only = state.flag("gate_only", false);
  out.quick_stop_energised = r.profile.state.quick_stop_energised;
  add_state_sources(out, axis);
  axis.virtual_axis = std::move(out);
}

void resolve_homing(Resolving& r, AxisSlot slot) {
  const JsonNode homing = r.profile.section("homing");
  model::AxisModel& axis = r.model.axes[slot];
  for (const auto& [method, raw] : r.profile.state.homing_methods) axis.homing_methods.push_back(method);
  for (const JsonNode& need : homing["needs"].members()) {
    const auto method = static_cast<std::int16_t>(whole_number(need.key()).value());
    model::HomingNeed out{method, {}, need.whole("equals", 0)};
    for (const std::string& name : need.names("any_of"))
      if (const model::ObjectId id = r.id(name, slot); id != model::kNoObject) out.any_of.push_back(id);
    if (!out.any_of.empty()) axis.homing_needs.push_back(std::move(out));
  }
  if (const auto mode = homing.integer("in_mode")) axis.homed_mode = static_cast<int>(*mode);
  axis.homed = r.condition(homing["homed"], slot);
  axis.homing_failed = r.condition(homing["failed"], slot);
  const std::optional<std::int16_t> configured = r.input.axes[slot].homing_method;
  if (!configured || r.profile.state.homing_methods.contains(*configured)) return;
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
  static_cast<model::AxisSettings&>(axis) = r.input.axes[slot];
  axis.rated_speed = rated_speed(r, slot);
  axis.configured_torque_limit = r.input.axes[slot].limits.torque.has_value();
  resolve_machine(r, slot);
  resolve_modes(r, slot);
  resolve_homing(r, slot);
}

}  // namespace axisgate::profile
