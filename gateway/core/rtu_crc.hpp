// SPDX-License-Identifier: Apache-2.0
// The sum at the end of each Modbus RTU frame: CRC-16, polynomial 0xA001 reflected, start 0xFFFF, low byte first on the
// wire (Modbus over serial line V1.02, 6.2.2). Promises 0 for a frame together with its own CRC. Never used to build
// what the product sends: libmodbus does that; here it judges the frames that libmodbus passes on unjudged, knows a
// request that comes back, and one that comes by TCP.
#pragma once

#include "gateway/core/bytes.hpp"

namespace axisgate {

inline constexpr std::size_t kCrcSize = 2;

[[nodiscard]] constexpr std::uint16_t crc16(Bytes bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const Byte byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte);
    for (int bit = 0; bit < 8; ++bit) {
      const bool carry = (crc & 1) != 0;
      crc = static_cast<std::uint16_t>(crc >> 1);
      if (carry) crc = static_cast<std::uint16_t>(crc ^ 0xA001);
    }
  }
  return crc;
}

}  // namespace axisgate
