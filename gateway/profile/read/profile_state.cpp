// SPDX-License-Identifier: Apache-2.0
// Sections "modes", "configured_mode", "keepalive", "state" and "homing": what decides a motor's mode, what is repeated
// in each, and how its state is known.
#include <algorithm>
#include <array>

#include "gateway/model/cia402.hpp"
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

void check_cia402(Reading& reading, const JsonNode& node) {
  for (const Quantity quantity : {Quantity::statusword, Quantity::controlword, Quantity::mode})
    if (reading.profile.find(quantity) == nullptr)
      reading.fault("/quantities", "a cia402 drive needs quantity \"{}\"", row(quantity).name);
  for (const char* key : {"enabled", "fault", "limit", "reached", "gate_only"})
    if (node.has(key))
      reading.fault(node.pointer(key), "belongs to a virtual drive: the statusword of this one tells it");
}

/// What CiA 402 leaves to the makers.
void read_makers_facts(Reading& reading, const JsonNode& node, model::Cia402Properties& out) {
  out.setpoint_acknowledge =
      reading.profile.state.is_virtual || node.flag("setpoint_acknowledge", out.setpoint_acknowledge);
  out.follow_bits = static_cast<std::uint16_t>(node.whole("follow_bits", out.follow_bits));
  if ((out.follow_bits & ~std::uint32_t{model::controlword::kMaker}) != 0)
    reading.fault("/state/follow_bits", "names bits that CiA 402 gives a meaning: it leaves 0xF800 to the makers");
  for (const JsonNode& entry : node["velocity_modes"].elements()) {
    out.velocity_modes.push_back(static_cast<std::int16_t>(entry.whole().value_or(0)));
    reading.names_mode(out.velocity_modes.back(), entry.pointer());
  }
}

void check_virtual(Reading& reading, const JsonNode& node) {
  for (const char* key : {"follow_bits", "velocity_modes"})
    if (node.has(key)) reading.fault(node.pointer(key), "belongs to a cia402 drive: this one has no controlword");
  for (const char* key : {"enabled", "fault", "moving"}) {
    if (!node.has(key)) reading.fault("/state", "a virtual drive needs condition \"{}\"", key);
    reading.each_meaning(node[key].text("object"), [&](const Object& object) {
      for (const auto& [protocol, unused] : reading.profile.protocols)
        reading.needs_address(object, protocol, node.pointer(key));
    });
  }
  for (const Quantity quantity : {Quantity::statusword, Quantity::mode_display, Quantity::controlword, Quantity::mode})
    if (reading.profile.find(quantity) != nullptr)
      reading.fault(pointer_to("/quantities", row(quantity).name),
                    "is emulated by the gateway on a virtual drive: leave it out");
  const std::string ends = node.text("quick_stop_ends");
  if (ends.empty() || ends == "by_option")
    reading.fault("/state", "a virtual drive must say \"quick_stop_ends\": \"energised\" or \"torque_off\"");
  if (node.flag("gate_only", false) && ends == "torque_off")
    reading.fault("/state/quick_stop_ends", "excludes \"gate_only\": a bus that cannot take the torque away");
  constexpr std::size_t kEmulatedPerAxis = 3;
  if (reading.profile.objects.size() + kEmulatedPerAxis * reading.profile.axes.size() > model::kMaxObjects)
    reading.fault("/objects", "too many: the gateway makes {} more for each axis, and all together may be {}",
                  kEmulatedPerAxis, model::kMaxObjects);
}

void check_zeroes(Reading& reading, const JsonNode& names) {
  for (const JsonNode& name : names.elements())
    reading.each_named(name.text(), name.pointer(), [&](const Object& object) {
      reading.needs_writable(object, name.pointer());
      if (!object.numbers().holds(0)) reading.fault(name.pointer(), "object \"{}\" does not take 0", object.name);
    });
}

void check_reached(Reading& reading, const JsonNode& reached) {
  reading.condition(reached["when"]);
  if (reached.has("within") && reading.profile.find(Quantity::position_actual) == nullptr)
    reading.fault(reached.pointer("within"), "is judged by position_actual, which this profile does not have");
}

