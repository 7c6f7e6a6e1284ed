// SPDX-License-Identifier: Apache-2.0
// How long Modbus RTU frames and the silences between them take on a serial line.
// Promises times that follow from the line's speed alone (Modbus over serial line V1.02, 2.5.1.1).
// Never counts how long a drive thinks before it answers.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>

#include "gateway/core/clock.hpp"

namespace axisgate::modbus_rtu {

struct LineSpeed {
  std::uint32_t baud = 19200;  ///< above 0
  int parity_bits = 0;         ///< 0 or 1; there is one stop bit either way
};

/// Both frames of an exchange, each counted with its CRC; 0 for a reply that does not come.
[[nodiscard]] constexpr Duration wire_time(std::uint32_t baud, int parity_bits, std::size_t request_bytes,
                                           std::size_t reply_bytes) {
  assert(baud > 0 && (parity_bits == 0 || parity_bits == 1));
  const auto bytes = static_cast<std::int64_t>(request_bytes + reply_bytes);
  const std::int64_t bits_per_byte = 1 + 8 + parity_bits + 1;
  return Duration(std::chrono::seconds(1)) * (bytes * bits_per_byte) / std::int64_t{baud};
}

/// Above this rate the standard fixes the silence: shorter ones would ask too much of a slave's interrupts.
inline constexpr std::uint32_t kLastBaudOfCharacters = 19200;
inline constexpr Duration kFixedGap = std::chrono::microseconds(1750);

/// The silence that parts two frames: 3.5 characters of the standard's 11 bits.
[[nodiscard]] constexpr Duration gap_time(std::uint32_t baud) {
  assert(baud > 0);
  if (baud > kLastBaudOfCharacters) return kFixedGap;
  constexpr std::int64_t kHalfBits = 77;  // 3.5 characters
  return Duration(std::chrono::seconds(1)) * kHalfBits / (2 * std::int64_t{baud});
}

}  // namespace axisgate::modbus_rtu
