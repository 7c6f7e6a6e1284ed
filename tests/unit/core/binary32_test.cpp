// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/binary32.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace axisgate {
namespace {

constexpr std::uint32_t bits(float number) { return std::bit_cast<std::uint32_t>(number); }
float number(std::uint32_t of) { return std::bit_cast<float>(of); }

const Rational kTurns(1, 10000), kRpm(1, 1000), kPerTurn(10000);

TEST(Binary32, IsTheNearestOfAnExactNumber) {
  EXPECT_EQ(to_binary32(0, kTurns), bits(0.0F));
  EXPECT_EQ(to_binary32(15000, kTurns), bits(1.5F));
  EXPECT_EQ(to_binary32(-15000, kTurns), bits(-1.5F));
  EXPECT_EQ(to_binary32(1, kTurns), bits(0.0001F));
  EXPECT_EQ(to_binary32(1, Rational(1, 3)), 0x3EAA'AAABU);
  EXPECT_EQ(to_binary32(2147483647, Rational(1)), bits(2147483648.0F)) << "one more bit in the exponent";
  EXPECT_EQ(to_binary32(16777217, Rational(1)), bits(16777216.0F)) << "a tie: the even one";
  EXPECT_EQ(to_binary32(16777219, Rational(1)), bits(16777220.0F)) << "a tie: the even one";
  EXPECT_EQ(to_binary32(33554433, Rational(1, 2)), bits(16777216.0F));
  EXPECT_EQ(to_binary32(-33554435, Rational(1, 2)), bits(-16777218.0F));
  EXPECT_EQ(to_binary32(1, Rational(1, INT64_MAX)), bits(0x1p-63F)) << "the smallest there is";
  EXPECT_EQ(to_binary32(INT64_MAX, Rational(INT64_MAX)), bits(0x1p126F)) << "the largest";
  EXPECT_EQ(to_binary32(INT64_MIN, Rational(INT64_MAX)), bits(-0x1p126F));
}

TEST(Binary32, BecomesWholeUnitsWithOneRoundingHalfAwayFromZero) {
  EXPECT_EQ(from_binary32(bits(1.5F), kPerTurn), 15000);
  EXPECT_EQ(from_binary32(bits(-1.5F), kPerTurn), -15000);
  EXPECT_EQ(from_binary32(bits(0.5F), Rational(1)), 1);
  EXPECT_EQ(from_binary32(bits(-0.5F), Rational(1)), -1);
  EXPECT_EQ(from_binary32(bits(std::nextafter(0.5F, 0.0F)), Rational(1)), 0);
  EXPECT_EQ(from_binary32(bits(2.5F), Rational(1)), 3);
  EXPECT_EQ(from_binary32(bits(2.5F), Rational(-1)), -3);
  EXPECT_EQ(from_binary32(bits(0.0F), kPerTurn), 0);
  EXPECT_EQ(from_binary32(bits(-0.0F), kPerTurn), 0);
  EXPECT_EQ(from_binary32(bits(0.1F), Rational(37, 60000)), 0);
  EXPECT_EQ(from_binary32(bits(0.1F), Rational(60000, 37)), 162);
  EXPECT_EQ(from_binary32(bits(std::numeric_limits<float>::denorm_min()), kPerTurn), 0);
  EXPECT_EQ(from_binary32(bits(0x1p-140F), Rational(INT64_MAX)), 0);
  EXPECT_EQ(from_binary32(bits(0x1p61F), Rational(1)), 0x2000'0000'0000'0000);
}

TEST(Binary32, ThatIsNoNumberOrTooLargeIsNone) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float none : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN(), 0x1p62F, -0x1p62F,
                           std::numeric_limits<float>::max()})
    EXPECT_EQ(from_binary32(bits(none), Rational(1)), std::nullopt) << none;
  EXPECT_EQ(from_binary32(bits(std::numeric_limits<float>::max()), Rational(1, INT64_MAX)), std::nullopt);
  EXPECT_EQ(from_binary32(0x7F80'0001, kPerTurn), std::nullopt) << "a signalling NaN";
  EXPECT_TRUE(is_nan_binary32(kBinary32NaN));
  EXPECT_TRUE(is_nan_binary32(0xFFFF'FFFF));
  EXPECT_FALSE(is_nan_binary32(bits(kInfinity)));
  EXPECT_FALSE(is_nan_binary32(bits(1.0F)));
}

TEST(Binary32, AgreesWithTheProcessorOnAnyNumber) {
  std::mt19937_64 draw(7);
  for (int i = 0; i < 200'000; ++i) {
    const auto value = static_cast<std::int32_t>(draw() >> (32 + draw() % 32));
    const Rational scale(1 + static_cast<std::int64_t>(draw() % 100'000),
                         1 + static_cast<std::int64_t>(draw() % 100'000));
    const long double exact = static_cast<long double>(value) * static_cast<long double>(scale.numerator()) /
                              static_cast<long double>(scale.denominator());
    ASSERT_EQ(to_binary32(value, scale), bits(static_cast<float>(exact))) << value;
    const float panel = number(bits(static_cast<float>(exact)));
    const long double back = static_cast<long double>(panel) * static_cast<long double>(scale.denominator()) /
                             static_cast<long double>(scale.numerator());
    ASSERT_EQ(from_binary32(bits(panel), scale.inverse()), static_cast<std::int64_t>(std::round(back))) << panel;
  }
}

// 24 bits of turns: to 1/10000 up to 1024 turns, to less than 1/5000 up to 2048.
TEST(Binary32, KeepsATenThousandthOfATurnUpTo1024Turns) {
  for (std::int64_t value = -10'240'000; value < 10'240'000; value += 127) {
    ASSERT_EQ(from_binary32(to_binary32(value, kTurns), kPerTurn), value);
    ASSERT_EQ(from_binary32(to_binary32(value + 1, kTurns), kPerTurn), value + 1);
  }
  for (std::int64_t value = 10'240'000; value <= 20'480'000; value += 127)
    ASSERT_LE(std::abs(from_binary32(to_binary32(value, kTurns), kPerTurn).value() - value), 1);
  int lost = 0;
  for (std::int64_t value = 10'240'000; value < 10'240'100; ++value)
    lost += from_binary32(to_binary32(value, kTurns), kPerTurn) == value ? 0 : 1;
  EXPECT_GT(lost, 10) << "the limit is where it is said to be";
}

}  // namespace
}  // namespace axisgate
