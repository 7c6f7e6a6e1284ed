// SPDX-License-Identifier: Apache-2.0
// Frames as the manuals print them, and exchanges.
#pragma once

#include "adapters/kinco/kinco_exchange.hpp"
#include "adapters/kinco/kinco_text.hpp"
#include "tests/unit/bus/wire_stage.hpp"

namespace axisgate::kinco {

inline void PrintTo(const Frame& frame, std::ostream* out) {
  *out << "station " << int{frame.node} << " " << describe(frame);
}

}  // namespace axisgate::kinco

namespace axisgate::test {

inline bus::Exchange read_of(std::uint16_t index, std::uint8_t sub = 0, std::uint8_t size = 0, std::uint8_t node = 1) {
  return {.node = node, .access = bus::Access::read, .object = {index, sub}, .size = size, .raw = 0};
}
inline bus::Exchange write_of(std::uint16_t index, std::uint32_t raw, std::uint8_t size, std::uint8_t node = 1) {
  return {.node = node, .access = bus::Access::write, .object = {index, 0}, .size = size, .raw = raw};
}

// The statusword of station 1, as the MD sheet prints it.
inline constexpr std::string_view kReadStatus = "01 40 41 60 00 00 00 00 00 1E";
inline constexpr std::string_view kStatusReply = "01 4B 41 60 00 37 C0 00 00 1C";
inline constexpr std::string_view kWriteControl = "01 2B 40 60 00 0F 00 00 00 25";

}  // namespace axisgate::test
