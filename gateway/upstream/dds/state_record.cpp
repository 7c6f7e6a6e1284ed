// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/state_record.hpp"

#include <algorithm>

#include "gateway/image/shown.hpp"

namespace axisgate::dds {

StateRecord state_record(const AxisImage& axis, const DdsUnits& units) {
  const auto code = [&](Quantity quantity) { return shown_value(axis, quantity); };
  const auto si = [&](Quantity quantity) { return units.to_si(quantity, shown_value(axis, quantity)); };
  StateRecord out;
  out.axis = axis.number;
  out.name = axis.name;
  Instant newest = kLongAgo;
  for (const Sample& sample : axis.samples)
    if (sample.received) newest = std::max(newest, sample.at);
  if (newest != kLongAgo) out.at = newest.time_since_epoch().count();
  out.sequence = axis.sequence;
  out.statusword = static_cast<std::uint16_t>(code(Quantity::statusword));
  out.mode = static_cast<std::int16_t>(code(Quantity::mode_display));
  out.position = si(Quantity::position_actual);
  out.velocity = si(Quantity::velocity_actual);
  out.torque = si(Quantity::torque_actual);
  out.current = si(Quantity::current_actual);
  out.following_error = si(Quantity::following_error);
  out.error_code = static_cast<std::uint16_t>(code(Quantity::error_code));
  out.vendor_error = static_cast<std::uint32_t>(code(Quantity::vendor_error));
  out.inputs = static_cast<std::uint16_t>(code(Quantity::digital_inputs));
  out.outputs = static_cast<std::uint16_t>(code(Quantity::digital_outputs));
  out.drive_temperature = si(Quantity::drive_temperature);
  out.motor_temperature = si(Quantity::motor_temperature);
  out.voltage = si(Quantity::dc_voltage);
  out.axis_state = static_cast<std::uint8_t>(axis.axis_state);
  out.motion_state = static_cast<std::uint8_t>(axis.motion_state);
  out.motion_id = axis.motion_id;
  out.alarms = axis.alarms;
  out.link_state = static_cast<std::uint8_t>(axis.link_state);
  out.supported = axis.supported;
  out.valid = axis.valid_bits();
  return out;
}

}  // namespace axisgate::dds
