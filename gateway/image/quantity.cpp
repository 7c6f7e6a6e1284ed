// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/quantity.hpp"

#include <cassert>

#include "gateway/core/name_table.hpp"

namespace axisgate {
namespace {

using enum Quantity;
using enum RegisterType;
// Design 3.1: the column "bit" is the position in this table.
constexpr std::array<QuantityRow, kQuantityCount> kRows{{
    {statusword, "statusword", Kind::code, u16, false},
    {mode_display, "mode_display", Kind::code, i16, false},
    {position_actual, "position_actual", Kind::position, i32, false},
    {velocity_actual, "velocity_actual", Kind::velocity, i32, false},
    {torque_actual, "torque_actual", Kind::torque, i16, false},
    {current_actual, "current_actual", Kind::current, i16, false},
    {following_error, "following_error", Kind::position, i32, false},
    {error_code, "error_code", Kind::code, u16, false},
    {vendor_error, "vendor_error", Kind::code, u32, false},
    {digital_inputs, "digital_inputs", Kind::code, u16, false},
    {digital_outputs, "digital_outputs", Kind::code, u16, false},
    {drive_temperature, "drive_temperature", Kind::temperature, i16, false},
    {motor_temperature, "motor_temperature", Kind::temperature, i16, false},
    {dc_voltage, "dc_voltage", Kind::voltage, u16, false},
    {controlword, "controlword", Kind::code, u16, true},
    {mode, "mode", Kind::code, i16, true},
    {target_position, "target_position", Kind::position, i32, true},
    {target_velocity, "target_velocity", Kind::velocity, i32, true},
    {target_torque, "target_torque", Kind::torque, i16, true},
    {max_torque, "max_torque", Kind::torque, u16, true},
    {profile_velocity, "profile_velocity", Kind::velocity, u32, true},
    {profile_acceleration, "profile_acceleration", Kind::acceleration, u32, true},
    {profile_deceleration, "profile_deceleration", Kind::acceleration, u32, true},
    {homing_method, "homing_method", Kind::code, i16, true},
    {homing_speed_switch, "homing_speed_switch", Kind::velocity, u32, true},
    {homing_speed_zero, "homing_speed_zero", Kind::velocity, u32, true},
    {homing_acceleration, "homing_acceleration", Kind::acceleration, u32, true},
    {homing_offset, "homing_offset", Kind::position, i32, true},
    {quick_stop_deceleration, "quick_stop_deceleration", Kind::acceleration, u32, true},
    {position_limit_min, "position_limit_min", Kind::position, i32, true},
    {position_limit_max, "position_limit_max", Kind::position, i32, true},
    {max_velocity, "max_velocity", Kind::velocity, u32, true},
}};

consteval bool rows_in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i)
    if (static_cast<std::size_t>(kRows[i].quantity) != i) return false;
  return true;
}
static_assert(rows_in_order(), "a quantity's number is its position in the table");

}  // namespace

const std::array<QuantityRow, kQuantityCount>& quantity_table() { return kRows; }

const QuantityRow& row(Quantity quantity) {
  const auto index = static_cast<std::size_t>(quantity);
  assert(index < kRows.size());
  return kRows[index];
}

std::optional<Quantity> quantity_named(std::string_view name) {
  for (const QuantityRow& each : kRows)
    if (each.name == name) return each.quantity;
  return std::nullopt;
}

std::string_view unit_text(Kind kind) {
  static constexpr auto kUnits = names_of<Kind>({
      {Kind::code, ""},
      {Kind::position, "1/units_per_rev rev"},
      {Kind::velocity, "0.001 rpm"},
      {Kind::acceleration, "0.1 rpm/s"},
      {Kind::torque, "0.1 %"},
      {Kind::current, "0.01 A"},
      {Kind::temperature, "0.1 degC"},
      {Kind::voltage, "0.1 V"},
  });
  static_assert(kUnits.has_all_to(Kind::voltage));
  return kUnits.of(kind);
}

ShownUnit shown_unit(Kind kind) {
  switch (kind) {
    case Kind::code:
      return {};
    case Kind::position:
      return {1, "rev"};
    case Kind::velocity:
      return {1000, "rpm"};
    case Kind::acceleration:
      return {10, "rpm/s"};
    case Kind::torque:
      return {10, "%"};
    case Kind::current:
      return {100, "A"};
    case Kind::temperature:
      return {10, "degC"};
    case Kind::voltage:
      return {10, "V"};
  }
  return {};
}

std::int64_t no_value(RegisterType type) {
  const std::int64_t numbers = std::int64_t{1} << (16 * registers_of(type));
  const bool is_signed = type == i16 || type == i32;
  return is_signed ? -numbers / 2 : numbers - 1;
}

Range range_of(RegisterType type) {
  const std::int64_t outside = no_value(type);
  return outside < 0 ? Range{outside + 1, -(outside + 1)} : Range{0, outside - 1};
}

}  // namespace axisgate
