// Frames as the manuals print them, exchanges, and the printers that make a failure readable.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "adapters/modbus_rtu/rtu_crc.hpp"

namespace axisgate::bus {

inline void PrintTo(const ExchangeResult& result, std::ostream* out) {
  *out << text(result.code) << ", detail " << result.detail << (result.for_now ? ", for now" : "");
  for (const ReplyField& field : result.fields) {
    *out << ", " << field.object.index << " = " << field.raw << " (" << int{field.size} << " bytes)";
  }
}

}  // namespace axisgate::bus

namespace axisgate::test {

using ByteRow = std::vector<Byte>;

/// "01 2B 40" to bytes.
inline ByteRow from_hex(std::string_view hex) {
  ByteRow bytes;
  for (std::size_t at = 0; at + 1 < hex.size(); at += 3) {
    bytes.push_back(static_cast<Byte>(std::stoi(std::string(hex.substr(at, 2)), nullptr, 16)));
  }
  return bytes;
}

inline ByteRow operator+(ByteRow a, const ByteRow& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The frame as it is on the wire.
inline ByteRow with_crc(ByteRow frame) {
  const std::uint16_t crc = modbus_rtu::crc16(frame);
  frame.push_back(static_cast<Byte>(crc & 0xFF));
  frame.push_back(static_cast<Byte>(crc >> 8));
  return frame;
}
inline ByteRow with_crc(std::string_view hex) { return with_crc(from_hex(hex)); }
/// What the wire sees of it.
inline ByteRow without_crc(const ByteRow& frame) {
  return {frame.begin(), frame.end() - std::ptrdiff_t{modbus_rtu::kCrcSize}};
}

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
inline bus::ExchangeResult value_of(std::uint16_t index, std::uint8_t size, std::uint32_t raw) {
  return values({{{index, 0}, size, raw}});
}
inline bus::ExchangeResult refused(std::uint32_t code, bool for_now) {
  return {.code = Errc::refused_by_drive, .detail = code, .for_now = for_now};
}

/// What the frame is taken for: the result, or why it is not the answer.
inline std::string verdict(const modbus_rtu::Judgement& judgement) {
  if (const auto* reason = std::get_if<modbus_rtu::NotMine>(&judgement)) return std::string(text(*reason));
  return testing::PrintToString(std::get<bus::ExchangeResult>(judgement));
}

inline std::string request_hex(const bus::Exchange& exchange, const modbus_rtu::RtuNode& node = kinco_node()) {
  return hex_text(modbus_rtu::request_of(exchange, node));
}

}  // namespace axisgate::test
