// SPDX-License-Identifier: Apache-2.0
// What a subscriber sees of motors that really move.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/unit/dds/dds_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

TEST(DdsStates, FollowAMoveToItsTargetAndCarryTheCommandsId) {
  DdsRig rig;
  const auto writer = rig.writer(1);
  ASSERT_EQ(rig.ask(writer, 1).result, 2);
  ASSERT_EQ(rig.ask(move_to(writer, 5)).result, 2);
  const std::uint16_t id = rig.axis().motion_id;
  rig.samples.clear();
  ASSERT_TRUE(rig.run_until([&] { return rig.state().motion_state == 2; }));
  EXPECT_NEAR(rig.state().position, 5 * kTurn, 0.01);
  EXPECT_EQ(rig.state().motion_id, id);
  EXPECT_NE(id, 0);
  double last = -1;
  std::uint32_t sequence = 0;
  int seen = 0;
  for (const dds::StateRecord& each : rig.samples) {
    if (each.axis != kServo) continue;
    EXPECT_GE(each.position, last - 0.01);
    EXPECT_GT(each.sequence, sequence);
    last = each.position;
    sequence = each.sequence;
    ++seen;
  }
  EXPECT_GT(seen, 5);
}

TEST(DdsStates, SayAtEachMomentWhatTheRegistersSay) {
  DdsRig rig;
  const auto writer = rig.writer(1);
  ASSERT_EQ(rig.ask(writer, 1).result, 2);
  ASSERT_EQ(rig.run_at(writer, 5).result, 2);
  for (int i = 0; i < 40; ++i) {
    rig.run(25ms);
    ASSERT_TRUE(rig.run_until([&] { return rig.state().sequence == rig.axis().sequence; }, 100ms));
    EXPECT_EQ(rig.state().statusword, rig.axis()[Quantity::statusword].value);
    EXPECT_DOUBLE_EQ(rig.state().velocity,
                     static_cast<double>(rig.axis()[Quantity::velocity_actual].value) * kTurn / 60'000);
    EXPECT_EQ(rig.state().valid, rig.axis().valid_bits());
  }
  EXPECT_NEAR(rig.state().velocity, 5 * kTurn, 0.5);
}

// A reload takes an axis away: its last sample says that nothing is known, and no other follows.
TEST(DdsStates, SayOnceThatAnAxisIsGone) {
  DdsRig rig;
  ASSERT_TRUE(rig.run_until([&] { return rig.axis().reachable(); }));
  rig.take_away(kServo);
  rig.samples.clear();
  rig.run(3s);
  std::erase_if(rig.samples, [](const auto& each) { return each.axis != kServo; });
  ASSERT_EQ(rig.samples.size(), 1U);
  EXPECT_EQ(rig.samples.front().link_state, 0);
  EXPECT_EQ(rig.samples.front().valid, 0U);
}

TEST(DdsStates, ComeAtMostEachShortestAndAtLeastEachLongestPeriod) {
  DdsRigOptions options;
  options.settings.min_period = 30ms;
  options.settings.max_period = 400ms;
  DdsRig rig(options);
  const auto writer = rig.writer(1);
  ASSERT_EQ(rig.ask(writer, 1).result, 2);
  ASSERT_EQ(rig.run_at(writer, 5).result, 2);
  rig.samples.clear();
  rig.run(3s);
  const auto of = [&](AxisNumber axis) { return std::ranges::count(rig.samples, axis, &dds::StateRecord::axis); };
  EXPECT_LE(of(kServo), 101);
  EXPECT_GE(of(kServo), 30) << "it turns, and is polled each 50 ms";
  EXPECT_GE(of(kStepper), 7) << "it stands";
  EXPECT_LE(of(kStepper), 100);
}

TEST(DdsStates, OfADriveThatIsGoneSaySoAndThatItIsBack) {
  DdsRig rig;
  rig.stage.link(0).unplug();
  ASSERT_TRUE(rig.run_until([&] { return rig.state().link_state == 5; }));
  EXPECT_EQ(rig.state().statusword, 0);
  EXPECT_EQ(rig.state().error_code, 0x8130);
  EXPECT_EQ(rig.state().valid, 0U);
  constexpr int kUnknown = 7;  // not "disabled"
  EXPECT_EQ(rig.state().axis_state, kUnknown);
  rig.stage.link(0).plug();
  EXPECT_TRUE(rig.run_until([&] { return rig.state().link_state == 2 && rig.state().valid != 0; }));
  EXPECT_EQ(rig.state().axis_state, 0);
}

TEST(DdsStates, OfTheGatewayComeOnceASecondWithItsBuses) {
  DdsRig rig;
  rig.gateway.clear();
  rig.run(5s);
  EXPECT_EQ(rig.gateway.size(), 5U);
  EXPECT_EQ(rig.gateway.back().axes_online, 2);
  ASSERT_EQ(rig.gateway.back().buses.size(), 2U);
  EXPECT_GT(rig.gateway.back().buses[0].counters[0], rig.gateway.front().buses[0].counters[0]) << "requests";
}

// A fault, its code and the drive's own word are one sample: nobody has to guess which of the next ones belongs to it.
TEST(DdsStates, ShowAFaultWithItsCauseInOneSample) {
  constexpr std::uint16_t kFault = 1U << 3, kSupplyTooHigh = 0x0020, kFollowingError = 0x0200;
  DdsRig rig;
  const auto writer = rig.writer(1);
  for (const std::uint16_t cause : {kSupplyTooHigh, kFollowingError, kSupplyTooHigh}) {
    rig.samples.clear();
    rig.stage.drive(0).inject_fault(1, cause);
    rig.stage.drive(0).clear_fault_cause(1, cause);
    ASSERT_TRUE(rig.run_until([&] { return (rig.state().statusword & kFault) != 0; }));
    EXPECT_EQ(rig.state().error_code, cause == kSupplyTooHigh ? 0x3210 : 0x8611);
    EXPECT_EQ(rig.state().vendor_error, cause);
    ASSERT_EQ(rig.ask(writer, 5).result, kDone);
    ASSERT_TRUE(rig.run_until([&] { return rig.state().vendor_error == 0; }));
    bool faulted = false;
    for (const dds::StateRecord& sample : rig.samples) {
      if (sample.axis != kServo || (sample.statusword & kFault) == 0) continue;
      faulted = true;
      EXPECT_EQ(sample.error_code, cause == kSupplyTooHigh ? 0x3210 : 0x8611);
      EXPECT_EQ(sample.vendor_error, cause);
    }
    EXPECT_TRUE(faulted);
  }
}

}  // namespace
}  // namespace axisgate::test
