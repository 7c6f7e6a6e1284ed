// SPDX-License-Identifier: Apache-2.0
// Which motor each axis is, which modes it can have, and what is repeated in them.
#include <fmt/format.h>

#include <algorithm>

#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/read/profile_reading.hpp"
#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

const std::string& mode_constant(const ConfiguredModeSpec& spec, AxisSlot motor) {
  return motor < spec.constants.size() ? spec.constants[motor] : spec.constants.front();
}

/// The constants that somebody would have to give, so that this object can be converted.
std::string missing_constants(const Resolving& r, const std::vector<const std::string*>& units) {
  std::vector<std::string> out;
  for (const std::string* name : units) {
    const auto unit = r.profile.units.find(*name);
    if (unit == r.profile.units.end()) continue;
    for (const auto* factors : {&unit->second.mul, &unit->second.div})
      for (const model::Factor& factor : *factors)
        if (const auto* constant = std::get_if<std::string>(&factor); constant && !r.constants.contains(*constant))
          out.push_back(*constant);
  }
  return listed(out);
}

/// A fixed mode whose set-point the gateway cannot give leaves an axis that can do nothing.
void check_fixed_mode(Resolving& r, AxisSlot slot) {
  const model::AxisModel& axis = r.model.axes[slot];
  const auto& spec = r.profile.configured_mode;
  if (!axis.modes.empty() || !spec || !spec->is_fixed_on(r.input.protocol)) return;
  const std::string& name = mode_constant(*spec, r.motor(slot));
  const auto mode = r.configured_mode(slot);
  const auto setpoint = mode ? setpoint_of(*mode) : std::nullopt;
  const QuantitySpec* quantity = setpoint ? r.profile.find(*setpoint) : nullptr;
  std::vector<const std::string*> units;
  if (quantity != nullptr)
    for (const std::string& object : quantity->objects)
      if (const Object* found = r.profile.find(object, r.motor(slot))) units.push_back(&quantity->unit_of(*found));
  const std::string missing = missing_constants(r, units);
  r.fault(pointer_to("/constants", name),
          "chooses a mode whose set-point cannot be given" + (missing.empty() ? "" : ": give also " + missing));
}

}  // namespace

AxisSlot Resolving::motor(AxisSlot slot) const { return slot < motors.size() ? motors[slot] : slot; }

AxisSlot Resolving::axis_of(AxisSlot motor) const {
  const auto at = std::ranges::find(motors, motor);
  return at == motors.end() ? kNoAxis : static_cast<AxisSlot>(at - motors.begin());
}

std::optional<std::int16_t> Resolving::configured_mode(AxisSlot slot) const {
  if (!profile.configured_mode) return std::nullopt;
  const auto value = constants.find(mode_constant(*profile.configured_mode, motor(slot)));
  if (value == constants.end()) return std::nullopt;
  for (const auto& [mode, raw] : profile.modes)
    if (value->second == Rational(raw)) return mode;
  return std::nullopt;
}

bool Resolving::can_have(AxisSlot slot, std::int16_t mode) const {
  const auto& spec = profile.configured_mode;
  if (!spec || configured_mode(slot) == mode) return true;
  return !spec->is_fixed_on(input.protocol) && std::ranges::find(spec->only, mode) == spec->only.end();
}

bool Resolving::can_follow(AxisSlot slot, Quantity setpoint) const {
  if (!profile.configured_mode) return true;
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
  if (!r.profile.configured_mode || !r.faults.empty()) return;
  for (std::size_t i = 0; i < r.motors.size(); ++i) {
    if (r.configured_mode(static_cast<AxisSlot>(i))) continue;
    std::vector<std::string> numbers;
    for (const auto& [mode, raw] : r.profile.modes) numbers.push_back(std::to_string(raw));
    std::ranges::sort(numbers);
    r.fault(pointer_to("/constants", mode_constant(*r.profile.configured_mode, r.motors[i])),
            "must be one of " + listed(numbers));
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
  axis.mode_needs_disabled = r.profile.configured_mode && r.profile.configured_mode->needs_disabled;
  check_fixed_mode(r, slot);
  const auto& keepalive = r.profile.keepalive;
  if (!keepalive || !keepalive->is_on(r.input.protocol)) return;
  for (const auto& [mode, name] : keepalive->resend) {
    const bool offered = std::ranges::any_of(axis.modes, [&mode = mode](const auto& m) { return m.first == mode; });
    if (const model::ObjectId id = r.id(name, slot); offered && id != model::kNoObject)
      axis.keep_alive.emplace_back(mode, id);
  }
}

}  // namespace axisgate::profile
