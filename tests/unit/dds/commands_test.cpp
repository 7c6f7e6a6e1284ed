// SPDX-License-Identifier: Apache-2.0
// The commands of a DDS writer that move a motor, of a servo and of a virtual axis: what they are answered, and what
// the motor does of it. The others are told without a motor (malformed, bounds, trust) and by tests/obey.
#include <gmock/gmock.h>

#include "gateway/upstream/dds/command_batches.hpp"
#include "tests/unit/dds/dds_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

struct OfAxis : testing::TestWithParam<AxisNumber> {
  DdsRig rig;
  AxisNumber axis = GetParam();
  dds::Guid writer = rig.writer(1);
  int ask(std::uint8_t number) { return rig.ask(writer, number, axis).result; }
  std::uint64_t moved = 0;  ///< id of the last move
  int move(std::uint8_t number, double turns) {
    dds::CommandRecord record = move_to(writer, turns, axis);
    record.command = number;
    const dds::ReplyRecord reply = rig.ask(record);
    moved = reply.request_id;
    return reply.result;
  }
  double turns_shown() { return rig.state(axis).position / kTurn; }
  /// A subscriber knows its own motion by the id.
  bool completed() {
    return rig.run_until([&] { return rig.state(axis).motion_id == moved && rig.state(axis).motion_state == 2; });
  }
};

TEST_P(OfAxis, MoveAbsoluteAndRelative) {
  ASSERT_EQ(ask(1), kDone);
  EXPECT_EQ(move(6, 3), kDone);
  ASSERT_TRUE(completed());
  EXPECT_NEAR(turns_shown(), 3, 0.01);
  EXPECT_EQ(move(7, -1), kDone);
  ASSERT_TRUE(completed());
  EXPECT_NEAR(turns_shown(), 2, 0.01);
  EXPECT_EQ(move(6, 30), kDone);
  rig.run(300ms);
  EXPECT_EQ(move(7, 1), kUnsuitable) << "never added while it moves";
}

TEST_P(OfAxis, RunVelocityAndHaltAndQuickStop) {
  ASSERT_EQ(ask(1), kDone);
  EXPECT_EQ(rig.run_at(writer, 5, axis).result, kDone);
  ASSERT_TRUE(rig.run_until([&] { return rig.state(axis).velocity > 4.9 * kTurn; }));
  EXPECT_EQ(ask(4), kDone);
  ASSERT_TRUE(rig.run_until([&] { return !rig.turns(axis); }));
  EXPECT_TRUE(rig.run_until([&] { return rig.state(axis).axis_state == 1; }, 1s)) << "standstill, enabled";
  EXPECT_EQ(rig.run_at(writer, -5, axis).result, kDone);
  ASSERT_TRUE(rig.run_until([&] { return rig.state(axis).velocity < -4.9 * kTurn; }));
  EXPECT_EQ(ask(3), kDone);
  ASSERT_TRUE(rig.run_until([&] { return !rig.turns(axis); }));
  EXPECT_NE(rig.state(axis).alarms & bit(AxisAlarm::stop_latched), 0U);
  EXPECT_EQ(rig.run_at(writer, 5, axis).result, kUnsuitable);
  EXPECT_EQ(ask(1), kDone);
  EXPECT_EQ(rig.run_at(writer, 5, axis).result, kDone);
  EXPECT_TRUE(rig.turns(axis));
}

INSTANTIATE_TEST_SUITE_P(Both, OfAxis, testing::Values(kServo, kStepper),
                         [](const auto& each) { return std::string(each.param == kServo ? "servo" : "virtual"); });

// The gateway stood still. Where clocks differ, max_age_ms does not tell.
TEST(DdsCommands, WhatHasWaitedTooLongForTheGatewayIsNotCarriedOutUnlessItIsAStop) {
  DdsRig rig;
  const auto writer = rig.writer(1);
  ASSERT_EQ(rig.ask(writer, 1).result, kDone);
  const auto before = [&](Duration time) { return (rig.now() - time).time_since_epoch().count(); };
  dds::CommandRecord move = move_to(writer, 100);
  move.received = before(501ms);
  EXPECT_EQ(rig.ask(move).result, 6) << "never started";
  EXPECT_FALSE(rig.turns());
  move.received = before(500ms);
  EXPECT_EQ(rig.ask(move).result, kDone);
  EXPECT_TRUE(rig.turns());
  dds::CommandRecord stop = command(writer, 3, 0);
  stop.received = before(1h);
  EXPECT_EQ(rig.ask(stop).result, kDone);
}

}  // namespace
}  // namespace axisgate::test
