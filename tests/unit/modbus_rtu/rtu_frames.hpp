// SPDX-License-Identifier: Apache-2.0
// Frames as the manuals print them, and exchanges.
#pragma once

#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "gateway/core/rtu_crc.hpp"
#include "tests/unit/bus/wire_stage.hpp"

namespace axisgate::test {

/// The frame as it is on the wire.
inline ByteRow with_crc(ByteRow frame) {
  const std::uint16_t crc = crc16(frame);
  frame.push_back(static_cast<Byte>(crc & 0xFF));
  frame.push_back(static_cast<Byte>(crc >> 8));
  return frame;
}
inline ByteRow with_crc(std::string_view hex) { return with_crc(from_hex(hex)); }
/// What the wire sees of it.
inline ByteRow without_crc(const ByteRow& frame) { return {frame.begin(), frame.end() - std::ptrdiff_t{kCrcSize}}; }

/// As both Kinco sheets describe them: low word first, and 0x81 for the error of a read.
inline modbus_rtu::RtuNode kinco_node(std::uint8_t node = 1) {
  return {.node = node, .low_word_first = true, .error_functions = {0x81}};
}
/// As the iD286pro's sheet does: low word first, and 255 for all.
inline modbus_rtu::RtuNode stepper_node(std::uint8_t node = 1) {
  return {.node = node, .low_word_first = true, .broadcast = 255};
}

inline bus::Exchange read_of(std::uint16_t index, std::uint8_t size = 2, std::uint8_t node = 1) {
  return {.node = node, .access = bus::Access::read, .object = {index, 0}, .size = size};
}
inline bus::Exchange write_of(std::uint16_t index, std::uint32_t raw, std::uint8_t size, std::uint8_t node = 1) {
  return {.node = node, .access = bus::Access::write, .object = {index, 0}, .size = size, .raw = raw};
}
inline bus::Exchange block_of(std::uint16_t index, std::uint8_t size,
                              const std::vector<std::pair<std::uint16_t, std::uint8_t>>& more, std::uint8_t node = 1) {
  bus::Exchange exchange = read_of(index, size, node);
  for (const auto& [at, bytes] : more) exchange.more.push_back({{at, 0}, bytes});
  return exchange;
}
inline bus::ExchangeResult values(const std::vector<bus::ReplyField>& fields) {
  bus::ExchangeResult result;
  result.fields.assign(fields.begin(), fields.end());
  return result;
}

/// What the frame is taken for: the result, or why it is not the answer.
inline std::string verdict(const modbus_rtu::Judgement& judgement) {
  if (const auto* reason = std::get_if<modbus_rtu::NotMine>(&judgement)) return std::string(text(*reason));
  return testing::PrintToString(std::get<bus::ExchangeResult>(judgement));
}
inline std::string judged(const ByteRow& reply, const bus::Exchange& exchange,
                          const modbus_rtu::RtuNode& node = kinco_node()) {
  return verdict(modbus_rtu::judge(reply, exchange, node));
}
inline std::string shown(const bus::ExchangeResult& result) { return testing::PrintToString(result); }

inline std::string request_hex(const bus::Exchange& exchange, const modbus_rtu::RtuNode& node = kinco_node()) {
  return hex_text(modbus_rtu::request_of(exchange, node));
}

}  // namespace axisgate::test
