// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/values/value_names.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace axisgate::web {
namespace {

/// In the order of the quantities' numbers.
constexpr std::array<std::string_view, kQuantityCount> kValueNames{"statusword",
                                                                   "mode",
                                                                   "position_rev",
                                                                   "velocity_rpm",
                                                                   "torque_percent",
                                                                   "current_a",
                                                                   "following_error_rev",
                                                                   "error_code",
                                                                   "vendor_error",
                                                                   "inputs",
                                                                   "outputs",
                                                                   "drive_temperature_c",
                                                                   "motor_temperature_c",
                                                                   "dc_voltage_v",
                                                                   "controlword",
                                                                   "mode_asked",
                                                                   "target_position_rev",
                                                                   "target_velocity_rpm",
                                                                   "target_torque_percent",
                                                                   "max_torque_percent",
                                                                   "profile_velocity_rpm",
                                                                   "profile_acceleration_rpm_s",
                                                                   "profile_deceleration_rpm_s",
                                                                   "homing_method",
                                                                   "homing_speed_switch_rpm",
                                                                   "homing_speed_zero_rpm",
                                                                   "homing_acceleration_rpm_s",
                                                                   "homing_offset_rev",
                                                                   "quick_stop_deceleration_rpm_s",
                                                                   "position_limit_min_rev",
                                                                   "position_limit_max_rev",
                                                                   "max_velocity_rpm"};

/// Register units in one of the name's.
long double units_in(Kind kind, const AxisInfoRecord& axis) {
  if (kind != Kind::position) return shown_unit(kind).registers;
  return static_cast<long double>(axis.units_numerator) / static_cast<long double>(axis.units_denominator);
}

}  // namespace

std::string_view value_name(Quantity quantity) { return kValueNames.at(static_cast<std::size_t>(quantity)); }

std::optional<Quantity> value_named(std::string_view name) {
  const auto found = std::ranges::find(kValueNames, name);
  if (found == kValueNames.end()) return std::nullopt;
  return static_cast<Quantity>(found - kValueNames.begin());
}

nlohmann::ordered_json value_json(Quantity quantity, std::int64_t number, const AxisInfoRecord& axis) {
  const Kind kind = row(quantity).kind;
  if (kind == Kind::code) return number;
  return static_cast<double>(static_cast<long double>(number) / units_in(kind, axis));
}

}  // namespace axisgate::web
