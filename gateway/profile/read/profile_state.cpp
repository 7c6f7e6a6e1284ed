// SPDX-License-Identifier: Apache-2.0
// Sections "state" and "homing".
#include <algorithm>
#include <array>

#include "gateway/model/cia402.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

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
  for (const char* key : {"enabled", "fault", "moving"})
    if (!node.has(key)) reading.fault("/state", "a virtual drive needs condition \"{}\"", key);
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
  if (reading.profile.objects.size() + kEmulatedPerAxis * reading.axes() > model::kMaxObjects)
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
  const auto& objects = position == nullptr ? std::vector<std::string>() : position->objects;
  if (std::ranges::find(objects, node.text("object")) == objects.end())
    reading.fault(node.pointer(), "must look at the object of position_actual");
}

}  // namespace

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

/// What a virtual state is made from must be there on every protocol.
void check_state_places(Reading& reading) {
  if (!reading.profile.state.is_virtual) return;
  for (const char* key : {"enabled", "fault", "moving"})
    reading.each_meaning(reading.document["state"][key].text("object"), [&](const Object& object) {
      for (const auto& [protocol, unused] : reading.profile.protocols)
        reading.needs_address(object, protocol, pointer_to("/state", key));
    });
}

}  // namespace axisgate::profile
