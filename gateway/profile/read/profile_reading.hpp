// SPDX-License-Identifier: Apache-2.0
// What the section readers of a profile share: the document, the profile being filled, the faults found, and how values
// are written in JSON. Promises that a reader can go on after any fault, so that all are found in one run. Never
// reports what the JSON Schema reports already: a value of the wrong type simply reads as absent.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/nearest.hpp"
#include "gateway/profile/json/json_node.hpp"
#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/read/profile.hpp"

namespace axisgate::profile {

/// The last address of a Modbus register.
inline constexpr std::int64_t kLastRegister = 0xFFFF;
[[nodiscard]] inline std::int64_t registers_of(const Place& place) { return place.size > 2 ? 2 : 1; }

/// What a motor follows.
[[nodiscard]] constexpr bool is_target(Quantity quantity) {
  using enum Quantity;
  return quantity == target_position || quantity == target_velocity || quantity == target_torque;
}

class Reading {
 public:
  Reading(const nlohmann::json& file, Profile& filled, std::vector<SchemaFault>& faults)
      : document(file, ""), profile(filled), faults_(faults), from_schema_(faults.size()) {}

  const JsonNode document;
  Profile& profile;

  /// Dropped where the schema has found fault with the same place.
  void fault(const std::string& pointer, std::string message);
  template <class First, class... More>
  void fault(const std::string& pointer, fmt::format_string<First, More...> form, First&& first, More&&... more) {
    fault(pointer, fmt::format(form, std::forward<First>(first), std::forward<More>(more)...));
  }

  // Each says what is wrong at `pointer`, unless what is named there is known. Returns whether it is.
  /// Of any axis.
  bool names_object(const std::string& object, const std::string& pointer);
  bool names_protocol(const std::string& protocol, const std::string& pointer);
  bool names_unit(const std::string& unit, const std::string& pointer);
  bool names_mode(std::int64_t mode, const std::string& pointer);
  /// Null: there is none.
  const Constant* constant_named(const std::string& name, const std::string& pointer);

  // Each says what is wrong at `pointer` with an object that is not so. Returns whether it is.
  /// `consequence`: what follows from it, behind "cannot be read".
  bool needs_readable(const Object& object, const std::string& pointer, std::string_view consequence = "");
  /// A whole number: one of a speed, say, may be a fraction.
  bool needs_whole(const Object& object, const std::string& pointer);
  bool needs_writable(const Object& object, const std::string& pointer);
  bool needs_address(const Object& object, std::string_view protocol, const std::string& pointer);
  /// `what`: what the number is, before it.
  bool needs_number(const Object& object, std::int64_t number, const std::string& pointer, std::string_view what = "");

  /// Calls `check(object)` for what the name means on each axis (once, where all mean the same).
  template <class Check>
  void each_meaning(const std::string& name, Check&& check) const {
    const Object* last = nullptr;
    for (std::size_t slot = 0; slot < profile.axes.size(); ++slot) {
      const Object* object = profile.find(name, static_cast<AxisSlot>(slot));
      if (object != nullptr && object != last) check(*object);
      last = object;
    }
  }
  /// The same, where every axis has an object of this name.
  template <class Check>
  void each_named(const std::string& name, const std::string& pointer, Check&& check) {
    if (names_object(name, pointer)) each_meaning(name, check);
  }
  /// The same for all objects of a quantity.
  template <class Check>
  void each_object_of(Quantity quantity, Check&& check) const {
    if (const QuantitySpec* spec = profile.find(quantity))
      for (const std::string& name : spec->objects) each_meaning(name, check);
  }
  /// Judges what is written to an object: in a step, by setup or by a remedy. `at_once`: without a further look, so not
  /// an amount in a unit that waits for the drive.
  void write(const JsonNode& node, bool by_command, bool at_once);
  /// Judges a condition where there is one. `object`: the key of its object.
  void condition(const JsonNode& node, std::string_view object = "object");
  /// "3000 rpm"; nothing where the schema has reported its form. An unknown constant is a fault.
  std::optional<model::Amount> amount(const JsonNode& node);

 private:
  /// Of each axis its own.
  void values(const JsonNode& node);
  void value_fits(const WriteValue& value, const Object& object, const std::string& pointer, bool at_once);
  void by_constant(const JsonNode& node, std::int64_t mask);
  std::vector<SchemaFault>& faults_;
  std::size_t from_schema_;
};

/// "u16"; another name is none, and leaves the object as it is.
void take_type(model::ObjectDef& object, std::string_view name);
[[nodiscard]] model::Nvm nvm_named(std::string_view name);
/// The unit counts by a constant that is read from the drive: nothing can be converted by it before that.
[[nodiscard]] bool waits_for_drive(const Profile& profile, const model::Unit& unit);
[[nodiscard]] std::string range_text(const Range& range);
/// What an axis in this mode follows; none: no single quantity.
[[nodiscard]] std::optional<Quantity> setpoint_of(std::int16_t mode);
/// "a, b, c"
[[nodiscard]] std::string listed(const std::vector<std::string>& names);
template <class Map>
[[nodiscard]] std::vector<std::string> keys_in(const Map& map) {
  std::vector<std::string> out;
  for (const auto& [key, value] : map) out.push_back(key);
  return out;
}

// The sections, in the order in which they must be read.
void read_constants(Reading& reading);
void read_units(Reading& reading);
void read_objects(Reading& reading);
void read_quantities(Reading& reading);
void read_modes(Reading& reading);
void check_configured_mode(Reading& reading);
void read_state(Reading& reading);
void read_homing(Reading& reading);
void read_commands(Reading& reading);
void check_setup(Reading& reading);
void check_checks(Reading& reading);
void read_alarms(Reading& reading);
/// Of sections "protocols" and "objects": what belongs to Keya's own protocols alone.
[[nodiscard]] bool is_keya(std::string_view protocol);
/// `place` has what every protocol's places have; none where it is wrong.
[[nodiscard]] std::optional<Place> place_in_frame(Reading& reading, const Object& object, const JsonNode& node,
                                                  Place place);
void check_control_frame(Reading& reading, const std::string& protocol, const std::string& pointer);
/// After all: what a section can only be judged by together with others.
void read_protocols(Reading& reading);
void check_keepalive(Reading& reading);
void check_constant_rules(Reading& reading);

/// Two names of one object, as "alias_of" says.
[[nodiscard]] bool are_aliases(const Object& a, const Object& b);
/// `object` is, on any axis, one of those that the quantity comes from.
[[nodiscard]] bool is_of(const Reading& reading, const std::string& object, Quantity quantity);
/// A stop, a fault reset and a save must neither enable nor turn the motor, a halt must not go on; an enable has no
/// start in it, no mode and no target but to stay where it is.
void check_writes(Reading& reading, const CommandEntry& command);
/// What stops writes something, and on a CiA 402 drive a quick_stop or disable a controlword for it.
void check_stops(Reading& reading, const CommandEntry& command);
/// After all: neither setup nor a remedy enables the motor or gives it a mode or a target.
void check_unsolicited_writes(Reading& reading);
/// No command of a virtual axis that moves nothing may write what enables or moves it elsewhere.
void check_stops_start_nothing(Reading& reading);

/// After all: motors that are commanded as one are said to be shared, and none of them is started with another.
void check_shared(Reading& reading);

}  // namespace axisgate::profile
