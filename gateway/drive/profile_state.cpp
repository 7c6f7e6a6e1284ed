// Sections "state", "modes" and "homing".
#include <array>
#include <nlohmann/json.hpp>

#include "gateway/drive/profile_reading.hpp"

namespace axisgate::drive {

using nlohmann::json;

namespace {

constexpr std::int64_t kLowestMode = -128;
constexpr std::int64_t kHighestMode = 127;

std::optional<std::int64_t> key_number(const std::string& key) { return whole(json(key)); }

std::optional<ConditionSpec> condition_in(Reading& reading, const json& node, std::string_view key,
                                          const std::string& pointer) {
  const json* found = member(node, key);
  if (found == nullptr || !found->is_object()) return std::nullopt;
  return reading.condition(*found, text_in(*found, "object"), pointer_to(pointer, key));
}

void check_cia402(Reading& reading) {
  static constexpr std::array kNeeded{Quantity::statusword, Quantity::controlword, Quantity::mode};
  for (const Quantity quantity : kNeeded)
    if (reading.profile.find(quantity) == nullptr)
      reading.fault("/quantities", "a cia402 drive needs quantity \"" + std::string(row(quantity).name) + "\"");
}

void check_virtual(Reading& reading, const json& node) {
  for (const char* key : {"enabled", "fault"})
    if (member(node, key) == nullptr)
      reading.fault("/state", std::string("a virtual drive needs condition \"") + key + "\"");
  for (const Quantity quantity : {Quantity::statusword, Quantity::controlword})
    if (reading.profile.find(quantity) != nullptr)
      reading.fault(pointer_to("/quantities", row(quantity).name),
                    "is made by the gateway on a virtual drive: leave it out");
}

}  // namespace

void read_modes(Reading& reading) {
  const json* section = member(reading.document, "modes");
  if (section == nullptr || !section->is_object()) return;
  for (const auto& [key, node] : section->items()) {
    const std::optional<std::int64_t> mode = key_number(key);
    const std::string pointer = pointer_to("/modes", key);
    if (!mode || *mode < kLowestMode || *mode > kHighestMode) {
      reading.fault(pointer, "\"" + key + "\" is no mode: use CiA 402 numbers, or negative ones for the drive's own");
      continue;
    }
    reading.profile.modes.emplace(static_cast<std::int16_t>(*mode), whole(node).value_or(0));
  }
}

void read_state(Reading& reading) {
  const json* section = member(reading.document, "state");
  if (section == nullptr || !section->is_object()) return;
  StateSpec& out = reading.profile.state;
  out.is_virtual = text_in(*section, "model") == "virtual";
  out.setpoint_acknowledge = flag_in(*section, "setpoint_acknowledge", !out.is_virtual);
  out.zero_before_enable = names_in(*section, "zero_before_enable");
  for (std::size_t i = 0; i < out.zero_before_enable.size(); ++i) {
    const std::string at = pointer_to("/state/zero_before_enable", i);
    const std::string& name = out.zero_before_enable[i];
    if (reading.names_object(name, at))
      reading.each_meaning(name, [&](const Object& object) {
        if (!object.writable) reading.fault(at, "object \"" + object.name + "\" is read-only");
        if (!object.numbers().holds(0)) reading.fault(at, "object \"" + object.name + "\" does not take 0");
      });
  }
  for (const char* key : {"enabled", "fault", "limit"}) (void)condition_in(reading, *section, key, "/state");
  out.moving = condition_in(reading, *section, "moving", "/state");
  if (const json* reached = member(*section, "reached"))
    (void)condition_in(reading, *reached, "when", "/state/reached");
  if (out.is_virtual)
    check_virtual(reading, *section);
  else
    check_cia402(reading);
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
  const auto add = [&](std::int64_t method, std::int64_t raw, const std::string& pointer) {
    if (method < kLowestMode || method > kHighestMode)
      reading.fault(pointer, std::to_string(method) + " is no homing method: they are -128 to 127");
    else if (!out.methods.emplace(static_cast<std::int16_t>(method), raw).second)
      reading.fault(pointer, "homing method " + std::to_string(method) + " is listed twice");
  };
  if (const json* methods = member(*section, "methods")) {
    if (methods->is_array())
      for (std::size_t i = 0; i < methods->size(); ++i)
        if (const auto method = whole((*methods)[i])) add(*method, *method, pointer_to("/homing/methods", i));
    if (methods->is_object())
      for (const auto& [key, raw] : methods->items())
        add(key_number(key).value_or(INT64_MAX), whole(raw).value_or(0), pointer_to("/homing/methods", key));
  }
  out.homed = condition_in(reading, *section, "homed", "/homing");
  out.failed = condition_in(reading, *section, "failed", "/homing");
}

}  // namespace axisgate::drive
