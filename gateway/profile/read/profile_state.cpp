// SPDX-License-Identifier: Apache-2.0
// Sections "state" and "homing".
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "gateway/model/cia402.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

constexpr std::int64_t kLowestMethod = -128;
constexpr std::int64_t kHighestMethod = 127;

std::optional<std::int64_t> key_number(const std::string& key) { return whole(json(key)); }

std::optional<ConditionSpec> condition_in(Reading& reading, const json& node, std::string_view key,
                                          const std::string& pointer) {
  const json* found = member(node, key);
  if (found == nullptr || !found->is_object()) return std::nullopt;
  return reading.condition(*found, text_in(*found, "object"), pointer_to(pointer, key));
}

void check_cia402(Reading& reading, const json& node) {
  static constexpr std::array kNeeded{Quantity::statusword, Quantity::controlword, Quantity::mode};
  for (const Quantity quantity : kNeeded)
    if (reading.profile.find(quantity) == nullptr)
      reading.fault("/quantities", "a cia402 drive needs quantity \"" + std::string(row(quantity).name) + "\"");
  for (const char* key : {"enabled", "fault", "limit", "reached", "gate_only"})
    if (member(node, key) != nullptr)
      reading.fault(pointer_to("/state", key), "belongs to a virtual drive: the statusword of this one tells it");
}

/// What CiA 402 leaves to the makers.
void read_makers_facts(Reading& reading, const json& node, StateSpec& out) {
  if (const json* bits = member(node, "follow_bits"))
    out.follow_bits = static_cast<std::uint16_t>(whole(*bits).value_or(0));
  if (out.follow_bits && (*out.follow_bits & ~std::uint32_t{model::controlword::kMaker}) != 0)
    reading.fault("/state/follow_bits", "names bits that CiA 402 gives a meaning: it leaves 0xF800 to the makers");
  if (member(node, "velocity_lag_ms") != nullptr)
    out.velocity_lag = std::chrono::milliseconds(whole_in(node, "velocity_lag_ms", 0));
  const json* modes = member(node, "velocity_modes");
  if (modes == nullptr || !modes->is_array()) return;
  for (std::size_t i = 0; i < modes->size(); ++i) {
    const auto mode = static_cast<std::int16_t>(whole((*modes)[i]).value_or(0));
    if (!reading.profile.modes.contains(mode))
      reading.fault(pointer_to("/state/velocity_modes", i), "mode " + std::to_string(mode) + " is not under /modes");
    out.velocity_modes.push_back(mode);
  }
}

void check_virtual(Reading& reading, const json& node) {
  for (const char* key : {"follow_bits", "velocity_modes"})
    if (member(node, key) != nullptr)
      reading.fault(pointer_to("/state", key), "belongs to a cia402 drive: this one has no controlword");
  for (const char* key : {"enabled", "fault", "moving"})
    if (member(node, key) == nullptr)
      reading.fault("/state", std::string("a virtual drive needs condition \"") + key + "\"");
  for (const Quantity quantity : {Quantity::statusword, Quantity::mode_display, Quantity::controlword, Quantity::mode})
    if (reading.profile.find(quantity) != nullptr)
      reading.fault(pointer_to("/quantities", row(quantity).name),
                    "is emulated by the gateway on a virtual drive: leave it out");
  const std::string ends = text_in(node, "quick_stop_ends");
  if (ends.empty() || ends == "by_option")
    reading.fault("/state", "a virtual drive must say \"quick_stop_ends\": \"energised\" or \"torque_off\"");
  if (reading.profile.state.gate_only && ends == "torque_off")
    reading.fault("/state/quick_stop_ends", "excludes \"gate_only\": a bus that cannot take the torque away");
  constexpr std::size_t kEmulatedPerAxis = 3;
  if (reading.profile.objects.size() + kEmulatedPerAxis * reading.axes() > model::kMaxObjects)
    reading.fault("/objects", "too many: the gateway makes " + std::to_string(kEmulatedPerAxis) +
                                  " more for each axis, and all together may be " + std::to_string(model::kMaxObjects));
}

