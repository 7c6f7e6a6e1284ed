// CAN frames in the notation of the manuals, exchanges, and the printers that make a failure readable.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "adapters/can/can_frame.hpp"
#include "adapters/canopen/canopen_text.hpp"

namespace axisgate::can {

inline void PrintTo(const CanFrame& frame, std::ostream* out) {
  *out << std::hex << frame.id << (frame.remote ? " remote" : " " + hex_text(frame.bytes())) << std::dec << " ("
       << canopen::describe(frame) << ")";
}

}  // namespace axisgate::can

namespace axisgate::bus {

inline void PrintTo(const ExchangeResult& result, std::ostream* out) {
  *out << text(result.code) << std::hex << " detail 0x" << result.detail;
  for (const ReplyField& field : result.fields) {
    *out << " " << field.object.index << ":" << int{field.object.sub} << "=0x" << field.raw << "/" << int{field.size};
  }
  if (result.bytes) *out << std::dec << " " << result.bytes->size() << " bytes";
  *out << std::dec << (result.more ? " more" : "") << (result.for_now ? " for now" : "");
}

inline void PrintTo(const Notice& notice, std::ostream* out) {
  static constexpr std::array kKinds{"started", "present", "gone", "values", "emergency", "twin", "babbling"};
  *out << kKinds.at(static_cast<std::size_t>(notice.kind)) << " node " << int{notice.node} << " state "
       << static_cast<int>(notice.state) << std::hex << " code 0x" << notice.code << std::dec << " repeats "
       << notice.repeats << " fields " << notice.fields.size();
}

}  // namespace axisgate::bus

namespace axisgate::test {

using namespace std::chrono_literals;
using can::CanFrame;
using ByteRow = std::vector<Byte>;

/// "01 2B 40" to bytes.
inline ByteRow from_hex(std::string_view hex) {
  ByteRow bytes;
  for (std::size_t at = 0; at + 1 < hex.size(); at += 3) {
    bytes.push_back(static_cast<Byte>(std::stoi(std::string(hex.substr(at, 2)), nullptr, 16)));
  }
  return bytes;
}

inline CanFrame frame_of(std::uint32_t id, std::string_view hex) { return can::data_frame(id, from_hex(hex)); }

inline bus::Exchange read_of(std::uint16_t index, std::uint8_t sub = 0, std::uint8_t size = 0, std::uint8_t node = 1) {
  bus::Exchange exchange;
  exchange.node = node;
  exchange.object = {index, sub};
  exchange.size = size;
  return exchange;
}
inline bus::Exchange write_of(std::uint16_t index, std::uint32_t raw, std::uint8_t size, std::uint8_t node = 1) {
  bus::Exchange exchange = read_of(index, 0, size, node);
  exchange.access = bus::Access::write;
  exchange.raw = raw;
  return exchange;
}
inline bus::Exchange long_read_of(std::uint16_t index, std::uint8_t sub = 0, std::uint8_t node = 1) {
  bus::Exchange exchange = read_of(index, sub, 0, node);
  exchange.part = bus::Part::first;
  return exchange;
}
inline bus::Exchange long_write_of(std::uint16_t index, const ByteRow& bytes, std::uint8_t node = 1) {
  bus::Exchange exchange = long_read_of(index, 0, node);
  exchange.access = bus::Access::write;
  exchange.bytes = std::make_shared<const ByteRow>(bytes);
  return exchange;
}
inline bus::Exchange next_of(bus::Exchange exchange) {
  exchange.part = bus::Part::next;
  return exchange;
}
inline bus::Exchange nmt_of(std::uint32_t code, std::uint8_t node) {
  bus::Exchange exchange;
  exchange.node = node;
  exchange.access = bus::Access::command;
  exchange.raw = code;
  return exchange;
}

inline bus::ExchangeResult value_of(std::uint16_t index, std::uint8_t size, std::uint32_t raw, std::uint8_t sub = 0) {
  bus::ExchangeResult result;
  result.fields.push_back({{index, sub}, size, raw});
  return result;
}
inline bus::ExchangeResult refusal_of(std::uint32_t code, bool for_now = false) {
  bus::ExchangeResult result;
  result.code = Errc::refused_by_drive;
  result.detail = code;
  result.for_now = for_now;
  return result;
}

/// Bytes that differ from their neighbours, so that a segment in the wrong place shows.
inline ByteRow content_of(std::size_t size) {
  ByteRow bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<Byte>(i * 31 + i / 256 + 1));
  return bytes;
}

}  // namespace axisgate::test
