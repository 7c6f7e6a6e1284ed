#include "adapters/serial/reopen_plan.hpp"

#include <gtest/gtest.h>

namespace axisgate::serial {
namespace {

using namespace std::chrono_literals;

constexpr Instant kStart = Instant{} + 1h;

TEST(ReopenPlan, wants_nothing_before_it_is_asked) { EXPECT_EQ(ReopenPlan().due(), kNever); }

TEST(ReopenPlan, tries_at_once_when_asked) {
  ReopenPlan plan;
  plan.on_request(kStart);
  EXPECT_EQ(plan.due(), kStart);
}

TEST(ReopenPlan, tries_again_a_second_after_a_failure_or_a_loss) {
  ReopenPlan plan;
  plan.on_failure(kStart);
  EXPECT_EQ(plan.due(), kStart + 1s);
  plan.on_open();
  EXPECT_EQ(plan.due(), kNever);
  plan.on_loss(kStart + 5s);
  EXPECT_EQ(plan.due(), kStart + 6s);
}

TEST(ReopenPlan, tries_at_once_when_the_path_appears) {
  ReopenPlan plan;
  plan.on_failure(kStart);
  plan.on_path(kStart + 300ms);
  EXPECT_EQ(plan.due(), kStart + 300ms);
}

TEST(ReopenPlan, a_path_that_flaps_causes_a_try_each_20_ms_at_most) {
  ReopenPlan plan;
  plan.on_failure(kStart);
  plan.on_path(kStart + 1ms);
  plan.on_path(kStart + 2ms);
  EXPECT_EQ(plan.due(), kStart + 20ms);
}

TEST(ReopenPlan, a_path_that_appears_never_delays_a_try) {
  ReopenPlan plan;
  plan.on_failure(kStart);
  plan.on_path(kStart + 999ms);
  plan.on_path(kStart + 1500ms);
  EXPECT_EQ(plan.due(), kStart + 999ms);
}

TEST(ReopenPlan, the_path_of_an_open_device_is_of_no_interest) {
  ReopenPlan plan;
  plan.on_open();
  plan.on_path(kStart);
  EXPECT_EQ(plan.due(), kNever);
}

}  // namespace
}  // namespace axisgate::serial