void read_zeroes(Reading& reading, StateSpec& out) {
  for (std::size_t i = 0; i < out.zero_before_enable.size(); ++i) {
    const std::string at = pointer_to("/state/zero_before_enable", i);
    const std::string& name = out.zero_before_enable[i];
    if (reading.names_object(name, at))
      reading.each_meaning(name, [&](const Object& object) {
        if (!object.writable) reading.fault(at, "object \"" + object.name + "\" is read-only");
        if (!object.numbers().holds(0)) reading.fault(at, "object \"" + object.name + "\" does not take 0");
      });
  }
}

void read_reached(Reading& reading, const json& state, StateSpec& out) {
  const json* reached = member(state, "reached");
  if (reached == nullptr) return;
  out.reached = condition_in(reading, *reached, "when", "/state/reached");
  out.within = whole_in(*reached, "within", 0);
  if (member(*reached, "within") != nullptr && reading.profile.find(Quantity::position_actual) == nullptr)
    reading.fault("/state/reached/within", "is judged by position_actual, which this profile does not have");
}

/// A method number as a key or an entry of a list.
void add_method(Reading& reading, std::int64_t method, std::int64_t raw, const std::string& pointer) {
  HomingSpec& out = reading.profile.homing;
  if (method < kLowestMethod || method > kHighestMethod)
    return reading.fault(pointer, std::to_string(method) + " is no homing method: they are -128 to 127");
  for (const auto& [known, code] : out.methods)
    if (code == raw && known != method)
      reading.fault(pointer, "homing method " + std::to_string(known) + " is " + std::to_string(raw) + " as well");
  if (!out.methods.emplace(static_cast<std::int16_t>(method), raw).second)
    reading.fault(pointer, "homing method " + std::to_string(method) + " is listed twice");
  const QuantitySpec* quantity = reading.profile.find(Quantity::homing_method);
  if (quantity == nullptr) return;
  for (const std::string& name : quantity->objects)
    reading.each_meaning(name, [&](const Object& object) {
      if (!object.numbers().holds(raw))
        reading.fault(pointer, std::to_string(raw) + " does not fit object \"" + object.name + "\"");
    });
}

void read_need(Reading& reading, const std::string& key, const json& node) {
  const std::string pointer = pointer_to("/homing/needs", key);
  const std::int64_t method = key_number(key).value_or(INT64_MAX);
  HomingSpec& homing = reading.profile.homing;
  if (method < kLowestMethod || method > kHighestMethod || !homing.methods.contains(static_cast<std::int16_t>(method)))
    return reading.fault(pointer, "\"" + key + "\" is not under /homing/methods");
  HomingSpec::Need out{names_in(node, "any_of"), whole_in(node, "equals", 0)};
  for (const std::string& name : out.any_of) {
    const std::string at = pointer_to(pointer, "any_of");
    if (!reading.names_object(name, at)) continue;
    reading.each_meaning(name, [&](const Object& object) {
      if (!object.readable) reading.fault(at, "object \"" + object.name + "\" cannot be read");
      if (!object.numbers().holds(out.equals))
        reading.fault(pointer_to(pointer, "equals"),
                      std::to_string(out.equals) + " does not fit object \"" + object.name + "\"");
    });
  }
  homing.needs.emplace(static_cast<std::int16_t>(method), std::move(out));
}

/// Judged by the position after homing, so of the object that position_actual comes from.
void read_homed_at(Reading& reading, const json& section) {
  HomingSpec& out = reading.profile.homing;
  out.homed_at = condition_in(reading, section, "homed_at", "/homing");
  if (member(section, "homed_at") == nullptr) return;
  if (!reading.profile.state.is_virtual)
    return reading.fault("/homing/homed_at", "belongs to a virtual drive: the statusword of this one tells it");
  const QuantitySpec* position = reading.profile.find(Quantity::position_actual);
  const auto& objects = position == nullptr ? std::vector<std::string>() : position->objects;
  if (out.homed_at && std::find(objects.begin(), objects.end(), out.homed_at->object) == objects.end())
    reading.fault("/homing/homed_at", "must look at the object of position_actual");
}

}  // namespace

