// SPDX-License-Identifier: Apache-2.0
// The drive's view of Kinco's ten-byte RS232 frame (JD 2.1, MD 2.2), written from the sheets alone.
// Promises: what seal() closed sums to 0 mod 256, and the accessors read the little-endian fields where the sheet puts
// them. Never uses the gateway's codec, so that a mistake there cannot hide here.
#pragma once

#include <array>
#include <cstdint>

namespace axisgate::simulated {

inline constexpr std::size_t frame_length = 10;

using TenByteFrame = std::array<std::uint8_t, frame_length>;

enum class FrameCommand : std::uint8_t {
  write_4 = 0x23,
  write_2 = 0x2B,
  write_1 = 0x2F,
  read = 0x40,
  write_done = 0x60,
  read_4 = 0x43,
  read_2 = 0x4B,
  read_1 = 0x4F,
  error = 0x80,
};

bool sums_to_zero(const TenByteFrame& frame);

std::uint8_t station_of(const TenByteFrame& frame);
FrameCommand command_of(const TenByteFrame& frame);
std::uint16_t index_of(const TenByteFrame& frame);
std::uint8_t sub_of(const TenByteFrame& frame);
std::uint32_t data_of(const TenByteFrame& frame);

// A whole frame with its checksum.
TenByteFrame seal(std::uint8_t station, FrameCommand command, std::uint16_t index, std::uint8_t sub,
                  std::uint32_t data);

}  // namespace axisgate::simulated
