// SPDX-License-Identifier: Apache-2.0
// Which motor each axis is, how its state is known, which modes it can have and what is repeated in them, its homing.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>

#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/read/profile_reading.hpp"
#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

/// On this protocol each motor has the mode that it was set to, and no other.
bool is_fixed(const Resolving& r) {
  const std::vector<std::string> protocols = r.profile.section("configured_mode").names("fixed_on");
  return std::ranges::find(protocols, r.input.protocol) != protocols.end();
}

/// A fixed mode whose set-point the gateway cannot give leaves an axis that can do nothing.
void check_fixed_mode(Resolving& r, AxisSlot slot) {
  const model::AxisModel& axis = r.model.axes[slot];
  if (!axis.modes.empty() || !is_fixed(r)) return;
  const auto mode = r.configured_mode(slot);
  const auto setpoint = mode ? setpoint_of(*mode) : std::nullopt;
  const QuantitySpec* quantity = setpoint ? r.profile.find(*setpoint) : nullptr;
  std::vector<std::string> names;
  if (quantity != nullptr)
    for (const std::string& object : quantity->objects)
      if (const Object* found = r.profile.find(object, r.motor(slot)))
        if (const auto unit = r.profile.units.find(quantity->unit_of(*found)); unit != r.profile.units.end())
          static_cast<void>(r.recipe(unit->second, &names));
  const std::string missing = listed(names);
  r.fault(pointer_to("/constants", r.mode_constant(r.motor(slot))),
          "chooses a mode whose set-point cannot be given" + (missing.empty() ? "" : ": give also " + missing));
}

model::ObjectId make_object(Resolving& r, AxisSlot slot, const std::string& name, std::uint8_t size, bool writable) {
  model::ObjectDef& def = r.model.objects.emplace_back();
  def.name = r.profile.axes.size() > 1 ? r.profile.axes[r.motor(slot)] + "." + name : name;
  def.slot = slot;
  def.size = size;
  def.is_signed = size == 1;  // a mode
  def.writable = writable;
  def.emulated = true;
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
  const std::vector<std::string>& motors = r.profile.axes;
  const auto found =
      r.constants.find(motors.size() == 1 ? "rated_speed_rpm"
                                          : "rated_speed_" + boost::to_lower_copy(motors.at(r.motor(slot))) + "_rpm");
  if (found == r.constants.end()) return std::nullopt;
  const auto registers = (found->second / model::base_per_register(model::Base::rpm, Rational(1))).scale(1);
  const bool fits = registers && range_of(RegisterType::u32).holds(*registers);
  return fits ? std::optional(static_cast<std::uint32_t>(*registers)) : std::nullopt;
}

}  // namespace

AxisSlot Resolving::motor(AxisSlot slot) const { return slot < motors.size() ? motors[slot] : slot; }

std::string Resolving::mode_constant(AxisSlot motor) const {
  return of_axis(profile.section("configured_mode")["constant"], profile.axes[motor]).text();
}

AxisSlot Resolving::axis_of(AxisSlot motor) const {
  const auto at = std::ranges::find(motors, motor);
  return at == motors.end() ? kNoAxis : static_cast<AxisSlot>(at - motors.begin());
}

std::optional<std::int16_t> Resolving::configured_mode(AxisSlot slot) const {
  const auto value = constants.find(mode_constant(motor(slot)));
  if (value == constants.end()) return std::nullopt;
  for (const auto& [mode, raw] : profile.modes)
    if (value->second == Rational(raw)) return mode;
  return std::nullopt;
}

bool Resolving::can_have(AxisSlot slot, std::int16_t mode) const {
  const JsonNode section = profile.section("configured_mode");
  if (!section || configured_mode(slot) == mode) return true;
  const std::vector<std::int64_t> only = section.wholes("only");
  return !is_fixed(*this) && std::ranges::find(only, mode) == only.end();
}

bool Resolving::can_follow(AxisSlot slot, Quantity setpoint) const {
  if (!profile.section("configured_mode")) return true;
  bool is_setpoint = false;
  for (const auto& [mode, raw] : profile.modes) {
    if (setpoint_of(mode) != setpoint) continue;
    if (can_have(slot, mode)) return true;
    is_setpoint = true;
  }
  return !is_setpoint;
}

void resolve_motors(Resolving& r) {
  const std::vector<std::string>& known = r.profile.axes;
  for (std::size_t i = 0; i < r.input.axes.size(); ++i) {
    const std::string pointer = "/axes/" + std::to_string(i) + "/motor";
    const std::string& name = r.input.axes[i].motor;
    const auto at = name.empty() ? known.begin() + static_cast<std::ptrdiff_t>(i) : std::ranges::find(known, name);
    if (at == known.end()) {
      r.fault(pointer,
              fmt::format("profile \"{}\" has no motor \"{}\": it has {}", r.profile.name, name, listed(known)));
      continue;
    }
    const auto motor = static_cast<AxisSlot>(at - known.begin());
    const AxisSlot taken = r.axis_of(motor);
    if (taken != kNoAxis)
      r.fault(pointer, fmt::format("motor \"{}\"{} is the axis at /axes/{} already: give each axis its own motor", *at,
                                   name.empty() ? ", which this axis is by its place in the list," : "", taken));
    r.motors.push_back(motor);
  }
  if (!r.profile.section("configured_mode") || !r.faults.empty()) return;
  for (std::size_t i = 0; i < r.motors.size(); ++i) {
    if (r.configured_mode(static_cast<AxisSlot>(i))) continue;
    std::vector<std::string> numbers;
    for (const auto& [mode, raw] : r.profile.modes) numbers.push_back(std::to_string(raw));
    std::ranges::sort(numbers);
    r.fault(pointer_to("/constants", r.mode_constant(r.motors[i])), "must be one of " + listed(numbers));
  }
}

void resolve_modes(Resolving& r, AxisSlot slot) {
  model::AxisModel& axis = r.model.axes[slot];
  const auto configured = r.configured_mode(slot);
  for (const auto& [mode, raw] : r.profile.modes) {
    const std::optional<Quantity> setpoint = setpoint_of(mode);
    if (!r.can_have(slot, mode) || (setpoint && axis.binding(*setpoint) == nullptr)) continue;
    // A mode object of ours holds the register. What the drive was set to comes first: it is what the axis begins with.
    const auto entry = std::pair(mode, r.profile.state.is_virtual ? mode : raw);
    axis.modes.insert(configured == mode ? axis.modes.begin() : axis.modes.end(), entry);
    if (mode >= 1 && mode <= 16) axis.supported_modes |= static_cast<std::uint16_t>(1U << (mode - 1));
  }
  axis.mode_needs_disabled = r.profile.section("configured_mode").flag("needs_disabled", false);
  check_fixed_mode(r, slot);
  const JsonNode keepalive = r.profile.section("keepalive");
  if (!is_on(keepalive, r.input.protocol)) return;
  for (const JsonNode& resent : keepalive["resend"].members()) {
    const auto mode = static_cast<std::int16_t>(whole_number(resent.key()).value());
    const bool offered = std::ranges::any_of(axis.modes, [&](const auto& m) { return m.first == mode; });
    if (const model::ObjectId id = r.id(resent.text(), slot); offered && id != model::kNoObject)
      axis.keep_alive.emplace_back(mode, id);
  }
}

void make_objects(Resolving& r, AxisSlot slot) {
  model::AxisModel& axis = r.model.axes[slot];
  axis.statusword = make_object(r, slot, "statusword", 2, false);
  axis.controlword = make_object(r, slot, "controlword", 2, true);
  axis.mode = make_object(r, slot, "mode", 1, true);
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