void read_state(Reading& reading) {
  const json* section = member(reading.document, "state");
  if (section == nullptr || !section->is_object()) return;
  StateSpec& out = reading.profile.state;
  out.is_virtual = text_in(*section, "model") == "virtual";
  out.setpoint_acknowledge = flag_in(*section, "setpoint_acknowledge", !out.is_virtual);
  read_makers_facts(reading, *section, out);
  out.gate_only = flag_in(*section, "gate_only", false);
  out.quick_stop_energised = text_in(*section, "quick_stop_ends") != "torque_off";
  out.zero_before_enable = names_in(*section, "zero_before_enable");
  read_zeroes(reading, out);
  out.enabled = condition_in(reading, *section, "enabled", "/state");
  out.fault = condition_in(reading, *section, "fault", "/state");
  out.moving = condition_in(reading, *section, "moving", "/state");
  out.limit = condition_in(reading, *section, "limit", "/state");
  read_reached(reading, *section, out);
  if (out.is_virtual)
    check_virtual(reading, *section);
  else
    check_cia402(reading, *section);
  const QuantitySpec* mode = reading.profile.find(Quantity::mode);
  if (mode == nullptr) return;
  for (const std::string& name : mode->objects)
    reading.each_meaning(name, [&](const Object& object) {
      for (const auto& [number, raw] : reading.profile.modes)
        if (!object.numbers().holds(raw))
          reading.fault(pointer_to("/modes", std::to_string(number)),
                        std::to_string(raw) + " does not fit object \"" + object.name + "\"");
    });
}

void read_homing(Reading& reading) {
  const json* section = member(reading.document, "homing");
  if (section == nullptr || !section->is_object()) return;
  HomingSpec& out = reading.profile.homing;
  if (const json* methods = member(*section, "methods")) {
    if (methods->is_array())
      for (std::size_t i = 0; i < methods->size(); ++i)
        if (const auto method = whole((*methods)[i]))
          add_method(reading, *method, *method, pointer_to("/homing/methods", i));
    if (methods->is_object())
      for (const auto& [key, raw] : methods->items())
        add_method(reading, key_number(key).value_or(INT64_MAX), whole(raw).value_or(0),
                   pointer_to("/homing/methods", key));
  }
  if (const json* needs = member(*section, "needs"); needs != nullptr && needs->is_object())
    for (const auto& [key, node] : needs->items()) read_need(reading, key, node);
  out.homed = condition_in(reading, *section, "homed", "/homing");
  out.failed = condition_in(reading, *section, "failed", "/homing");
  if (const json* mode = member(*section, "in_mode")) {
    out.in_mode = static_cast<std::int16_t>(whole(*mode).value_or(0));
    if (!reading.profile.modes.contains(*out.in_mode))
      reading.fault("/homing/in_mode", "is no mode of this drive: /modes does not list it");
  }
  if (reading.profile.state.is_virtual)
    for (const char* key : {"homed", "failed"})
      if (member(*section, key) != nullptr)
        reading.fault(pointer_to("/homing", key), "is not looked at on a virtual drive: say \"homed_at\"");
  read_homed_at(reading, *section);
}

/// What a virtual state is made from must be there on every protocol.
void check_state_places(Reading& reading) {
  const StateSpec& state = reading.profile.state;
  if (!state.is_virtual) return;
  for (const auto& [key, condition] :
       {std::pair("enabled", &state.enabled), std::pair("fault", &state.fault), std::pair("moving", &state.moving)}) {
    if (!condition->has_value()) continue;
    reading.each_meaning((*condition)->object, [&reading, &key = key](const Object& object) {
      for (const auto& [protocol, unused] : reading.profile.protocols)
        if (!object.places.contains(protocol))
          reading.fault(pointer_to("/state", key), "object \"" + object.name + "\" has no address on " + protocol);
    });
  }
}

}  // namespace axisgate::profile
