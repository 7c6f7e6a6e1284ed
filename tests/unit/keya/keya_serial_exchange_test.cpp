// Control frames: every combination of enables, values of both signs, on both lines.
#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::keya {
namespace {

using test::control_of;
using test::row;

constexpr std::array<std::int32_t, 7> kValues{0, 1, -1, 10000, -10000, INT32_MAX, INT32_MIN};

TEST(KeyaControlFrame, says_on_off_and_value_of_both_motors_in_every_combination) {
  for (const KeyaLine line : {KeyaLine::rs232, KeyaLine::rs485}) {
    for (unsigned code = 0; code < 4; ++code) {
      for (const std::int32_t a : kValues) {
        for (const std::int32_t b : kValues) {
          const bus::Exchange exchange = control_of((code & 1U) != 0, (code & 2U) != 0, a, b, 5);
          ASSERT_FALSE(refusal_of(line, exchange));
          const FrameBytes bytes = encode(line, request_of(line, exchange));
          EXPECT_EQ(bytes[0], 0xE0);
          const std::size_t values_at = line == KeyaLine::rs232 ? 4 : 3;
          EXPECT_EQ(bytes[line == KeyaLine::rs232 ? 1 : 2], code);
          EXPECT_EQ(load_be16(bytes, values_at) << 16 | load_be16(bytes, values_at + 2), a);
          EXPECT_EQ(load_be16(bytes, values_at + 4) << 16 | load_be16(bytes, values_at + 6), b);
          if (line == KeyaLine::rs232) {
            EXPECT_EQ(load_be16(bytes, 2), 0);
            continue;
          }
          EXPECT_EQ(bytes[1], 5);
          unsigned sum = 0;
          for (std::size_t i = 0; i < 11; ++i) sum += bytes[i];
          EXPECT_EQ(bytes[11], sum & 0xFF);
        }
      }
    }
  }
}

TEST(KeyaControlFrame, on_and_off_may_have_any_width_and_only_its_bytes_count) {
  bus::Exchange exchange = control_of(true, false, 7, 8);
  exchange.more[0].raw = 0xFFFFFF01;
  exchange.more[2].size = 4;
  ASSERT_FALSE(refusal_of(KeyaLine::rs485, exchange));
  EXPECT_EQ(request_of(KeyaLine::rs485, exchange), request_of(KeyaLine::rs485, control_of(true, false, 7, 8)));
}

TEST(KeyaControlFrame, is_answered_by_nothing) {
  const bus::Exchange exchange = control_of(true, false, 7, 8);
  for (const KeyaLine line : {KeyaLine::rs232, KeyaLine::rs485}) {
    EXPECT_FALSE(answers(line, request_of(line, exchange), exchange));
    EXPECT_FALSE(answers(line, {.node = 1, .code = 2}, exchange));
  }
}

TEST(KeyaFrameTime, is_twelve_characters_of_ten_bits) {
  EXPECT_EQ(frame_time(9600), std::chrono::microseconds(12500));
  EXPECT_EQ(frame_time(115200), std::chrono::nanoseconds(1041666));
}

}  // namespace
}  // namespace axisgate::keya
