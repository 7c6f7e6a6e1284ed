// SPDX-License-Identifier: Apache-2.0
// Keya's twelve-byte serial frames, bytes to fields and back (KYDAS4860-2E manual, RS232 and RS485 chapters): a start
// byte that says what the frame is, on RS485 the drive's number, a code, data, and on RS485 the sum of bytes 0 to 10.
// Promises decode(encode(f)) == f, and to say honestly "more", "frame" or "bad, skip so many".
// Never remembers anything: RS232 has no sum, so which of several possible frames is meant is the receiver's question.
#pragma once

#include <array>
#include <cstdint>
#include <variant>

#include "gateway/core/bytes.hpp"
#include "gateway/core/clock.hpp"

namespace axisgate::keya {

enum class KeyaLine : std::uint8_t { rs232, rs485 };

inline constexpr std::size_t kFrameSize = 12;
using FrameBytes = std::array<Byte, kFrameSize>;

/// The first byte.
inline constexpr Byte kControl = 0xE0;    ///< to the drive; no reply to it is documented
inline constexpr Byte kQuery = 0xED;      ///< and its answer, which begins with the same bytes
inline constexpr Byte kHeartbeat = 0xEE;  ///< RS232 alone, from the drive

/// What a query asks for; its code.
enum class Query : std::uint8_t {
  control_state = 0x00,
  electrical_angle = 0x01,
  speed = 0x02,
  current = 0x03,
  mechanical_angle = 0x04,
  voltage = 0x05,
  temperature = 0x06,
  faults = 0x07,
  encoder = 0x08,
  version = 0x09,
};
inline constexpr std::uint8_t kQueries = 10;

/// Bytes of data in an answer.
[[nodiscard]] constexpr std::size_t data_size(KeyaLine line) { return line == KeyaLine::rs232 ? 10 : 8; }

struct SerialFrame {
  Byte start = kQuery;
  std::uint8_t node = 0;  ///< RS485; 0 on RS232
  std::uint8_t code = 0;  ///< of a query, or a control frame's enable code: bit 0 motor A, bit 1 motor B
  /// Of an answer its data; of a control frame the values of motors A and B; of a heartbeat bytes 1 to 10. The rest 0.
  std::array<Byte, 10> data{};
  /// Of a heartbeat: its last byte is what we believe it to be. The manual does not say how it is formed.
  bool sum_as_believed = true;
  friend bool operator==(const SerialFrame&, const SerialFrame&) = default;
};

/// Of a heartbeat: with the sum that we believe in, or as if `sum_as_believed` were not there.
[[nodiscard]] FrameBytes encode(KeyaLine line, const SerialFrame& frame);

struct NeedMore {
  friend bool operator==(const NeedMore&, const NeedMore&) = default;
};
struct Bad {
  std::size_t skip = 1;  ///< bytes that cannot start a frame
  friend bool operator==(const Bad&, const Bad&) = default;
};
using Decoded = std::variant<NeedMore, SerialFrame, Bad>;

/// What `bytes` start with. On RS485 the sum must be right. On RS232 an answer's unused bytes must be 0, as the manual
/// prints them; a heartbeat must have the sum we believe in or, without it, two electrical angles within 0 to 1000.
[[nodiscard]] Decoded decode(KeyaLine line, Bytes bytes);

[[nodiscard]] bool may_start(KeyaLine line, Byte byte);
/// Whether `head`, the first bytes of a frame, may become the answer of `node` to the query `code`.
[[nodiscard]] bool may_become_answer(KeyaLine line, Bytes head, std::uint8_t node, std::uint8_t code);

/// Time on the wire of one frame, 8N1. `baud` above 0.
[[nodiscard]] Duration frame_time(std::uint32_t baud);

}  // namespace axisgate::keya
