// SPDX-License-Identifier: Apache-2.0
// What the benches' drives speak, and where a Kinco JD keeps the same objects on each protocol.
// Promises addresses as the drive's manual prints them. Never knows a frame.
#pragma once

#include <cstdint>
#include <string_view>

namespace axisgate::bench {

/// CANopen behind a Lawicel adapter on a pseudo-terminal, or on a virtual CAN interface.
enum class LineProtocol : std::uint8_t { kinco_serial, modbus_rtu, slcan, vcan };

[[nodiscard]] constexpr bool is_can(LineProtocol protocol) {
  return protocol == LineProtocol::slcan || protocol == LineProtocol::vcan;
}

/// As a configuration names it.
[[nodiscard]] constexpr std::string_view adapter_of(LineProtocol protocol) {
  if (is_can(protocol)) return "canopen";
  return protocol == LineProtocol::modbus_rtu ? "modbus-rtu" : "kinco-serial";
}

/// Index, or register on Modbus RTU.
struct JdAddresses {
  std::uint16_t controlword;
  std::uint16_t statusword;
  std::uint16_t profile_velocity;
};
[[nodiscard]] constexpr JdAddresses jd_addresses(LineProtocol protocol) {
  if (protocol == LineProtocol::modbus_rtu) return {0x3100, 0x3200, 0x4A00};
  return {0x6040, 0x6041, 0x6081};
}

inline constexpr std::uint32_t kBitRate = 500'000;

/// On a pty bytes take no time; on Modbus RTU the silence between frames does, and above 19200 baud it is 1.75 ms.
[[nodiscard]] constexpr std::uint32_t baud_of(LineProtocol protocol) {
  return protocol == LineProtocol::modbus_rtu ? 115'200 : 38'400;
}

}  // namespace axisgate::bench
