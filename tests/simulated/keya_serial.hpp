// SPDX-License-Identifier: Apache-2.0
// What a Keya says to a frame on RS232 or RS485 (4, 5): control frames without a reply, queries, the RS232 heartbeat.
// Promises that data begins at byte 2 on RS232 and at byte 3 on RS485, and a checksum on RS485 alone. Never keeps state
// of its own.
#pragma once

#include "tests/simulated/keya_drive.hpp"
#include "tests/simulated/keya_frame.hpp"

namespace axisgate::simulated {

enum class KeyaWiring : std::uint8_t { rs232, rs485 };

constexpr KeyaInterface interface_of(KeyaWiring wiring) {
  return wiring == KeyaWiring::rs232 ? KeyaInterface::rs232 : KeyaInterface::rs485;
}

// Is the frame one for this drive? A wrong checksum or another number on RS485 means no.
bool keya_hears(const KeyaDrive& drive, KeyaWiring wiring, const KeyaFrame& frame);

// Its query code; none: it is no query.
std::optional<std::uint8_t> keya_query(KeyaWiring wiring, const KeyaFrame& frame);

// Acts on it; nothing: there is no answer.
std::optional<KeyaFrame> keya_answer(KeyaDrive& drive, KeyaWiring wiring, const KeyaFrame& frame, Time now);

KeyaFrame keya_heartbeat(const KeyaDrive& drive);

}  // namespace axisgate::simulated
