// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/modbus_server/filled_image.hpp"

namespace axisgate::test {
namespace {

void fill_axis(AxisImage& axis, Instant now) {
  const std::int64_t n = axis.number;
  axis.supported = 0xFFFFFFFF;
  for (const QuantityRow& row : quantity_table()) {
    const auto at = static_cast<std::size_t>(row.quantity);
    if (row.writable) axis.writable |= bit(row.quantity);
    axis.limits[at] = range_of(row.type);
    axis.samples[at] = {static_cast<std::int64_t>(at) * 10 + n, true, true, now};
  }
  axis[Quantity::statusword].value = 0x0637;
  axis[Quantity::mode_display].value = 1;
  axis[Quantity::position_actual].value = 100'000 * n;
  axis[Quantity::velocity_actual].value = 1000 * n;
  axis[Quantity::torque_actual].value = -125;
  axis[Quantity::current_actual].value = 345;
  axis[Quantity::error_code].value = 0;
  axis[Quantity::vendor_error].value = 0;
  axis.supported_commands = 0x1FFE;
  axis.supported_modes = 0x002D;
  axis.link_state = LinkState::online;
  axis.axis_state = AxisState::standstill;
  axis.inputs = static_cast<std::uint16_t>(bit(AxisInput::online) | bit(AxisInput::enabled));
  axis.alarms = bit(AxisAlarm::not_homed);
  axis.oldest_cyclic = now;
}

}  // namespace

void fill_image(ProcessImage& image, AxisNumber axes, Instant now) {
  for (AxisNumber number = 1; number <= axes; ++number) {
    fill_axis(image.add_axis(number, "axis " + std::to_string(number), 0), now);
  }
  BusImage bus;
  bus.name = "lift-serial";
  bus.link = 1;
  image.buses.push_back(bus);
  image.gateway = {GatewayState::running, axes, 3725, 0};
}

}  // namespace axisgate::test
