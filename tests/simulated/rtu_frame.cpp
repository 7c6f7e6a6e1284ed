// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/rtu_frame.hpp"

namespace axisgate::simulated {

std::uint16_t crc16(RtuView bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte);
    for (int bit = 0; bit < 8; ++bit) {
      const bool low = (crc & 1U) != 0;
      crc = static_cast<std::uint16_t>(low ? (crc >> 1) ^ 0xA001U : crc >> 1);
    }
  }
  return crc;
}

RtuBytes seal_rtu(std::uint8_t unit, RtuView pdu) {
  RtuBytes bytes;
  bytes.reserve(pdu.size() + 3);
  bytes.push_back(unit);
  bytes.insert(bytes.end(), pdu.begin(), pdu.end());
  const std::uint16_t crc = crc16(bytes);
  bytes.push_back(static_cast<std::uint8_t>(crc));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  return bytes;
}

std::optional<RtuFrame> open_rtu(RtuView bytes) {
  if (bytes.size() < 4 || bytes.size() > longest_rtu_frame) return std::nullopt;
  if (crc16(bytes) != 0) return std::nullopt;  // the CRC over a frame and its own CRC is 0
  return RtuFrame{bytes[0], {bytes.begin() + 1, bytes.end() - 2}};
}

std::uint16_t word_at(RtuView bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

void append_word(RtuBytes& bytes, std::uint16_t word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8));
  bytes.push_back(static_cast<std::uint8_t>(word));
}

RtuBytes read_pdu(std::uint16_t start, std::uint16_t count) {
  RtuBytes pdu{function::read};
  append_word(pdu, start);
  append_word(pdu, count);
  return pdu;
}

RtuBytes write_pdu(std::uint16_t at, std::uint16_t value) {
  RtuBytes pdu{function::write_one};
  append_word(pdu, at);
  append_word(pdu, value);
  return pdu;
}

RtuBytes write_pdu(std::uint16_t start, std::span<const std::uint16_t> values) {
  RtuBytes pdu{function::write_several};
  append_word(pdu, start);
  append_word(pdu, static_cast<std::uint16_t>(values.size()));
  pdu.push_back(static_cast<std::uint8_t>(2 * values.size()));
  for (const std::uint16_t value : values) append_word(pdu, value);
  return pdu;
}

RtuBytes write_long_pdu(std::uint16_t start, std::int64_t value) {
  const auto raw = static_cast<std::uint32_t>(value);
  const std::uint16_t words[] = {static_cast<std::uint16_t>(raw), static_cast<std::uint16_t>(raw >> 16)};
  return write_pdu(start, words);
}

RtuBytes exception_pdu(std::uint8_t function_byte, RtuException code) {
  return {function_byte, static_cast<std::uint8_t>(code)};
}

std::optional<RegisterRequest> register_request(RtuView pdu) {
  if (pdu.size() < 5) return std::nullopt;
  RegisterRequest request{pdu[0], word_at(pdu, 1), 1, {}};
  if (request.function == function::write_one) {
    request.values.push_back(word_at(pdu, 3));
    return pdu.size() == 5 ? std::optional(request) : std::nullopt;
  }
  request.count = word_at(pdu, 3);
  if (request.function == function::read) return pdu.size() == 5 ? std::optional(request) : std::nullopt;
  if (pdu.size() < 6 || pdu[5] != 2 * request.count || pdu.size() != 6U + pdu[5]) return std::nullopt;
  for (std::size_t at = 6; at < pdu.size(); at += 2) request.values.push_back(word_at(pdu, at));
  return request;
}

RtuBytes read_reply(std::span<const std::uint16_t> registers) {
  RtuBytes pdu{function::read, static_cast<std::uint8_t>(2 * registers.size())};
  for (const std::uint16_t value : registers) append_word(pdu, value);
  return pdu;
}

RtuBytes write_reply(const RegisterRequest& request) {
  RtuBytes pdu{request.function};
  append_word(pdu, request.start);
  append_word(pdu, request.function == function::write_one ? request.values.front() : request.count);
  return pdu;
}

}  // namespace axisgate::simulated
