// SPDX-License-Identifier: Apache-2.0
// A classical CAN data or remote frame (ISO 11898-1), as every CAN link carries it.
// Promises that an id fits its width and that at most 8 bytes are used.
// Never an error frame: a link turns those into CanTrouble (can_link.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cassert>

#include "gateway/core/bytes.hpp"

namespace axisgate::can {

inline constexpr std::uint32_t kMaxStandardId = 0x7FF;
inline constexpr std::uint32_t kMaxExtendedId = 0x1FFFFFFF;
inline constexpr std::size_t kMaxFrameBytes = 8;

struct CanFrame {
  std::uint32_t id = 0;
  bool extended = false;  ///< 29-bit identifier
  bool remote = false;    ///< RTR: asks for `size` bytes and carries none
  std::uint8_t size = 0;
  std::array<Byte, kMaxFrameBytes> data{};  ///< bytes from `size` on are 0

  [[nodiscard]] Bytes bytes() const { return Bytes(data).first(remote ? 0 : size); }
  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

/// A standard data frame.
[[nodiscard]] inline CanFrame data_frame(std::uint32_t id, Bytes bytes) {
  assert(id <= kMaxStandardId && bytes.size() <= kMaxFrameBytes);
  CanFrame frame;
  frame.id = id;
  frame.size = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  return frame;
}

/// A standard remote frame.
[[nodiscard]] inline CanFrame remote_frame(std::uint32_t id, std::uint8_t size) {
  assert(id <= kMaxStandardId && size <= kMaxFrameBytes);
  CanFrame frame;
  frame.id = id;
  frame.remote = true;
  frame.size = size;
  return frame;
}

}  // namespace axisgate::can
