#include "adapters/bus/load_meter.hpp"

#include <gtest/gtest.h>

namespace axisgate::bus {
namespace {

using namespace std::chrono_literals;

constexpr Instant kStart = Instant{} + 1h;

TEST(LoadMeter, is_idle_before_anything_happens) {
  EXPECT_EQ(LoadMeter().permille(kStart), 0);
  EXPECT_EQ(LoadMeter().permille(kStart + 1h), 0);
}

TEST(LoadMeter, tells_the_share_of_the_last_whole_second) {
  LoadMeter meter;
  meter.set_busy(true, kStart);
  meter.set_busy(false, kStart + 100ms);
  meter.set_busy(true, kStart + 500ms);
  meter.set_busy(false, kStart + 650ms);
  EXPECT_EQ(meter.permille(kStart + 900ms), 0) << "no second is over yet";
  EXPECT_EQ(meter.permille(kStart + 1s), 250);
  EXPECT_EQ(meter.permille(kStart + 1999ms), 250);
  EXPECT_EQ(meter.permille(kStart + 2s), 0) << "an idle second has passed";
}

TEST(LoadMeter, splits_an_exchange_across_the_turn_of_the_second) {
  LoadMeter meter;
  meter.set_busy(false, kStart);
  meter.set_busy(true, kStart + 900ms);
  EXPECT_EQ(meter.permille(kStart + 1s), 100);
  meter.set_busy(false, kStart + 1200ms);
  EXPECT_EQ(meter.permille(kStart + 1500ms), 100);
  EXPECT_EQ(meter.permille(kStart + 2s), 200);
}

TEST(LoadMeter, is_full_while_one_exchange_lasts_for_seconds) {
  LoadMeter meter;
  meter.set_busy(true, kStart);
  EXPECT_EQ(meter.permille(kStart + 1s), 1000);
  EXPECT_EQ(meter.permille(kStart + 7500ms), 1000);
  meter.set_busy(false, kStart + 7500ms);
  EXPECT_EQ(meter.permille(kStart + 7900ms), 1000);
  EXPECT_EQ(meter.permille(kStart + 8s), 500);
}

}  // namespace
}  // namespace axisgate::bus