/// A method number as a key or an entry of a list.
void add_method(Reading& reading, std::int64_t method, std::int64_t raw, const std::string& pointer) {
  auto& methods = reading.profile.state.homing_methods;
  for (const auto& [known, code] : methods)
    if (code == raw && known != method) reading.fault(pointer, "homing method {} is {} as well", known, raw);
  if (!methods.emplace(static_cast<std::int16_t>(method), raw).second)
    reading.fault(pointer, "homing method {} is listed twice", method);
  reading.each_object_of(Quantity::homing_method, [&](const Object& object) {
    if (!object.numbers().holds(raw)) reading.fault(pointer, "{} does not fit object \"{}\"", raw, object.name);
  });
}

void check_need(Reading& reading, const JsonNode& node) {
  const std::int64_t method = whole_number(node.key()).value_or(INT64_MAX);
  if (!reading.profile.state.homing_methods.contains(static_cast<std::int16_t>(method)))
    return reading.fault(node.pointer(), "\"{}\" is not under /homing/methods", node.key());
  const std::int64_t equals = node.whole("equals", 0);
  for (const std::string& name : node.names("any_of"))
    reading.each_named(name, node.pointer("any_of"), [&](const Object& object) {
      reading.needs_readable(object, node.pointer("any_of"));
      if (!object.numbers().holds(equals))
        reading.fault(node.pointer("equals"), "{} does not fit object \"{}\"", equals, object.name);
    });
}

/// Judged by the position after homing, so of the object that position_actual comes from.
void check_homed_at(Reading& reading, const JsonNode& node) {
  if (!node) return;
  reading.condition(node);
  if (!reading.profile.state.is_virtual)
    return reading.fault(node.pointer(), "belongs to a virtual drive: the statusword of this one tells it");
  const QuantitySpec* position = reading.profile.find(Quantity::position_actual);
  if (position == nullptr || std::ranges::find(position->objects, node.text("object")) == position->objects.end())
    reading.fault(node.pointer(), "must look at the object of position_actual");
}

}  // namespace

std::optional<Quantity> setpoint_of(std::int16_t number) {
  using enum Quantity;
  static constexpr auto kSetpoints = std::to_array<std::pair<std::int16_t, Quantity>>({{1, target_position},
                                                                                       {3, target_velocity},
                                                                                       {4, target_torque},
                                                                                       {6, homing_method},
                                                                                       {7, target_position},
                                                                                       {8, target_position},
                                                                                       {9, target_velocity},
                                                                                       {10, target_torque}});
  const auto* const row = std::ranges::find(kSetpoints, number, [](const auto& each) { return each.first; });
  return row == kSetpoints.end() ? std::nullopt : std::optional(row->second);
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

void read_state(Reading& reading) {
  const JsonNode section = reading.document["state"];
  if (!section.is_object()) return;
  StateSpec& out = reading.profile.state;
  out.is_virtual = section.text("model") == "virtual";
  out.quick_stop_energised = section.text("quick_stop_ends") != "torque_off";
  read_makers_facts(reading, section, out.cia402);
  check_zeroes(reading, section["zero_before_enable"]);
  for (const char* key : {"enabled", "fault", "moving", "limit"}) reading.condition(section[key]);
  check_reached(reading, section["reached"]);
  if (out.is_virtual)
    check_virtual(reading, section);
  else
    check_cia402(reading, section);
  reading.each_object_of(Quantity::mode, [&](const Object& object) {
    for (const auto& [number, raw] : reading.profile.modes)
      if (!object.numbers().holds(raw))
        reading.fault(pointer_to("/modes", std::to_string(number)), "{} does not fit object \"{}\"", raw, object.name);
  });
}

void read_homing(Reading& reading) {
  const JsonNode section = reading.document["homing"];
  for (const JsonNode& entry : section["methods"].elements())
    if (const auto method = entry.whole()) add_method(reading, *method, *method, entry.pointer());
  for (const JsonNode& entry : section["methods"].members())
    add_method(reading, whole_number(entry.key()).value_or(INT64_MAX), entry.whole().value_or(0), entry.pointer());
  for (const JsonNode& need : section["needs"].members()) check_need(reading, need);
  reading.condition(section["homed"]);
  reading.condition(section["failed"]);
  const auto mode = section.integer("in_mode");
  if (mode && !reading.profile.modes.contains(static_cast<std::int16_t>(*mode)))
    reading.fault("/homing/in_mode", "is no mode of this drive: /modes does not list it");
  if (reading.profile.state.is_virtual)
    for (const char* key : {"homed", "failed"})
      if (section.has(key))
        reading.fault(section.pointer(key), "is not looked at on a virtual drive: say \"homed_at\"");
  check_homed_at(reading, section["homed_at"]);
}

}  // namespace axisgate::profile
