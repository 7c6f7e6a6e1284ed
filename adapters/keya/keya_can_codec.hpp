// SPDX-License-Identifier: Apache-2.0
// Keya's own CAN frames, bytes to fields and back (KYDAS4860-2E manual, CAN chapter): 29-bit ids, always 8 bytes; the
// index little-endian, the data big-endian, the opposite of CANopen.
// Promises decode(encode(m)) == m, and that the filters let through what the named drives send and nothing else.
// Never remembers anything.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "adapters/can/can_link.hpp"

namespace axisgate::keya {

inline constexpr std::uint32_t kCommandId = 0x06000000;    ///< + node: to the drive
inline constexpr std::uint32_t kReplyId = 0x05800000;      ///< + node: from it, asked for
inline constexpr std::uint32_t kHeartbeatId = 0x07000000;  ///< + node: from it, each second, unsolicited

/// Who sent what, as the id says it.
struct CanOrigin {
  enum class Kind : std::uint8_t { reply, heartbeat };
  Kind kind = Kind::reply;
  std::uint8_t node = 0;
  friend bool operator==(const CanOrigin&, const CanOrigin&) = default;
};
/// No value: no data or remote frame that a drive sends by this protocol.
[[nodiscard]] std::optional<CanOrigin> origin_of(const can::CanFrame& frame);

/// What the link hands over: the reply and heartbeat ids of these nodes.
[[nodiscard]] std::vector<can::CanFilter> filters_for(const std::vector<std::uint8_t>& nodes);

struct CanMessage {
  enum class Command : std::uint8_t {
    write = 0x23,
    read = 0x40,
    reply = 0x60,  ///< of both: only the index tells an acknowledgement from a value
  };
  Command command = Command::read;
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::array<Byte, 4> data{};
  friend bool operator==(const CanMessage&, const CanMessage&) = default;
};

/// Indices of commands; those of queries are 0x21xx.
[[nodiscard]] constexpr bool is_command(std::uint16_t index) { return index >> 8 == 0x20; }

[[nodiscard]] std::array<Byte, 8> encode(const CanMessage& message);
/// No value: not eight bytes, or a first byte that the protocol does not have.
[[nodiscard]] std::optional<CanMessage> decode(Bytes bytes);

[[nodiscard]] can::CanFrame extended_frame(std::uint32_t id, Bytes bytes);
[[nodiscard]] can::CanFrame request_frame(std::uint8_t node, const CanMessage& message);

/// The heartbeat's content as fields of the object kHeartbeatIndex, sub 0: at byte 0 and 2 the electrical angles of
/// motors A and B, at 4 the fault word of motor A alone (two bytes each), at 6 and 7 the two bytes of the control
/// state.
inline constexpr std::uint16_t kHeartbeatIndex = 0x7000;
inline constexpr std::size_t kHeartbeatBytes = 8;
/// `bytes`: kHeartbeatBytes of them.
[[nodiscard]] bus::ReplyFields heartbeat_fields(Bytes bytes);

}  // namespace axisgate::keya
