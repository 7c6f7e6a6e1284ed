// SPDX-License-Identifier: Apache-2.0
// Sections "modes", "configured_mode" and "keepalive": what decides a motor's mode, and what is repeated in each.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

constexpr std::int64_t kLowestMode = -128, kHighestMode = 127;
/// More numbers than a parameter that chooses a mode can have.
constexpr std::int64_t kMostModes = 256;
/// A command that is late by one whole period must not stop the motor.
constexpr int kPeriodsBeforeLoss = 2;

std::optional<std::int16_t> mode_named(const std::string& key) {
  const std::optional<std::int64_t> mode = whole(json(key));
  if (!mode || *mode < kLowestMode || *mode > kHighestMode) return std::nullopt;
  return static_cast<std::int16_t>(*mode);
}

/// Every number that the configuration may give must be a mode.
void check_mode_constant(Reading& reading, const std::string& name, const std::string& pointer) {
  const auto constant = reading.profile.constants.find(name);
  if (constant == reading.profile.constants.end())
    return reading.fault(pointer, "unknown constant \"" + name + "\": not under /constants" +
                                      did_you_mean(name, keys_in(reading.profile.constants)));
  const Constant& found = constant->second;
  const std::string at = pointer_to("/constants", name);
  if (found.from_drive || (!found.standard && !found.required))
    return reading.fault(at, "decides the mode: the configuration gives it, so it needs \"default\" or \"required\"");
  const auto needs_range = [&] {
    reading.fault(at, "decides the mode: it needs a \"range\" of what the drive calls its modes");
  };
  if (!found.min || !found.max) return needs_range();
  const std::optional<std::int64_t> low = found.min->scale(1), high = found.max->scale(1);
  if (!low || !high || *high - *low > kMostModes) return needs_range();
  const auto& modes = reading.profile.modes;
  for (std::int64_t raw = *low; raw <= *high; ++raw)
    if (std::none_of(modes.begin(), modes.end(), [&](const auto& mode) { return mode.second == raw; }))
      reading.fault(at, "may be " + std::to_string(raw) + ", and the drive calls no mode under /modes so");
}

std::vector<std::string> constants_in(Reading& reading, const json& section, const std::string& pointer) {
  const json* constant = member(section, "constant");
  if (constant == nullptr) return {};
  if (constant->is_string()) return {constant->get<std::string>()};
  std::vector<std::string> out;
  for (const std::string& axis : reading.profile.axes) {
    out.push_back(text_in(*constant, axis));
    if (out.back().empty()) reading.fault(pointer, "a constant for axis \"" + axis + "\" is missing");
  }
  return out;
}

void check_known_protocols(Reading& reading, const std::vector<std::string>& protocols, const std::string& pointer) {
  for (const std::string& protocol : protocols)
    if (!reading.profile.protocols.contains(protocol))
      reading.fault(pointer, "protocol \"" + protocol + "\" is not under /protocols" +
                                 did_you_mean(protocol, keys_in(reading.profile.protocols)));
}

/// Repeated is the set-point of the mode, and no other object: nothing that would start something anew.
void check_resent(Reading& reading, std::int16_t mode, const std::string& name) {
  const KeepAliveSpec& spec = *reading.profile.keepalive;
  const std::string at = pointer_to("/keepalive/resend", std::to_string(mode));
  if (!reading.profile.modes.contains(mode))
    return reading.fault(at, "mode " + std::to_string(mode) + " is not under /modes");
  if (!reading.names_object(name, at)) return;
  const std::optional<Quantity> setpoint = setpoint_of(mode);
  const QuantitySpec* quantity = setpoint ? reading.profile.find(*setpoint) : nullptr;
  if (quantity == nullptr ||
      std::find(quantity->objects.begin(), quantity->objects.end(), name) == quantity->objects.end())
    return reading.fault(at,
                         "must be the set-point of mode " + std::to_string(mode) +
                             (setpoint ? ", an object of " + std::string(row(*setpoint).name) : ", which has none"));
  reading.each_meaning(name, [&](const Object& object) {
    for (const auto& [protocol, unused] : reading.profile.protocols)
      if (spec.is_on(protocol) && !object.places.contains(protocol))
        reading.fault(at, "object \"" + object.name + "\" has no address on " + protocol);
  });
}

