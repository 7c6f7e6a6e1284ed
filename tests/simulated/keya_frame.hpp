// SPDX-License-Identifier: Apache-2.0
// The twelve-byte frames of a Keya on RS232 and RS485 (4, 5), as the drive sees them, and numbers high byte first.
// Promises that on RS485 byte 11 is the sum of the others. Never uses the gateway's codec, so that a mistake there
// cannot hide here.
#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>

#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

inline constexpr std::size_t keya_frame_length = 12;
using KeyaFrame = std::array<std::uint8_t, keya_frame_length>;

namespace keya_start {
inline constexpr std::uint8_t control = 0xE0;
inline constexpr std::uint8_t query = 0xED;
inline constexpr std::uint8_t heartbeat = 0xEE;
}  // namespace keya_start

inline void put_big_endian(std::span<std::uint8_t> place, std::int64_t value) {
  for (std::size_t i = place.size(); i > 0; --i) {
    place[i - 1] = static_cast<std::uint8_t>(value);
    value >>= 8;
  }
}

inline std::uint32_t big_endian(std::span<const std::uint8_t> bytes) {
  return std::accumulate(bytes.begin(), bytes.end(), std::uint32_t{0},
                         [](std::uint32_t sum, std::uint8_t byte) { return sum << 8 | byte; });
}

inline std::uint8_t keya_sum(const KeyaFrame& frame) {
  return static_cast<std::uint8_t>(std::accumulate(frame.begin(), frame.end() - 1, 0U));
}

inline KeyaFrame seal_keya(KeyaFrame frame) {
  frame.back() = keya_sum(frame);
  return frame;
}

// Collects the bytes a drive hears: twelve of them from a start byte on, begun anew after a pause.
class KeyaReceiver {
 public:
  // No pause is stated; with a fixed length and no delimiter, silence is the only mark.
  static constexpr Time gap = std::chrono::milliseconds(20);

  std::optional<KeyaFrame> receive(std::uint8_t byte, Time at) {
    if (filled_ > 0 && at - last_ > gap) filled_ = 0;
    last_ = at;
    if (filled_ == 0 && byte != keya_start::control && byte != keya_start::query) return std::nullopt;
    frame_[filled_++] = byte;
    if (filled_ < keya_frame_length) return std::nullopt;
    filled_ = 0;
    return frame_;
  }
  void forget() { filled_ = 0; }

 private:
  KeyaFrame frame_{};
  std::size_t filled_ = 0;
  Time last_{};
};

}  // namespace axisgate::simulated
