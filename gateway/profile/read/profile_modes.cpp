// SPDX-License-Identifier: Apache-2.0
// Sections "modes", "configured_mode" and "keepalive": what decides a motor's mode, and what is repeated in each.
#include <algorithm>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

/// More numbers than a parameter that chooses a mode can have.
constexpr std::int64_t kMostModes = 256;
/// A command that is late by one whole period must not stop the motor.
constexpr int kPeriodsBeforeLoss = 2;

/// Every number that the configuration may give must be a mode.
void check_mode_constant(Reading& reading, const std::string& name, const std::string& pointer) {
  const Constant* found = reading.constant_named(name, pointer);
  if (found == nullptr) return;
  const std::string at = pointer_to("/constants", name);
  if (found->from_drive || (!found->standard && !found->required))
    return reading.fault(at, "decides the mode: the configuration gives it, so it needs \"default\" or \"required\"");
  const auto needs_range = [&] {
    reading.fault(at, "decides the mode: it needs a \"range\" of what the drive calls its modes");
  };
  if (!found->min || !found->max) return needs_range();
  const std::optional<std::int64_t> low = found->min->scale(1), high = found->max->scale(1);
  if (!low || !high || *high - *low > kMostModes) return needs_range();
  const auto& modes = reading.profile.modes;
  for (std::int64_t raw = *low; raw <= *high; ++raw)
    if (std::ranges::none_of(modes, [&](const auto& mode) { return mode.second == raw; }))
      reading.fault(at, "may be {}, and the drive calls no mode under /modes so", raw);
}

/// Repeated is the set-point of the mode, and no other object: nothing that would start something anew.
void check_resent(Reading& reading, const JsonNode& keepalive, const JsonNode& resent) {
  const std::string at = resent.pointer(), name = resent.text();
  const auto mode = static_cast<std::int16_t>(whole_number(resent.key()).value_or(0));
  if (!reading.names_mode(mode, at) || !reading.names_object(name, at)) return;
  const std::optional<Quantity> setpoint = setpoint_of(mode);
  const QuantitySpec* quantity = setpoint ? reading.profile.find(*setpoint) : nullptr;
  if (quantity == nullptr || std::ranges::find(quantity->objects, name) == quantity->objects.end())
    return reading.fault(at, "must be the set-point of mode {}{}", mode,
                         setpoint ? fmt::format(", an object of {}", row(*setpoint).name) : ", which has none");
  reading.each_meaning(name, [&](const Object& object) {
    for (const auto& [protocol, unused] : reading.profile.protocols)
      if (is_on(keepalive, protocol)) reading.needs_address(object, protocol, at);
  });
}

void check_watchdogs(Reading& reading, const JsonNode& keepalive) {
  for (const auto& [name, protocol] : reading.profile.protocols) {
    if (!is_on(keepalive, name)) continue;
    if (protocol.loss.by != LossSpec::By::command_watchdog)
      reading.fault("/keepalive/on", "nothing on {} needs it: its \"loss\" is no command_watchdog", name);
    else if (kPeriodsBeforeLoss * keepalive.milliseconds("every_ms", {}) > protocol.loss.after)
      reading.fault("/keepalive/every_ms",
                    "is more than half of what {0} allows, /protocols/{0}/loss/after_ms: one late command would stop "
                    "the motor",
                    name);
  }
}

}  // namespace

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

void read_modes(Reading& reading) {
  for (const JsonNode& node : reading.document["modes"].members())
    if (const auto mode = whole_number(node.key()))
      reading.profile.modes.emplace(static_cast<std::int16_t>(*mode), node.whole().value_or(0));
}

void check_configured_mode(Reading& reading) {
  const JsonNode section = reading.document["configured_mode"];
  if (!section.is_object()) return;
  if (const JsonNode state = reading.document["state"]; state && state.text("model") != "virtual")
    reading.fault(section.pointer(), "belongs to a virtual drive: the mode object of this one tells its mode");
  const JsonNode constant = section["constant"];
  for (const std::string& axis : reading.profile.axes) {
    if (const std::string name = of_axis(constant, axis).text(); !name.empty())
      check_mode_constant(reading, name, constant.pointer());
    else
      reading.fault(constant.pointer(), "a constant for axis \"{}\" is missing", axis);
  }
  for (const std::string& protocol : section.names("fixed_on"))
    reading.names_protocol(protocol, section.pointer("fixed_on"));
  for (const std::int64_t mode : section.wholes("only")) reading.names_mode(mode, section.pointer("only"));
}

void check_keepalive(Reading& reading) {
  const JsonNode section = reading.document["keepalive"];
  if (!section.is_object()) {
    for (const auto& [name, protocol] : reading.profile.protocols)
      if (protocol.loss.by == LossSpec::By::command_watchdog)
        reading.fault(pointer_to(pointer_to("/protocols", name), "loss"),
                      "a command watchdog would stop every motion: say in \"keepalive\" what is repeated");
    return;
  }
  for (const std::string& protocol : section.names("on")) reading.names_protocol(protocol, "/keepalive/on");
  for (const JsonNode& resent : section["resend"].members()) check_resent(reading, section, resent);
  check_watchdogs(reading, section);
}

}  // namespace axisgate::profile
