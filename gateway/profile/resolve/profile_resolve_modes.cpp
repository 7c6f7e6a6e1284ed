// SPDX-License-Identifier: Apache-2.0
// Which motor each axis is, which modes it can have, and what is repeated in them.
#include <fmt/format.h>

#include <algorithm>

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
          std::ranges::move(r.missing(unit->second), std::back_inserter(names));
  const std::string missing = listed(names);
  r.fault(pointer_to("/constants", r.mode_constant(r.motor(slot))),
          "chooses a mode whose set-point cannot be given" + (missing.empty() ? "" : ": give also " + missing));
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

}  // namespace axisgate::profile
