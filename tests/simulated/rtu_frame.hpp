// SPDX-License-Identifier: Apache-2.0
// A Modbus RTU frame as a drive sees it: unit, PDU, CRC-16 (JD 2.2, MD 3.2, iD286pro 2 and 3), written from the sheets
// alone. Promises that what seal_rtu() closed opens again, and that any single wrong bit does not. Never uses the
// gateway's codec, so that a mistake there cannot hide here.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace axisgate::simulated {

using RtuBytes = std::vector<std::uint8_t>;
using RtuView = std::span<const std::uint8_t>;

inline constexpr std::size_t longest_rtu_frame = 256;  // Modbus over serial line V1.02, 2.5.1

namespace function {
inline constexpr std::uint8_t read = 0x03;
inline constexpr std::uint8_t write_one = 0x06;
inline constexpr std::uint8_t write_several = 0x10;
}  // namespace function

// No sheet lists codes (JD 10.2, MD 12.2, iD286pro 12): these are the Modbus application protocol's.
enum class RtuException : std::uint8_t { none, function = 1, address = 2, value = 3, device = 4 };

struct RtuFrame {
  std::uint8_t unit = 0;
  RtuBytes pdu;  // function and data
};

std::uint16_t crc16(RtuView bytes);

// Low byte of the CRC first (all three sheets).
RtuBytes seal_rtu(std::uint8_t unit, RtuView pdu);
// Nothing where the CRC is wrong or the frame is too short to hold a function.
std::optional<RtuFrame> open_rtu(RtuView bytes);

// Big-endian 16 bits, as all fields are.
std::uint16_t word_at(RtuView bytes, std::size_t at);
void append_word(RtuBytes& bytes, std::uint16_t word);

RtuBytes read_pdu(std::uint16_t start, std::uint16_t count);
RtuBytes write_pdu(std::uint16_t at, std::uint16_t value);
RtuBytes write_pdu(std::uint16_t start, std::span<const std::uint16_t> values);
// A 32-bit value, low word first.
RtuBytes write_long_pdu(std::uint16_t start, std::int64_t value);
RtuBytes exception_pdu(std::uint8_t function_byte, RtuException code);

// What a request for registers asks, checked for a length that fits its own counts. Nothing: it does not.
struct RegisterRequest {
  std::uint8_t function = 0;
  std::uint16_t start = 0;
  std::uint16_t count = 1;
  std::vector<std::uint16_t> values;  // of a write
};
std::optional<RegisterRequest> register_request(RtuView pdu);
// The reply to a read, or the acknowledgement of a write.
RtuBytes read_reply(std::span<const std::uint16_t> registers);
RtuBytes write_reply(const RegisterRequest& request);

}  // namespace axisgate::simulated
