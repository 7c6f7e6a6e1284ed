// SPDX-License-Identifier: Apache-2.0
// Keya's serial protocols on a line of bytes, as the bus sees them: queries and control frames out, answers back.
// Promises at most one reply per send(), none after abandon() or a loss of the link; that a frame cut off by silence
// does not spoil the next one; that a line that babbles is opened again three times and then reported down until it is
// quiet. Never queues or repeats a request, and never judges a value.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "adapters/bus/byte_link.hpp"
#include "adapters/bus/wire.hpp"
#include "adapters/keya/keya_serial_codec.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::keya {

struct KeyaSerialSettings {
  std::string name;  ///< the bus's, for the log
  KeyaLine line = KeyaLine::rs232;
  std::uint32_t baud = 115200;
};

/// RS232 joins two: its frames carry no number, and its heartbeat is reported of this one.
inline constexpr std::uint8_t kRs232Node = 1;

/// A frame that has begun and does not go on for so long is over. Longer than a USB adapter's latency timer (16 ms),
/// which may part the bytes of one frame.
inline constexpr Duration kInterByteTimeout = std::chrono::milliseconds(20);

/// After so long without one, the next heartbeat is news. Its period is not documented for RS232; on CAN it is 1 s.
inline constexpr Duration kSerialHeartbeatSilence = std::chrono::seconds(2);

/// What the wire says of an exchange, beside wire.hpp's rules:
/// - What the protocol cannot say (keya_serial_exchange.hpp) is refused_by_drive in the next turn of the loop, with
///   CiA 301's code for it; nothing is sent. That includes every write that is not a whole control frame.
/// - A control frame, which no reply is documented for, ends ok when its last byte has left, at `baud` and 8N1.
/// - Until the line has shown whether it echoes, an answer that is its query's echo byte for byte (all data 0) is taken
///   for the echo, and the exchange times out: the first query is best one whose answer is never 0.
/// `runtime` and `log` must outlive the wire.
[[nodiscard]] std::unique_ptr<bus::Wire> make_keya_serial_wire(KeyaSerialSettings settings,
                                                               std::unique_ptr<bus::ByteLink> link, Runtime& runtime,
                                                               const Log& log);

}  // namespace axisgate::keya
