// SPDX-License-Identifier: Apache-2.0
// Views of raw bytes and the two byte orders of our wires.
// Promises that no read or write leaves the span it was given (an assertion stops the process first).
// Never allocates, but for the text.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace axisgate {

using Byte = std::uint8_t;
using Bytes = std::span<const Byte>;

/// The content of a long object, as the drive sends it; shared, so that it is copied nowhere on its way.
using ObjectBytes = std::shared_ptr<const std::vector<Byte>>;
/// Longer objects are refused (design 7, point 6).
inline constexpr std::size_t kMaxObjectBytes = 4096;

[[nodiscard]] constexpr std::uint16_t load_be16(Bytes from, std::size_t at) {
  assert(at + 2 <= from.size());
  return static_cast<std::uint16_t>((from[at] << 8) | from[at + 1]);
}

constexpr void store_be16(std::span<Byte> to, std::size_t at, std::uint16_t value) {
  assert(at + 2 <= to.size());
  to[at] = static_cast<Byte>(value >> 8);
  to[at + 1] = static_cast<Byte>(value & 0xFF);
}

[[nodiscard]] constexpr std::uint16_t load_le16(Bytes from, std::size_t at) {
  assert(at + 2 <= from.size());
  return static_cast<std::uint16_t>((from[at + 1] << 8) | from[at]);
}

constexpr void store_le16(std::span<Byte> to, std::size_t at, std::uint16_t value) {
  assert(at + 2 <= to.size());
  to[at] = static_cast<Byte>(value & 0xFF);
  to[at + 1] = static_cast<Byte>(value >> 8);
}

/// `size` bytes (1..4), least significant first, as CANopen and Kinco carry object data.
[[nodiscard]] constexpr std::uint32_t load_le(Bytes from, std::size_t at, std::size_t size) {
  assert(size >= 1 && size <= 4 && at + size <= from.size());
  std::uint32_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = (value << 8) | from[at + i];
  return value;
}

constexpr void store_le(std::span<Byte> to, std::size_t at, std::size_t size, std::uint32_t value) {
  assert(size >= 1 && size <= 4 && at + size <= to.size());
  for (std::size_t i = 0; i < size; ++i, value >>= 8) to[at + i] = static_cast<Byte>(value & 0xFF);
}

/// "01 2B 40": for decode logs and test failures.
[[nodiscard]] std::string hex_text(Bytes bytes);

}  // namespace axisgate
