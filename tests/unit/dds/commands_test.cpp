// SPDX-License-Identifier: Apache-2.0
// Every command of design 3.4, asked by a DDS writer of a servo and of a virtual axis: one reply each, and what the
// motor does of it.
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
  bool servo() const { return axis == kServo; }
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

TEST_P(OfAxis, EnableAndDisable) {
  EXPECT_EQ(rig.state(axis).statusword & 0x6F, 0x40) << "switch on disabled";
  EXPECT_EQ(ask(1), kDone);
  ASSERT_TRUE(rig.run_until([&] { return (rig.state(axis).statusword & 0x6F) == 0x27; }, 1s));
  EXPECT_FALSE(rig.turns(axis)) << "an enable never moves the axis";
  EXPECT_EQ(ask(1), kDone) << "already";
  EXPECT_EQ(ask(2), kDone);
  EXPECT_TRUE(rig.run_until([&] { return (rig.state(axis).statusword & 0x6F) != 0x27; }, 1s));
}

TEST_P(OfAxis, NothingMovesBeforeAnEnable) {
  for (const std::uint8_t number : std::initializer_list<std::uint8_t>{6, 7, 8, 10, 11})
    EXPECT_EQ(ask(number), kUnsuitable) << int{number};
  EXPECT_FALSE(rig.turns(axis));
}

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

TEST_P(OfAxis, FaultResetHomeSetPositionAndSave) {
  EXPECT_EQ(ask(5), kDone) << "not faulted: nothing to do";
  EXPECT_EQ(ask(12), servo() ? kDone : kNotSupported) << "an iD286pro has no such thing";
  ASSERT_EQ(ask(1), kDone);
  dds::CommandRecord home = command(writer, 10, 0, axis);
  home.mask = dds::kHasHomingMethod;
  home.homing_method = 35;
  if (servo()) {
    EXPECT_EQ(rig.ask(home).result, kDone);
    ASSERT_TRUE(rig.run_until([&] { return rig.axis(axis).has(AxisInput::homed); }));
  }
  home.homing_method = 99;
  EXPECT_EQ(rig.ask(home).result, kBadValue);
  EXPECT_EQ(move(6, 2), kDone);
  ASSERT_TRUE(completed());
  dds::CommandRecord here = command(writer, 11, 0, axis);
  here.mask = dds::kHasSetPositionValue;
  here.set_position_value = 0;
  EXPECT_EQ(rig.ask(here).result, kDone);
  ASSERT_TRUE(rig.run_until([&] { return std::abs(turns_shown()) < 0.01; }, 2s));
}

TEST_P(OfAxis, RunTorqueWhereTheDriveHasIt) {
  ASSERT_EQ(ask(1), kDone);
  dds::CommandRecord torque = command(writer, 9, 0, axis);
  if (!servo()) {
    EXPECT_EQ(rig.ask(torque).result, kNotSupported);
    torque.command = 0;
    torque.mask = dds::kHasTargetTorque;
    EXPECT_EQ(rig.ask(torque).result, kNotSupported);
    return;
  }
  torque.mask = dds::kHasTargetTorque;
  torque.target_torque = 200;
  WriteBatch speed;
  speed.setpoints.push_back({Quantity::max_velocity, 1'000'000});
  ASSERT_EQ(rig.stage.ask(axis, speed).outcome.code, Errc::ok);
  EXPECT_EQ(rig.ask(torque).result, kDone);
  EXPECT_TRUE(rig.run_until([&] { return rig.state(axis).mode == 4 && rig.state(axis).axis_state == 3; }, 2s));
}

TEST_P(OfAxis, ReleaseAndTakeOver) {
  ASSERT_EQ(ask(1), kDone);
  EXPECT_TRUE(rig.axis(axis).lease.owner);
  EXPECT_EQ(ask(13), kDone);
  EXPECT_FALSE(rig.axis(axis).lease.owner);
  EXPECT_EQ(ask(14), kDone);
  ASSERT_TRUE(rig.axis(axis).lease.owner);
  EXPECT_EQ(rig.axis(axis).lease.owner->origin[2], 1);
  const auto other = rig.writer(2);
  EXPECT_EQ(rig.ask(other, 14, axis).result, 7) << "no rank above it";
  EXPECT_EQ(rig.ask(other, 13, axis).result, 7);
}

TEST_P(OfAxis, TargetsAloneMoveNothing) {
  ASSERT_EQ(ask(1), kDone);
  dds::CommandRecord target = move_to(writer, 4, axis);
  target.command = 0;
  EXPECT_EQ(rig.ask(target).result, kDone);
  EXPECT_FALSE(rig.turns(axis));
  moved = rig.ask(writer, 6, axis).request_id;
  ASSERT_TRUE(completed());
  EXPECT_NEAR(turns_shown(), 4, 0.01);
}

TEST_P(OfAxis, LimitsHoldForDdsAsForModbus) {
  if (!servo()) return;
  DdsRigOptions options;
  options.position_limits = Range{-20'000, 20'000};
  DdsRig limited(options);
  const auto by = limited.writer(1);
  ASSERT_EQ(limited.ask(by, 1).result, kDone);
  EXPECT_EQ(limited.ask(move_to(by, 2.1)).result, kBadValue);
  EXPECT_FALSE(limited.turns());
  EXPECT_EQ(limited.ask(move_to(by, 2)).result, kDone);
}

TEST_P(OfAxis, ADriveThatCannotBeReachedIsToldSo) {
  if (servo()) rig.stage.link(0).unplug();
  if (!servo()) rig.stage.rtu_link(1).unplug();
  ASSERT_TRUE(rig.run_until([&] { return rig.state(axis).link_state == 5; }));
  EXPECT_EQ(ask(1), 6);
  EXPECT_EQ(ask(2), 6);
}

INSTANTIATE_TEST_SUITE_P(Both, OfAxis, testing::Values(kServo, kStepper),
                         [](const auto& each) { return std::string(each.param == kServo ? "servo" : "virtual"); });

TEST(DdsCommands, ARepeatedRelativeMoveMovesOnce) {
  DdsRig rig;
  const auto writer = rig.writer(1);
  ASSERT_EQ(rig.ask(writer, 1).result, kDone);
  dds::CommandRecord move = move_to(writer, 1);
  move.command = 7;
  ASSERT_EQ(rig.ask(move).result, kDone);
  const std::uint64_t id = 2;  // of the move: ids count from 1
  ASSERT_EQ(rig.replies(id), 1U);
  ASSERT_TRUE(rig.run_until([&] { return rig.state().motion_state == 2; }));
  rig.send_again(move, id);
  EXPECT_EQ(rig.replies(id), 2U) << "answered, as already seen";
  rig.run(2s);
  EXPECT_NEAR(rig.state().position / kTurn, 1, 0.01);
}

TEST(DdsCommands, AStopGoesFirstWhateverWaits) {
  DdsRig rig;
  const auto writer = rig.writer(1);
  ASSERT_EQ(rig.ask(writer, 1).result, kDone);
  const std::uint64_t move = rig.send(move_to(writer, 100));
  const std::uint64_t stop = rig.send(command(writer, 3, 0));
  ASSERT_TRUE(rig.run_until([&] { return rig.replies(move) == 1 && rig.replies(stop) == 1; }, 5s));
  rig.run(1s);
  EXPECT_FALSE(rig.turns());
  EXPECT_NE(rig.state().alarms & bit(AxisAlarm::stop_latched), 0U);
}

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
