// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/ten_byte_frame.hpp"

#include <numeric>

namespace axisgate::simulated {
namespace {

std::uint8_t byte_of(std::uint32_t value, int number) { return static_cast<std::uint8_t>(value >> (8 * number)); }

}  // namespace

bool sums_to_zero(const TenByteFrame& frame) { return (std::accumulate(frame.begin(), frame.end(), 0U) & 0xFFU) == 0; }

std::uint8_t station_of(const TenByteFrame& frame) { return frame[0]; }

FrameCommand command_of(const TenByteFrame& frame) { return static_cast<FrameCommand>(frame[1]); }

std::uint16_t index_of(const TenByteFrame& frame) { return static_cast<std::uint16_t>(frame[2] | (frame[3] << 8)); }

std::uint8_t sub_of(const TenByteFrame& frame) { return frame[4]; }

std::uint32_t data_of(const TenByteFrame& frame) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(frame[5 + i]) << (8 * i);
  return value;
}

TenByteFrame seal(std::uint8_t station, FrameCommand command, std::uint16_t index, std::uint8_t sub,
                  std::uint32_t data) {
  TenByteFrame frame{station,
                     static_cast<std::uint8_t>(command),
                     byte_of(index, 0),
                     byte_of(index, 1),
                     sub,
                     byte_of(data, 0),
                     byte_of(data, 1),
                     byte_of(data, 2),
                     byte_of(data, 3),
                     0};
  frame[9] = static_cast<std::uint8_t>(0U - std::accumulate(frame.begin(), frame.end() - 1, 0U));
  return frame;
}

}  // namespace axisgate::simulated
