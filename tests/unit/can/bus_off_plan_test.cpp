#include "adapters/can/can_bus_off_plan.hpp"

#include <gtest/gtest.h>

namespace axisgate::can {
namespace {

using namespace std::chrono_literals;
using Health = BusOffPlan::Health;

class BusOffPlanTest : public testing::Test {
 protected:
  void tell(const CanErrors& errors) { plan.on_errors(errors, now, trouble); }
  void bus_off() { tell({.bus_off = true}); }
  void restarted() { tell({.restarted = true}); }
  [[nodiscard]] Health health() const { return plan.health(now); }

  Instant now = Instant{} + 1h;
  BusOffPlan plan;
  CanTrouble trouble;
};

TEST_F(BusOffPlanTest, begins_usable_and_waits_for_nothing) {
  EXPECT_EQ(health(), Health::usable);
  EXPECT_EQ(plan.due(now), kNever);
}

TEST_F(BusOffPlanTest, bus_off_counts_at_once_and_until_the_restart) {
  bus_off();
  EXPECT_EQ(health(), Health::bus_off);
  now += 24h;
  EXPECT_EQ(health(), Health::bus_off) << "no time heals a controller that nobody restarts";
  restarted();
  EXPECT_EQ(health(), Health::usable);
}

TEST_F(BusOffPlanTest, a_controller_that_is_error_active_again_was_restarted) {
  bus_off();
  tell({.error_active = true});
  EXPECT_EQ(health(), Health::usable);
}

TEST_F(BusOffPlanTest, an_error_of_another_kind_is_no_restart) {
  bus_off();
  for (const CanErrors& errors : {CanErrors{.no_ack = true}, CanErrors{.error_passive = true},
                                  CanErrors{.protocol_error = true}, CanErrors{.error_warning = true}}) {
    tell(errors);
    EXPECT_EQ(health(), Health::bus_off) << text(errors);
  }
}

TEST_F(BusOffPlanTest, a_controller_found_standing_still_is_bus_off_until_it_runs) {
  plan.on_found_stopped();
  EXPECT_EQ(health(), Health::bus_off);
  plan.on_restart();
  EXPECT_EQ(health(), Health::usable);
  EXPECT_EQ(trouble.bus_offs, 0) << "nobody saw it happen";
}

TEST_F(BusOffPlanTest, five_bus_offs_in_a_minute_are_borne) {
  for (int i = 0; i < 5; ++i) {
    bus_off();
    restarted();
    EXPECT_EQ(health(), Health::usable) << i;
    now += 1s;
  }
  EXPECT_EQ(trouble.bus_offs, 5);
}

TEST_F(BusOffPlanTest, the_sixth_within_a_minute_gives_the_bus_up_for_a_minute_of_quiet) {
  for (int i = 0; i < 6; ++i) {
    bus_off();
    restarted();
    now += 12s;
  }
  const Instant last = now - 12s;
  EXPECT_EQ(health(), Health::given_up);
  EXPECT_EQ(plan.due(now), last + 60s);
  now = last + 30s;
  bus_off();
  restarted();
  now = last + 89s;
  EXPECT_EQ(health(), Health::given_up) << "each further bus-off begins the minute anew";
  now = last + 90s;
  EXPECT_EQ(health(), Health::usable);
}

TEST_F(BusOffPlanTest, six_bus_offs_over_more_than_a_minute_are_borne) {
  for (int i = 0; i < 20; ++i) {
    bus_off();
    restarted();
    EXPECT_EQ(health(), Health::usable) << i;
    now += 12001ms;
  }
}

TEST_F(BusOffPlanTest, after_the_minute_a_bus_that_was_not_restarted_is_still_bus_off) {
  for (int i = 0; i < 6; ++i) bus_off();
  now += 61s;
  EXPECT_EQ(health(), Health::bus_off);
}

TEST_F(BusOffPlanTest, a_sender_that_nobody_hears_is_told_after_half_a_second) {
  tell({.no_ack = true});
  EXPECT_EQ(health(), Health::usable) << "one frame without acknowledgement is no reason";
  tell({.no_ack = true, .error_passive = true});
  const Instant since = now;
  EXPECT_EQ(plan.due(now), since + 500ms);
  for (now = since; now < since + 500ms; now += 100ms) {
    tell({.no_ack = true});
    EXPECT_EQ(health(), Health::usable);
  }
  EXPECT_EQ(health(), Health::no_ack);
}

TEST_F(BusOffPlanTest, with_a_full_queue_it_is_told_at_once) {
  tell({.no_ack = true, .error_passive = true});
  plan.on_queue_full();
  EXPECT_EQ(health(), Health::no_ack);
}

TEST_F(BusOffPlanTest, a_full_queue_alone_says_nothing_about_acknowledgements) {
  plan.on_queue_full();
  EXPECT_EQ(health(), Health::usable);
  tell({.error_passive = true});
  plan.on_queue_full();
  now += 10s;
  EXPECT_EQ(health(), Health::usable) << "a receiver may be error passive, too";
  tell({.no_ack = true});
  EXPECT_EQ(health(), Health::usable) << "what was full before the doubt is forgotten";
}

class NoAckTest : public BusOffPlanTest {
 protected:
  void SetUp() override {
    tell({.no_ack = true, .error_passive = true});
    plan.on_queue_full();
    ASSERT_EQ(health(), Health::no_ack);
  }
};

TEST_F(NoAckTest, goes_on_as_long_as_the_controller_complains) {
  for (int i = 0; i < 20; ++i) {
    now += 900ms;
    EXPECT_EQ(health(), Health::no_ack);
    tell({.no_ack = true});
  }
}

TEST_F(NoAckTest, ends_a_second_after_the_last_complaint) {
  EXPECT_EQ(plan.due(now + 600ms), now + 1s + Duration(1));
  now += 1s + Duration(1);
  EXPECT_EQ(health(), Health::usable);
}

TEST_F(NoAckTest, ends_with_a_frame_from_anybody) {
  plan.on_frame();
  EXPECT_EQ(health(), Health::usable);
  tell({.no_ack = true});
  EXPECT_EQ(health(), Health::usable) << "and needs its time to come back";
}

TEST_F(NoAckTest, ends_when_the_controller_recovers) {
  tell({.error_warning = true});
  EXPECT_EQ(health(), Health::usable);
}

TEST_F(NoAckTest, ends_with_a_restart) {
  plan.on_restart();
  EXPECT_EQ(health(), Health::usable);
}

TEST_F(NoAckTest, bus_off_is_the_greater_trouble) {
  bus_off();
  EXPECT_EQ(health(), Health::bus_off);
}

TEST_F(BusOffPlanTest, counts_what_it_is_told) {
  tell({.no_ack = true, .error_passive = true});
  tell({.no_ack = true, .error_passive = true});
  tell({.error_active = true});
  tell({.error_passive = true});
  tell({.receive_overflow = true});
  bus_off();
  EXPECT_EQ(trouble.error_frames, 6);
  EXPECT_EQ(trouble.no_ack, 2);
  EXPECT_EQ(trouble.error_passive, 2) << "times it went error passive, not frames that say so";
  EXPECT_EQ(trouble.bus_offs, 1);
  EXPECT_EQ(trouble.lost_in, 1);
}

TEST(BusOffPlanText, says_what_to_look_at) {
  EXPECT_NE(text(Health::no_ack).find("nobody acknowledges"), std::string::npos);
  EXPECT_NE(text(Health::bus_off).find("termination"), std::string::npos);
  EXPECT_NE(text(Health::given_up).find("more than 5 times in a minute"), std::string::npos);
}

}  // namespace
}  // namespace axisgate::can
