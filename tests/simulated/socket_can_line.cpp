// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/socket_can_line.hpp"

#include <bit>

namespace axisgate::simulated {
namespace {

// <linux/can.h> and <linux/can/error.h>
constexpr std::uint32_t extended_flag = 0x80000000;
constexpr std::uint32_t remote_flag = 0x40000000;
constexpr std::uint32_t error_flag = 0x20000000;
constexpr std::uint32_t error_controller = 0x004;
constexpr std::uint32_t error_acknowledge = 0x020;
constexpr std::uint32_t error_bus_off = 0x040;
constexpr std::uint32_t error_restarted = 0x100;
constexpr std::uint8_t sending_passive = 0x20;
constexpr std::size_t length_at = 4;
constexpr std::size_t data_at = 8;

using SocketFrame = std::array<std::uint8_t, socket_frame_bytes>;

void put_identifier(SocketFrame& bytes, std::uint32_t value) {
  if constexpr (std::endian::native == std::endian::little) {
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
  } else {
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  }
}

std::uint32_t identifier_in(CanView bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t at = std::endian::native == std::endian::little ? i : 3 - i;
    value |= std::uint32_t{bytes[at]} << (8 * i);
  }
  return value;
}

}  // namespace

SocketFrame socket_frame_of(const BusFrame& frame) {
  SocketFrame bytes{};
  put_identifier(bytes, frame.id | (frame.extended ? extended_flag : 0) | (frame.remote ? remote_flag : 0));
  bytes[length_at] = frame.size;
  const CanView data = bytes_of(frame);
  std::copy(data.begin(), data.end(), bytes.begin() + data_at);
  return bytes;
}

std::optional<BusFrame> frame_of_socket(CanView bytes) {
  if (bytes.size() < socket_frame_bytes) return std::nullopt;
  const std::uint32_t identifier = identifier_in(bytes);
  if ((identifier & error_flag) != 0) return std::nullopt;
  const std::size_t size = std::min<std::size_t>(bytes[length_at], longest_can_frame);
  BusFrame frame = bus_frame(0, bytes.subspan(data_at, size));
  frame.extended = (identifier & extended_flag) != 0;
  frame.remote = (identifier & remote_flag) != 0;
  frame.id = identifier & (frame.extended ? 0x1FFFFFFFU : 0x7FFU);
  if (frame.remote) frame.data = {};
  return frame;
}

void SocketCanLine::from_host(std::span<const std::uint8_t> bytes, Time now) {
  for (; bytes.size() >= socket_frame_bytes; bytes = bytes.subspan(socket_frame_bytes)) {
    if (const auto frame = frame_of_socket(bytes)) bus().from_host(*frame, now);
  }
}

void SocketCanLine::to_host(const CanToHost& frame) { give(frame.at, frame.tag, socket_frame_of(frame.frame)); }

void SocketCanLine::tell_error(std::uint32_t classes, std::uint8_t controller, Time now) {
  SocketFrame bytes{};
  put_identifier(bytes, error_flag | classes);
  bytes[length_at] = longest_can_frame;
  bytes[data_at + 1] = controller;
  give(now, 0, bytes);
}

void SocketCanLine::set_bus_off(bool off, Time now) {
  bus().set_bus_off(off);
  tell_error(off ? error_bus_off : error_restarted, 0, now);
}

void SocketCanLine::miss_acknowledge(Time now) {
  tell_error(error_acknowledge | error_controller, sending_passive, now);
}

}  // namespace axisgate::simulated
