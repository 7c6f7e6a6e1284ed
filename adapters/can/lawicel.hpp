// SPDX-License-Identifier: Apache-2.0
// The ASCII protocol of Lawicel's CAN adapters (CAN232/CANUSB manual; "slcan" elsewhere), as bytes and lines.
// Promises that any split of the bytes gives the same lines, that a line is bounded, that what is no line of the
// protocol is counted and skipped, and that a frame is never made of bytes with noise in between.
// Never remembers what was asked.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "adapters/can/can_frame.hpp"

namespace axisgate::can {

/// Longer lines are noise. The longest frame has 30 characters; firmware that boasts in its version may take more.
inline constexpr std::size_t kMaxLawicelLine = 64;

struct LawicelLine {
  enum class Kind : std::uint8_t {
    frame,          ///< t T r R
    done,           ///< CR alone: a command was taken
    refused,        ///< BEL: a command was not taken
    sent,           ///< z or Z: a frame was taken
    status,         ///< Fxx
    version,        ///< Vxxxx
    serial_number,  ///< Nxxxx
  };
  Kind kind = Kind::done;
  CanFrame frame;
  std::optional<std::uint16_t> stamp_ms;  ///< the adapter's own time, where it sends one
  Byte flags = 0;                         ///< of a status
  std::string text;                       ///< of a version or serial number
  friend bool operator==(const LawicelLine&, const LawicelLine&) = default;
};

/// The bits of a status (manual, command F): those of the SJA1000 controller.
namespace lawicel_flag {
inline constexpr Byte kReceiveQueueFull = 0x01;
inline constexpr Byte kTransmitQueueFull = 0x02;
inline constexpr Byte kErrorWarning = 0x04;
inline constexpr Byte kDataOverrun = 0x08;
inline constexpr Byte kErrorPassive = 0x20;
inline constexpr Byte kArbitrationLost = 0x40;
inline constexpr Byte kBusError = 0x80;
}  // namespace lawicel_flag

class LawicelDecoder {
 public:
  /// The line that this byte completes, if it does.
  std::optional<LawicelLine> push(Byte byte);
  /// Forgets half a line: the port was opened again.
  void clear() { line_.clear(); }
  /// Bytes that belonged to no line, since construction.
  [[nodiscard]] std::uint32_t bad_bytes() const { return bad_bytes_; }

 private:
  void drop_line();
  std::string line_;
  bool too_long_ = false;  ///< everything up to the next end of a line is noise
  std::uint32_t bad_bytes_ = 0;
};

/// The frame as a command, CR included.
[[nodiscard]] std::string lawicel_text(const CanFrame& frame);

/// The digit of command S for a bit rate; none where the protocol has no such rate.
[[nodiscard]] std::optional<char> lawicel_rate(std::uint32_t bitrate);

}  // namespace axisgate::can
