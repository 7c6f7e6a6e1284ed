// SPDX-License-Identifier: Apache-2.0
// Kinco's ten-byte frame, bytes to fields and back (kinco-jd.md 2.1, kinco-md.md 2.2): station, command, index,
// sub-index, four data bytes, and a tenth byte that makes the sum of all ten 0 modulo 256. There are no delimiters.
// Promises decode(encode(f)) == f, and to say honestly "more", "frame" or "bad, skip so many".
// Never allocates, throws or remembers: which of several possible frames is meant is the receiver's question.
#pragma once

#include <array>
#include <cstdint>
#include <variant>

#include "adapters/bus/exchange.hpp"
#include "gateway/core/bytes.hpp"

namespace axisgate::kinco {

inline constexpr std::size_t kFrameSize = 10;
using FrameBytes = std::array<Byte, kFrameSize>;

/// The second byte. Bytes 1 to 8 are a CANopen SDO expedited transfer unchanged, hence CiA 301's command specifiers.
enum class Command : std::uint8_t {
  write_4 = 0x23,
  write_2 = 0x2B,
  write_1 = 0x2F,
  read = 0x40,
  written = 0x60,
  value_4 = 0x43,
  value_2 = 0x4B,
  value_1 = 0x4F,
  error = 0x80,
};

/// A master's command: seen by the master, it is its own echo (drives in a chain, 6510:0B = 1, pass it round).
[[nodiscard]] constexpr bool is_request(Command command) {
  return command == Command::write_4 || command == Command::write_2 || command == Command::write_1 ||
         command == Command::read;
}

/// Bytes of data that a read's answer carries; 0 for every other command.
[[nodiscard]] constexpr std::uint8_t value_size(Command command) {
  switch (command) {
    case Command::value_4:
      return 4;
    case Command::value_2:
      return 2;
    case Command::value_1:
      return 1;
    default:
      return 0;
  }
}

struct Frame {
  std::uint8_t node = 0;
  Command command = Command::read;
  ObjectAddress object;
  std::uint32_t data = 0;  ///< all four data bytes, least significant first; a drive may fill unused ones with FF
  friend bool operator==(const Frame&, const Frame&) = default;
};

[[nodiscard]] FrameBytes encode(const Frame& frame);

struct NeedMore {
  friend bool operator==(const NeedMore&, const NeedMore&) = default;
};
struct Bad {
  enum class Reason : std::uint8_t { sum, command };
  Reason reason = Reason::sum;
  std::size_t skip = 1;  ///< bytes that cannot start a frame
  friend bool operator==(const Bad&, const Bad&) = default;
};
using Decoded = std::variant<NeedMore, Frame, Bad>;

/// What `bytes` start with. Bad skips one byte, no more: the next one may start a good frame.
[[nodiscard]] Decoded decode(Bytes bytes);

}  // namespace axisgate::kinco
