// SPDX-License-Identifier: Apache-2.0
// What frames on a CANopen bus are made of: identifiers (CiA 301, predefined connection set), numbers, time on the
// wire. Promises the sheets' identifiers (JD 2.3, MD 4.2, LD2 2.3). Never uses the gateway's codec, so that a mistake
// there cannot hide here.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <span>

#include "tests/simulated/can_node.hpp"

namespace axisgate::simulated {

using CanBytes = std::vector<std::uint8_t>;
using CanView = std::span<const std::uint8_t>;

namespace cob {
inline constexpr std::uint32_t nmt = 0x000;
inline constexpr std::uint32_t sync = 0x080;
inline constexpr std::uint32_t emergency = 0x080;  // + node
inline constexpr std::uint32_t first_tpdo = 0x180;
inline constexpr std::uint32_t first_rpdo = 0x200;
inline constexpr std::uint32_t next_pdo = 0x100;  // from one PDO of a node to its next
inline constexpr std::uint32_t sdo_reply = 0x580;
inline constexpr std::uint32_t sdo_request = 0x600;
inline constexpr std::uint32_t error_control = 0x700;
}  // namespace cob

inline constexpr std::size_t longest_can_frame = 8;

inline BusFrame bus_frame(std::uint32_t id, CanView bytes) {
  BusFrame frame;
  frame.id = id;
  frame.size = static_cast<std::uint8_t>(std::min(bytes.size(), longest_can_frame));
  std::copy_n(bytes.begin(), frame.size, frame.data.begin());
  return frame;
}

inline BusFrame bus_frame(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
  return bus_frame(id, CanView(bytes.begin(), bytes.size()));
}

inline BusFrame bus_remote_frame(std::uint32_t id, std::uint8_t size = 1) {
  BusFrame frame;
  frame.id = id;
  frame.remote = true;
  frame.size = size;
  return frame;
}

inline CanView bytes_of(const BusFrame& frame) { return CanView(frame.data).first(frame.remote ? 0 : frame.size); }

inline std::uint32_t little_endian(CanView bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes.size() && i < 4; ++i) value |= std::uint32_t{bytes[i]} << (8 * i);
  return value;
}

inline CanBytes little_endian(std::uint32_t value, std::size_t width) {
  CanBytes bytes(width);
  for (std::size_t i = 0; i < width; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
  return bytes;
}

// 0 bit/s: no time. Otherwise the bits of the frame with the gap after it and every stuff bit there can be.
inline Time frame_time(const BusFrame& frame, std::uint32_t bit_rate) {
  if (bit_rate == 0) return Time{};
  const std::int64_t data = frame.remote ? 0 : 8 * frame.size;
  const std::int64_t fixed = frame.extended ? 67 : 47;
  const std::int64_t stuffed = ((frame.extended ? 54 : 34) + data - 1) / 4;
  return Time{(fixed + data + stuffed) * 1'000'000'000 / bit_rate};
}

}  // namespace axisgate::simulated
