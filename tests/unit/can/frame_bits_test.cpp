// SPDX-License-Identifier: Apache-2.0
// The bits of a frame on the wire, against numbers worked out by another program from ISO 11898-1.
#include "adapters/can/frame_bits.hpp"

#include <gtest/gtest.h>

namespace axisgate::can {
namespace {

struct Counted {
  std::uint32_t id;
  bool extended, remote;
  std::uint8_t size;
  std::array<Byte, kMaxFrameBytes> data;
  int bits;
};

TEST(FrameBits, AreThoseOfTheFrameWithItsOwnStuffBits) {
  const Counted frames[] = {
      {0x0, false, false, 0, {}, 53},
      {0x7FF, false, false, 8, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}, 126},
      {0x181, false, false, 6, {0x37, 0x06, 0x10, 0x27, 0x00, 0x00}, 102},
      {0x601, false, false, 8, {0x40, 0x41, 0x60, 0x00, 0x00, 0x00, 0x00, 0x00}, 123},
      {0x701, false, false, 1, {0x05}, 58},
      {0x701, false, true, 1, {}, 51},
      {0x555, false, false, 8, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55}, 112},
      {0x6000001, true, false, 8, {0x23, 0x0D, 0x20, 0x01, 0x00, 0x00, 0x00, 0x00}, 144},
      {0x1FFFFFFF, true, false, 8, {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}, 151},
  };
  for (const Counted& f : frames) {
    const CanFrame frame{.id = f.id, .extended = f.extended, .remote = f.remote, .size = f.size, .data = f.data};
    EXPECT_EQ(bits_on_wire(frame), f.bits) << std::hex << f.id;
  }
}

TEST(FrameBits, LieBetweenNoStuffBitAndAsManyAsThereCanBe) {
  std::uint32_t noise = 1;
  for (int i = 0; i < 10'000; ++i) {
    CanFrame frame;
    const auto next = [&noise] { return noise = noise * 1664525U + 1013904223U; };
    frame.id = next() >> 21U;
    frame.size = static_cast<std::uint8_t>((next() >> 16U) % (kMaxFrameBytes + 1));
    for (std::size_t k = 0; k < frame.size; ++k) frame.data.at(k) = static_cast<Byte>(next() >> 24U);
    const int nominal = 47 + 8 * frame.size;
    EXPECT_GE(bits_on_wire(frame), nominal);
    EXPECT_LE(bits_on_wire(frame), nominal + (33 + 8 * frame.size) / 4);
  }
}

}  // namespace
}  // namespace axisgate::can
