// SPDX-License-Identifier: Apache-2.0
// CAN frames in the notation of the manuals, and exchanges.
#pragma once

#include "adapters/can/can_frame.hpp"
#include "adapters/canopen/canopen_text.hpp"
#include "tests/unit/bus/wire_stage.hpp"

namespace axisgate::can {

inline void PrintTo(const CanFrame& frame, std::ostream* out) {
  *out << std::hex << frame.id << (frame.remote ? " remote" : " " + hex_text(frame.bytes())) << std::dec << " ("
       << canopen::describe(frame) << ")";
}

}  // namespace axisgate::can

namespace axisgate::test {

using can::CanFrame;

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
  return {.node = node, .access = bus::Access::command, .object = {}, .raw = code};
}

/// Bytes that differ from their neighbours, so that a segment in the wrong place shows.
inline ByteRow content_of(std::size_t size) {
  ByteRow bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<Byte>(i * 31 + i / 256 + 1));
  return bytes;
}

}  // namespace axisgate::test
