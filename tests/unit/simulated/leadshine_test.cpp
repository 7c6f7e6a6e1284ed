// The simulated Leadshine LD2-CAN: states, units, the four modes, stops, alarms, as its manual has them.
#include <gmock/gmock.h>

#include "tests/unit/simulated/can_bench.hpp"

namespace axisgate::simulated {
namespace {

using enum Cia402State;

constexpr std::int64_t rpm_1500 = 250000;  // at 10000 units per revolution (4.3)

class Leadshine : public testing::Test {
 protected:
  void start(const LeadshineOptions& options = a_leadshine()) { bench.emplace(options); }
  void enable_in(std::int64_t mode) {
    bench->enable();
    ASSERT_EQ(bench->write(0x6060, 0, mode), 0U);
    ASSERT_EQ(bench->leadshine().state(), operation_enabled);
  }
  void ramps(std::int64_t value) {
    ASSERT_EQ(bench->write(0x6083, 0, value), 0U);
    ASSERT_EQ(bench->write(0x6084, 0, value), 0U);
  }
  bool reached() {
    return bench->pass_until([this] { return (bench->status() & 0x0400) != 0; });
  }
  std::optional<CanBench> bench;
};

TEST_F(Leadshine, GoesThroughTheStatesOfTheManualAndSkipsNone) {
  start();
  EXPECT_EQ(bench->status() & 0x4F, 0x40);
  bench->control(0x0F);
  EXPECT_EQ(bench->leadshine().state(), switch_on_disabled);
  bench->control(0x06);
  EXPECT_EQ(bench->status() & 0x6F, 0x21);
  bench->control(0x07);
  EXPECT_EQ(bench->status() & 0x6F, 0x23);
  bench->control(0x0F);
  EXPECT_EQ(bench->status() & 0x6F, 0x27);
  bench->control(0x07);
  EXPECT_EQ(bench->status() & 0x6F, 0x23);
  bench->control(0x06);
  EXPECT_EQ(bench->status() & 0x6F, 0x21);
  EXPECT_EQ(bench->leadshine().transitions().size(), 6U);
}

TEST_F(Leadshine, HoldsThePrintedDefaults) {
  start();
  EXPECT_EQ(bench->number(0x6083), 10000);
  EXPECT_EQ(bench->number(0x6084), 10000);
  EXPECT_EQ(bench->number(0x6085), 10000000);
  EXPECT_EQ(bench->number(0x6080), 5000);
  EXPECT_EQ(bench->number(0x6072), 3000);
  EXPECT_EQ(bench->number(0x6092, 1), 10000);
  EXPECT_EQ(bench->number(0x6502), 0x2D);
  EXPECT_EQ(bench->number(0x1017), 0);
  EXPECT_EQ(bench->number(0x6061), 8);
  EXPECT_EQ(bench->number(0x1A00, 0), 0);
}

TEST_F(Leadshine, TheWorkedExampleMovesTwoRevolutionsAndBit12SaysNothing) {
  start();
  enable_in(1);
  ramps(rpm_1500);
  ASSERT_EQ(bench->write(0x6081, 0, rpm_1500), 0U);
  ASSERT_EQ(bench->write(0x607A, 0, 20000), 0U);
  bench->control(0x4F);
  bench->pass(milliseconds(20));
  EXPECT_EQ(bench->number(0x6064), 0);
  bench->control(0x5F);
  EXPECT_EQ(bench->status() & 0x1400, 0);
  EXPECT_TRUE(reached());
  EXPECT_EQ(bench->number(0x6064), 20000);
  EXPECT_EQ(bench->status(), 0x0637);
  bench->control(0x4F);
  bench->control(0x5F);
  EXPECT_TRUE(reached());
  EXPECT_EQ(bench->number(0x6064), 40000);
}

TEST_F(Leadshine, Bit12AcknowledgesSetpointsWhereChosen) {
  LeadshineOptions options = a_leadshine();
  options.acknowledges_setpoints = true;
  start(options);
  enable_in(1);
  ASSERT_EQ(bench->write(0x607A, 0, 100), 0U);
  bench->control(0x1F);
  EXPECT_NE(bench->status() & 0x1000, 0);
  bench->control(0x0F);
  EXPECT_EQ(bench->status() & 0x1000, 0);
}

TEST_F(Leadshine, ObjectThirtyOhOneTellsThatAnImmediateMoveMayBegin) {
  start();
  enable_in(1);
  EXPECT_EQ(bench->number(0x3001), 0);
  bench->control(0x2F);
  EXPECT_EQ(bench->number(0x3001), 0x20);
  ASSERT_EQ(bench->write(0x607A, 0, 500), 0U);
  bench->control(0x3F);
  EXPECT_EQ(bench->number(0x3001), 0);
  EXPECT_TRUE(reached());
  EXPECT_EQ(bench->number(0x6064), 500);
}

TEST_F(Leadshine, AStopFrom1500RpmTakes25SecondsWithTheFactorysDeceleration) {
  start();
  enable_in(3);
  ASSERT_EQ(bench->write(0x6083, 0, rpm_1500), 0U);
  ASSERT_EQ(bench->write(0x60FF, 0, rpm_1500), 0U);
  bench->pass(milliseconds(1100));
  EXPECT_NEAR(bench->number(0x606C), rpm_1500, 100);
  EXPECT_EQ(bench->number(0x5501, 1), 1500);
  ASSERT_EQ(bench->write(0x60FF, 0, 0), 0U);
  bench->pass(std::chrono::seconds(24));
  EXPECT_GT(bench->number(0x606C), 0);
  bench->pass(std::chrono::seconds(2));
  EXPECT_EQ(bench->number(0x606C), 0);
  EXPECT_NE(bench->status() & 0x1000, 0);
}

TEST_F(Leadshine, HaltStopsAVelocityAndItsEndGoesOn) {
  for (const bool needs_edge : {false, true}) {
    LeadshineOptions options = a_leadshine();
    options.needs_halt_edge = needs_edge;
    start(options);
    enable_in(3);
    ramps(rpm_1500);
    ASSERT_EQ(bench->write(0x60FF, 0, 25000), 0U);
    bench->pass(milliseconds(500));
    EXPECT_EQ(bench->number(0x606C) != 0, !needs_edge);
    bench->control(0x10F);
    bench->pass(milliseconds(500));
    EXPECT_EQ(bench->number(0x606C), 0);
    EXPECT_EQ(bench->leadshine().state(), operation_enabled);
    bench->control(0x0F);
    bench->pass(milliseconds(500));
    EXPECT_NEAR(bench->number(0x606C), 25000, 100);
  }
}

TEST_F(Leadshine, TorqueFollowsItsSlopeAndTheSpeedLimit) {
  start();
  enable_in(4);
  ASSERT_EQ(bench->write(0x6087, 0, 1000), 0U);
  ASSERT_EQ(bench->write(0x6080, 0, 300), 0U);
  ASSERT_EQ(bench->write(0x6071, 0, 500), 0U);
  bench->pass(milliseconds(250));
  EXPECT_NEAR(bench->number(0x6077), 250, 2);
  bench->pass(milliseconds(2000));
  EXPECT_EQ(bench->number(0x6077), 500);
  EXPECT_EQ(bench->number(0x5501, 1), 300);
}

TEST_F(Leadshine, HomingFindsTheSwitchAndSaysSo) {
  LeadshineOptions options = a_leadshine();
  options.mechanics.home_from = -9000;
  options.mechanics.home_to = -5000;
  start(options);
  enable_in(6);
  ASSERT_EQ(bench->write(0x6099, 1, 30000), 0U);
  ASSERT_EQ(bench->write(0x6099, 2, 20000), 0U);
  ASSERT_EQ(bench->write(0x609A, 0, 300000), 0U);
  ASSERT_EQ(bench->write(0x6098, 0, 22), 0U);
  bench->control(0x1F);
  EXPECT_EQ(bench->status() & 0x3000, 0);
  EXPECT_TRUE(bench->pass_until([this] { return (bench->status() & 0x1000) != 0; }));
  EXPECT_EQ(bench->number(0x6064), 0);
  // A method that the manual lists as not supported.
  ASSERT_EQ(bench->write(0x6098, 0, 15), 0U);
  bench->control(0x0F);
  bench->control(0x1F);
  bench->pass(milliseconds(10));
  EXPECT_NE(bench->status() & 0x2000, 0);
}

TEST_F(Leadshine, Methods35And37NeedNoMotionAndNoTorque) {
  start();
  for (const int method : {35, 37}) {
    bench->control(0x00);
    enable_in(1);
    ASSERT_EQ(bench->write(0x607A, 0, 700), 0U);
    bench->control(0x1F);
    EXPECT_TRUE(reached());
    bench->control(0x06);
    bench->pass(milliseconds(10));
    ASSERT_EQ(bench->write(0x6060, 0, 6), 0U);
    ASSERT_EQ(bench->write(0x6098, 0, method), 0U);
    bench->control(0x16);
    EXPECT_EQ(bench->number(0x6064), 0);
    EXPECT_NE(bench->status() & 0x1000, 0);
  }
}

TEST_F(Leadshine, PIsPr008OrTheFeedConstantOrTheGear) {
  start();
  EXPECT_EQ(bench->leadshine().units_per_revolution(), 10000);
  ASSERT_EQ(bench->write(0x6091, 2, 2), 0U);  // 6092h is the encoder's: the gear counts
  EXPECT_EQ(bench->leadshine().units_per_revolution(), 20000);
  ASSERT_EQ(bench->write(0x6092, 1, 5000), 0U);  // now it does not
  EXPECT_EQ(bench->leadshine().units_per_revolution(), 5000);
  ASSERT_EQ(bench->write(0x2008, 0, 3600), 0U);
  EXPECT_EQ(bench->leadshine().units_per_revolution(), 3600);
  enable_in(1);
  EXPECT_EQ(bench->write(0x6092, 1, 6000), 0x08000022U);
  ramps(100000);
  ASSERT_EQ(bench->write(0x607A, 0, 3600), 0U);
  bench->control(0x1F);
  EXPECT_TRUE(reached());
  EXPECT_EQ(bench->number(0x6063), 10000);
}

TEST_F(Leadshine, QuickStopEndsWhereItsOptionSays) {
  const std::map<std::int64_t, Cia402State> ends{{1, switch_on_disabled}, {2, switch_on_disabled},
                                                 {3, switch_on_disabled}, {5, quick_stop_active},
                                                 {6, quick_stop_active},  {7, quick_stop_active}};
  for (const auto& [option, state] : ends) {
    start();
    ASSERT_EQ(bench->write(0x605A, 0, option), 0U);
    enable_in(3);
    ramps(rpm_1500);
    ASSERT_EQ(bench->write(0x60FF, 0, rpm_1500), 0U);
    bench->pass(milliseconds(1100));
    bench->control(0x02);
    EXPECT_EQ(bench->leadshine().state(), quick_stop_active);
    bench->pass(milliseconds(100));
    EXPECT_EQ(bench->number(0x606C) != 0, option % 4 == 1);  // 6084h takes a second, the others 25 ms and less
    bench->pass(milliseconds(1000));
    EXPECT_EQ(bench->leadshine().state(), state) << option;
    EXPECT_EQ(bench->number(0x606C), 0);
  }
}

TEST_F(Leadshine, AnAlarmIsClearedByARisingBit7OrBy4000hOnceItsCauseIsGone) {
  start();
  for (const bool by_controlword : {true, false}) {
    bench->control(0x00);
    enable_in(3);
    bench->leadshine().inject_fault(0x2211);
    EXPECT_EQ(bench->leadshine().state(), fault);
    EXPECT_EQ(bench->number(0x603F), 0x2211);
    EXPECT_EQ(bench->number(0x1001), 0x02);
    const auto reset = [&] {
      if (by_controlword) {
        bench->control(0x00);
        bench->control(0x80);
      } else {
        ASSERT_EQ(bench->write(0x4000, 0, 1), 0U);
      }
    };
    reset();
    EXPECT_EQ(bench->leadshine().state(), fault);
    bench->leadshine().clear_fault_cause();
    if (by_controlword) {
      bench->control(0x80);
      EXPECT_EQ(bench->leadshine().state(), fault);  // no edge
    }
    reset();
    EXPECT_EQ(bench->leadshine().state(), switch_on_disabled);
    EXPECT_EQ(bench->number(0x603F), 0);
  }
}

TEST_F(Leadshine, AJammedMotorRaisesAnAlarm) {
  start();
  ASSERT_EQ(bench->write(0x2014, 0, 5), 0U);  // half a revolution
  enable_in(3);
  bench->leadshine().jam(true);
  ramps(rpm_1500);
  ASSERT_EQ(bench->write(0x60FF, 0, rpm_1500), 0U);
  EXPECT_TRUE(bench->pass_until([this] { return bench->leadshine().state() == fault; }));
  EXPECT_EQ(bench->number(0x603F), 0x8611);
}

TEST_F(Leadshine, LimitsStopTheMotorAndShowIn60FD) {
  LeadshineOptions options = a_leadshine();
  options.mechanics.negative_limit = -20000;
  options.mechanics.positive_limit = 20000;
  start(options);
  enable_in(3);
  ramps(rpm_1500);
  EXPECT_EQ(bench->number(0x60FD) & 3, 0);
  ASSERT_EQ(bench->write(0x60FF, 0, 50000), 0U);
  bench->pass(std::chrono::seconds(3));
  EXPECT_EQ(bench->number(0x606C), 0);
  EXPECT_EQ(bench->number(0x60FD) & 3, 2);
  EXPECT_NE(bench->status() & 0x0800, 0);
}

}  // namespace
}  // namespace axisgate::simulated
