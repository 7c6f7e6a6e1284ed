// SPDX-License-Identifier: Apache-2.0
// The system calls on a raw CAN socket: open, receive, transmit; blocking ones none.
// Promises a descriptor that hears the frames asked for and every error frame, with time stamps and the count of what
// was dropped, or a text that names the interface and what to do about it. Never decides what an error means.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "adapters/can/can_error.hpp"
#include "adapters/can/can_filter_set.hpp"

namespace axisgate::can {

/// Half a second of a full bus at 1 Mbit/s, with what the kernel adds to each frame.
inline constexpr int kReceiveBufferBytes = 4 << 20;
/// A time stamp older than this, or one in the future, is the wall clock's jump and not the frame's age.
inline constexpr Duration kMaxAge = std::chrono::milliseconds(100);

struct OpenedSocket {
  int descriptor = -1;  ///< the caller's to close; -1: not opened
  bool running = true;  ///< false: the driver says that the controller stands still, as after bus-off
  std::string error;    ///< where not opened
};

[[nodiscard]] OpenedSocket open_raw_socket(const std::string& interface, std::uint32_t bitrate,
                                           const FilterSet& filters);

struct Received {
  enum class Kind : std::uint8_t { nothing, frame, errors, other, failed };
  Kind kind = Kind::nothing;
  CanFrame frame;
  CanErrors errors;
  Duration age{};             ///< since the system received it
  std::uint32_t dropped = 0;  ///< by the system, since the socket was opened; 0 where it does not tell
  int error = 0;              ///< errno, where failed
};

[[nodiscard]] Received receive(int descriptor);

/// How long ago `stamp` was, both on the wall clock; 0 to kMaxAge.
[[nodiscard]] constexpr Duration frame_age(Duration wall_now, Duration stamp) {
  return std::clamp(wall_now - stamp, Duration(0), Duration(kMaxAge));
}

enum class Transmission : std::uint8_t { taken, queue_full, failed };
/// `error`: errno, where failed.
[[nodiscard]] Transmission transmit(int descriptor, const CanFrame& frame, int& error);

/// Whether the system would take another frame.
[[nodiscard]] bool takes_frames(int descriptor);

/// "can0 is down: ip link set can0 up type can bitrate 500000".
[[nodiscard]] std::string interface_trouble(const std::string& interface, std::uint32_t bitrate, int error);

}  // namespace axisgate::can
