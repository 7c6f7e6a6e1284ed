// SPDX-License-Identifier: Apache-2.0
// Sections "modes", "configured_mode" and "keepalive": what decides a motor's mode, and what is repeated in each.
#include <algorithm>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

constexpr std::int64_t kLowestMode = -128, kHighestMode = 127;
/// More numbers than a parameter that chooses a mode can have.
constexpr std::int64_t kMostModes = 256;
/// A command that is late by one whole period must not stop the motor.
constexpr int kPeriodsBeforeLoss = 2;

std::optional<std::int16_t> mode_named(const std::string& key) {
  const std::optional<std::int64_t> mode = whole_number(key);
  if (!mode || *mode < kLowestMode || *mode > kHighestMode) return std::nullopt;
  return static_cast<std::int16_t>(*mode);
}

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
void check_resent(Reading& reading, std::int16_t mode, const std::string& name) {
  const KeepAliveSpec& spec = *reading.profile.keepalive;
  const std::string at = pointer_to("/keepalive/resend", std::to_string(mode));
  if (!reading.names_mode(mode, at) || !reading.names_object(name, at)) return;
  const std::optional<Quantity> setpoint = setpoint_of(mode);
  const QuantitySpec* quantity = setpoint ? reading.profile.find(*setpoint) : nullptr;
  if (quantity == nullptr || std::ranges::find(quantity->objects, name) == quantity->objects.end())
    return reading.fault(at, "must be the set-point of mode {}{}", mode,
                         setpoint ? fmt::format(", an object of {}", row(*setpoint).name) : ", which has none");
  reading.each_meaning(name, [&](const Object& object) {
    for (const auto& [protocol, unused] : reading.profile.protocols)
      if (spec.is_on(protocol)) reading.needs_address(object, protocol, at);
  });
}

void check_watchdogs(Reading& reading, const KeepAliveSpec& spec) {
  for (const auto& [name, protocol] : reading.profile.protocols) {
    if (!spec.is_on(name)) continue;
    if (protocol.loss.by != LossSpec::By::command_watchdog)
      reading.fault("/keepalive/on", "nothing on {} needs it: its \"loss\" is no command_watchdog", name);
    else if (kPeriodsBeforeLoss * spec.every > protocol.loss.after)
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
  for (const JsonNode& node : reading.document["modes"].members()) {
    if (const std::optional<std::int16_t> mode = mode_named(node.key()))
      reading.profile.modes.emplace(*mode, node.whole().value_or(0));
    else
      reading.fault(node.pointer(), "\"{}\" is no mode: use CiA 402 numbers, or negative ones for the drive's own",
                    node.key());
  }
}

void read_configured_mode(Reading& reading) {
  const JsonNode section = reading.document["configured_mode"];
  if (!section.is_object()) return;
  ConfiguredModeSpec out;
  if (const JsonNode state = reading.document["state"]; state && state.text("model") != "virtual")
    reading.fault(section.pointer(), "belongs to a virtual drive: the mode object of this one tells its mode");
  const JsonNode constant = section["constant"];
  if (constant.is_string())
    out.constants = {constant.text()};
  else if (constant)
    out.constants = text_for_each_axis(reading, constant, "constant");
  for (const std::string& name : out.constants)
    if (!name.empty()) check_mode_constant(reading, name, constant.pointer());
  out.fixed_on = section.names("fixed_on");
  for (const std::string& protocol : out.fixed_on) reading.names_protocol(protocol, section.pointer("fixed_on"));
  for (const JsonNode& entry : section["only"].elements()) {
    out.only.push_back(static_cast<std::int16_t>(entry.whole().value_or(0)));
    reading.names_mode(out.only.back(), section.pointer("only"));
  }
  out.needs_disabled = section.flag("needs_disabled", false);
  if (!out.constants.empty()) reading.profile.configured_mode = std::move(out);
}

void read_keepalive(Reading& reading) {
  const JsonNode section = reading.document["keepalive"];
  if (!section.is_object()) return;
  KeepAliveSpec& out = reading.profile.keepalive.emplace();
  out.every = milliseconds(section.whole("every_ms", 0));
  out.on = section.names("on");
  for (const JsonNode& name : section["resend"].members()) {
    const std::optional<std::int16_t> mode = mode_named(name.key());
    if (!mode)
      reading.fault(name.pointer(), "\"{}\" is no mode", name.key());
    else if (name.is_string())
      out.resend.emplace(*mode, name.text());
  }
}

void check_keepalive(Reading& reading) {
  if (!reading.profile.keepalive) {
    for (const auto& [name, protocol] : reading.profile.protocols)
      if (protocol.loss.by == LossSpec::By::command_watchdog)
        reading.fault(pointer_to(pointer_to("/protocols", name), "loss"),
                      "a command watchdog would stop every motion: say in \"keepalive\" what is repeated");
    return;
  }
  const KeepAliveSpec& spec = *reading.profile.keepalive;
  for (const std::string& protocol : spec.on) reading.names_protocol(protocol, "/keepalive/on");
  for (const auto& [mode, name] : spec.resend) check_resent(reading, mode, name);
  check_watchdogs(reading, spec);
}

}  // namespace axisgate::profile
