#include "adapters/bus/backoff.hpp"

#include <gtest/gtest.h>

namespace axisgate::bus {
namespace {

using namespace std::chrono_literals;

TEST(Backoff, doubles_from_half_a_second_up_to_200_timeouts) {
  Backoff backoff(20ms);
  EXPECT_EQ(backoff.next(), 500ms);
  EXPECT_EQ(backoff.next(), 1s);
  EXPECT_EQ(backoff.next(), 2s);
  EXPECT_EQ(backoff.next(), 4s);
  EXPECT_EQ(backoff.next(), 4s) << "a probe of 20 ms each 4 s is 0.5 % of the bus";
}

TEST(Backoff, never_pauses_longer_than_a_minute) {
  Backoff backoff(1s);
  Duration pause{};
  for (int i = 0; i < 20; ++i) pause = backoff.next();
  EXPECT_EQ(pause, 60s);
}

TEST(Backoff, starts_anew_after_a_reset) {
  Backoff backoff(100ms);
  (void)backoff.next();
  (void)backoff.next();
  backoff.reset();
  EXPECT_EQ(backoff.next(), 500ms);
}

}  // namespace
}  // namespace axisgate::bus
