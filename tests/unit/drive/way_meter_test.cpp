// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/watch/way_meter.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive {
namespace {

constexpr double kUnits = 10'000;

TEST(WayMeter, CountsToAndFro) {
  WayMeter meter;
  EXPECT_EQ(meter.to(5000, kUnits), 0U) << "from wherever it is";
  EXPECT_EQ(meter.to(15000, kUnits), 1'000'000U);
  EXPECT_EQ(meter.to(-10000, kUnits), 2'500'000U);
}

TEST(WayMeter, CountsNoTremblingOfAMotorThatStands) {
  WayMeter meter;
  std::uint64_t way = 0;
  for (int i = 0; i < 1000; ++i) way += meter.to(i % 3 * 4, kUnits);
  EXPECT_EQ(way, 0U);
}

TEST(WayMeter, CountsWhatIsSlowInTime) {
  WayMeter meter;
  std::uint64_t way = 0;
  for (int position = 0; position <= 10'000; ++position) way += meter.to(position, kUnits);
  EXPECT_EQ(way, 1'000'000U);
}

TEST(WayMeter, CountsNothingOverAGapOrTheEndOfTheCounter) {
  WayMeter meter;
  EXPECT_EQ(meter.to(0, kUnits), 0U);
  meter.lose();
  EXPECT_EQ(meter.to(50'000, kUnits), 0U);
  EXPECT_EQ(meter.to(60'000, kUnits), 1'000'000U);
  WayMeter wraps;
  EXPECT_EQ(wraps.to(INT32_MAX - 5000, kUnits), 0U);
  EXPECT_EQ(wraps.to(INT32_MIN + 4999, kUnits), 0U);
  EXPECT_EQ(wraps.to(INT32_MIN + 14'999, kUnits), 1'000'000U) << "and goes on behind it";
}

}  // namespace
}  // namespace axisgate::drive