void check_watchdogs(Reading& reading, const KeepAliveSpec& spec) {
  for (const auto& [name, protocol] : reading.profile.protocols) {
    const bool watched = protocol.loss.by == LossSpec::By::command_watchdog;
    if (!watched && spec.is_on(name))
      reading.fault("/keepalive/on", "nothing on " + name + " needs it: its \"loss\" is no command_watchdog");
    if (!watched || !spec.is_on(name)) continue;
    if (kPeriodsBeforeLoss * spec.every > protocol.loss.after)
      reading.fault("/keepalive/every_ms", "is more than half of what " + name + " allows, /protocols/" + name +
                                               "/loss/after_ms: one late command would stop the motor");
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
  const json* section = member(reading.document, "modes");
  if (section == nullptr || !section->is_object()) return;
  for (const auto& [key, node] : section->items()) {
    if (const std::optional<std::int16_t> mode = mode_named(key))
      reading.profile.modes.emplace(*mode, whole(node).value_or(0));
    else
      reading.fault(pointer_to("/modes", key),
                    "\"" + key + "\" is no mode: use CiA 402 numbers, or negative ones for the drive's own");
  }
}

void read_configured_mode(Reading& reading) {
  const json* section = member(reading.document, "configured_mode");
  if (section == nullptr || !section->is_object()) return;
  ConfiguredModeSpec out;
  if (const json* state = member(reading.document, "state"); state != nullptr && text_in(*state, "model") != "virtual")
    reading.fault("/configured_mode", "belongs to a virtual drive: the mode object of this one tells its mode");
  out.constants = constants_in(reading, *section, "/configured_mode/constant");
  for (const std::string& name : out.constants)
    if (!name.empty()) check_mode_constant(reading, name, "/configured_mode/constant");
  out.fixed_on = names_in(*section, "fixed_on");
  check_known_protocols(reading, out.fixed_on, "/configured_mode/fixed_on");
  if (const json* only = member(*section, "only"); only != nullptr && only->is_array()) {
    for (const json& entry : *only) {
      const auto mode = static_cast<std::int16_t>(whole(entry).value_or(0));
      if (!reading.profile.modes.contains(mode))
        reading.fault("/configured_mode/only", "mode " + std::to_string(mode) + " is not under /modes");
      out.only.push_back(mode);
    }
  }
  out.needs_disabled = flag_in(*section, "needs_disabled", false);
  if (!out.constants.empty()) reading.profile.configured_mode = std::move(out);
}

void read_keepalive(Reading& reading) {
  const json* section = member(reading.document, "keepalive");
  if (section == nullptr || !section->is_object()) return;
  KeepAliveSpec out;
  out.every = std::chrono::milliseconds(whole_in(*section, "every_ms", 0));
  out.on = names_in(*section, "on");
  if (const json* resend = member(*section, "resend"); resend != nullptr && resend->is_object()) {
    for (const auto& [key, name] : resend->items()) {
      const std::optional<std::int16_t> mode = mode_named(key);
      if (!mode)
        reading.fault(pointer_to("/keepalive/resend", key), "\"" + key + "\" is no mode");
      else if (name.is_string())
        out.resend.emplace(*mode, name.get<std::string>());
    }
  }
  reading.profile.keepalive = std::move(out);
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
  check_known_protocols(reading, spec.on, "/keepalive/on");
  for (const auto& [mode, name] : spec.resend) check_resent(reading, mode, name);
  check_watchdogs(reading, spec);
}

}  // namespace axisgate::profile
