// SPDX-License-Identifier: Apache-2.0
// The quantities of the unified axis (design 2 and 3.1): their numbers, names, kinds and widths, in one table.
// Promises that a quantity's number is its bit in `supported` and `valid`, for ever.
// Never says where a value comes from: that is the drive profile's part.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace axisgate {

enum class Quantity : std::uint8_t {
  statusword = 0,
  mode_display = 1,
  position_actual = 2,
  velocity_actual = 3,
  torque_actual = 4,
  current_actual = 5,
  following_error = 6,
  error_code = 7,
  vendor_error = 8,
  digital_inputs = 9,
  digital_outputs = 10,
  drive_temperature = 11,
  motor_temperature = 12,
  dc_voltage = 13,
  controlword = 14,
  mode = 15,
  target_position = 16,
  target_velocity = 17,
  target_torque = 18,
  max_torque = 19,
  profile_velocity = 20,
  profile_acceleration = 21,
  profile_deceleration = 22,
  homing_method = 23,
  homing_speed_switch = 24,
  homing_speed_zero = 25,
  homing_acceleration = 26,
  homing_offset = 27,
  quick_stop_deceleration = 28,
  position_limit_min = 29,
  position_limit_max = 30,
  max_velocity = 31,
};
inline constexpr std::size_t kQuantityCount = 32;

/// What a number of a quantity means; each kind has one unit in registers (design 2).
enum class Kind : std::uint8_t {
  code,          ///< bits or an enumeration, passed on as it is
  position,      ///< 1/units_per_rev of a motor turn
  velocity,      ///< 0.001 rpm
  acceleration,  ///< 0.1 rpm/s
  torque,        ///< 0.1 % of rated
  current,       ///< 0.01 A rms
  temperature,   ///< 0.1 degC
  voltage,       ///< 0.1 V
};

enum class RegisterType : std::uint8_t { u16, i16, u32, i32 };

struct QuantityRow {
  Quantity quantity;
  std::string_view name;
  Kind kind;
  RegisterType type;
  bool writable;
};

/// In the order of the numbers.
[[nodiscard]] const std::array<QuantityRow, kQuantityCount>& quantity_table();
[[nodiscard]] const QuantityRow& row(Quantity quantity);
[[nodiscard]] std::optional<Quantity> quantity_named(std::string_view name);
[[nodiscard]] constexpr std::uint32_t bit(Quantity quantity) { return 1U << static_cast<unsigned>(quantity); }
/// "0.001 rpm"; empty for codes; positions say "1/units_per_rev rev".
[[nodiscard]] std::string_view unit_text(Kind kind);
/// The unit that people read a number of this kind in.
struct ShownUnit {
  int registers = 1;           ///< register units in one of it; of positions the axis's units_per_rev takes its place
  std::string_view name = {};  ///< "rpm"; empty for codes
};
[[nodiscard]] ShownUnit shown_unit(Kind kind);

/// Smallest and largest value a register of this type can show. The end that means "no value" (i16 -32768, u16 65535,
/// i32 -2147483648, u32 4294967295, design 3.2) is outside.
struct Range {
  std::int64_t min = 0;
  std::int64_t max = 0;
  [[nodiscard]] constexpr bool holds(std::int64_t value) const { return value >= min && value <= max; }
  friend bool operator==(const Range&, const Range&) = default;
};
[[nodiscard]] Range range_of(RegisterType type);
/// What a register of this type shows where there is no value.
[[nodiscard]] std::int64_t no_value(RegisterType type);
[[nodiscard]] constexpr int registers_of(RegisterType type) {
  return type == RegisterType::u32 || type == RegisterType::i32 ? 2 : 1;
}

}  // namespace axisgate
