// SPDX-License-Identifier: Apache-2.0
// Two motors behind one controlword: what one is told, the other is told; bits of one object; faults told by EMCY
// alone.
#include <gmock/gmock.h>

#include "tests/stage_drive/pair_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using testing::IsEmpty;

constexpr double kStanding = 0;

// --- Parts -----------------------------------------------------------------------------------------------------------

TEST(Pair, ReadsTwoStatuswordsOutOfOneObject) {
  PairRig rig;
  EXPECT_EQ(rig.axis(0)[Quantity::statusword].value, 0x40);
  rig.wire->drive.fail(1);
  rig.run(200ms);
  EXPECT_EQ(rig.axis(0)[Quantity::statusword].value, 0x40);
  EXPECT_EQ(rig.axis(1)[Quantity::statusword].value, 0x08);
  EXPECT_TRUE(rig.axis(1).has(AxisInput::fault));
  EXPECT_FALSE(rig.axis(0).has(AxisInput::fault));
}

TEST(Pair, APartIsWrittenWithTheOthersAsTheyAreReadJustBefore) {
  PairRig rig;
  EXPECT_EQ(rig.axis(0)[Quantity::max_torque].value, 1000);
  EXPECT_EQ(rig.axis(1)[Quantity::max_torque].value, 500);
  rig.run(100ms);
  rig.wire->drive.limits = 0x2164;  // somebody else has written the other one
  rig.mark();
  ASSERT_EQ(rig.command(0, Command::none, {{Quantity::max_torque, 200}}), Errc::ok);
  EXPECT_EQ(rig.wire->drive.limits, 0x2114);
  const auto write = std::ranges::find_if(rig.wire->sent, [](const bus::Exchange& each) {
    return each.access == bus::Access::write && each.object.index == 0x2072;
  });
  ASSERT_TRUE(write != rig.wire->sent.end() && write != rig.wire->sent.begin());
  EXPECT_EQ(std::prev(write)->object.index, 0x2072) << "nothing goes between the read and the write";
  EXPECT_EQ(std::prev(write)->access, bus::Access::read);
  rig.run(200ms);
  EXPECT_EQ(rig.axis(0)[Quantity::max_torque].value, 200);
  EXPECT_EQ(rig.axis(1)[Quantity::max_torque].value, 330);
}

TEST(Pair, WhatStandsBesideAPartAndCannotBeReadIsNotWritten) {
  PairRig rig;
  rig.wire->loses = [](const bus::Exchange& each) { return each.object.index == 0x2072; };
  rig.mark();
  EXPECT_NE(rig.command(0, Command::none, {{Quantity::max_torque, 200}}), Errc::ok);
  EXPECT_THAT(rig.written(0x2072), IsEmpty());
  EXPECT_EQ(rig.wire->drive.limits, 0x3264);
}

TEST(Pair, TheMailboxWritesNoWholeOfParts) {
  PairRig rig;
  WriteBatch batch;
  batch.object = ObjectRequest{.write = true, .index = 0x2072, .size = 2, .data = 0};
  EXPECT_EQ(rig.ask(0, batch).outcome.code, Errc::bad_value);
  EXPECT_EQ(rig.wire->drive.limits, 0x3264);
}

// --- Shared ----------------------------------------------------------------------------------------------------------

TEST(Pair, IsEnabledAsOneAndNeitherRuns) {
  PairRig rig;
  rig.motor(1).target = 5000;  // left there by somebody else
  rig.enable();
  rig.run(500ms);
  EXPECT_EQ(rig.motor(0).speed, kStanding);
  EXPECT_EQ(rig.motor(1).speed, kStanding);
  EXPECT_EQ(rig.axis(1).axis_state, AxisState::standstill);
}

TEST(Pair, RunsEachMotorByItself) {
  PairRig rig;
  rig.enable();
  rig.run_at(0, 100);
  rig.run_at(1, -50);
  EXPECT_EQ(rig.motor(0).speed, 1000.0);
  EXPECT_EQ(rig.motor(1).speed, -500.0);
}

TEST(Pair, AStopOfOneStopsAndLatchesBoth) {
  for (const AxisSlot stopped : {AxisSlot{0}, AxisSlot{1}}) {
    PairRig rig;
    rig.enable();
    rig.run_at(0, 100);
    rig.run_at(1, 50);
    EXPECT_EQ(rig.command(stopped, Command::quick_stop), Errc::ok);
    EXPECT_TRUE(rig.latched(0) && rig.latched(1));
    rig.run(1s);
    EXPECT_EQ(rig.motor(0).speed, kStanding);
    EXPECT_EQ(rig.motor(1).speed, kStanding);
    EXPECT_EQ(rig.axis(0).motion_state, MotionState::aborted);
    EXPECT_EQ(rig.axis(1).motion_state, MotionState::aborted);
    EXPECT_EQ(rig.axis(0).axis_state, AxisState::stopping);
    EXPECT_EQ(rig.axis(1).axis_state, AxisState::stopping);
  }
}

TEST(Pair, AnEnableOfOneDoesNotUndoTheStopOfTheOther) {
  PairRig rig;
  rig.enable();
  ASSERT_EQ(rig.command(1, Command::quick_stop), Errc::ok);
  rig.run(500ms);
  rig.mark();
  EXPECT_EQ(rig.command(0, Command::enable), Errc::state_unsuitable);
  EXPECT_THAT(rig.written(0x6040), IsEmpty());
  EXPECT_FALSE(rig.has_torque(0) || rig.has_torque(1));
  EXPECT_TRUE(rig.latched(0) && rig.latched(1));
  EXPECT_EQ(rig.command(1, Command::enable), Errc::ok);
  EXPECT_TRUE(rig.has_torque(0) && rig.has_torque(1));
  EXPECT_FALSE(rig.latched(0) || rig.latched(1));
}

TEST(Pair, EachThatWasStoppedIsEnabledAnew) {
  PairRig rig;
  rig.enable();
  ASSERT_EQ(rig.command(0, Command::quick_stop), Errc::ok);
  ASSERT_EQ(rig.command(1, Command::quick_stop), Errc::ok);
  rig.run(500ms);
  EXPECT_EQ(rig.command(0, Command::enable), Errc::state_unsuitable);
  EXPECT_FALSE(rig.has_torque(0) || rig.has_torque(1));
  EXPECT_EQ(rig.command(1, Command::enable), Errc::ok) << "both were asked for by now";
  EXPECT_TRUE(rig.has_torque(0) && rig.has_torque(1));
}

TEST(Pair, ARawWordOfOneDoesNotUndoTheStopOfTheOtherEither) {
  PairRig rig;
  rig.enable();
  ASSERT_EQ(rig.command(1, Command::quick_stop), Errc::ok);
  rig.run(500ms);
  for (const auto word : {std::uint16_t{0x06}, std::uint16_t{0x07}, std::uint16_t{0x0F}}) {
    WriteBatch batch;
    batch.controlword = word;
    batch.single_controlword = true;
    static_cast<void>(rig.ask(0, batch));
  }
  EXPECT_FALSE(rig.has_torque(0) || rig.has_torque(1));
}

TEST(Pair, AHaltOfOneHaltsBothAndWhatGoesOnAfterItIsWhatWasAskedFor) {
  PairRig rig;
  rig.enable();
  rig.run_at(0, 100);
  rig.run_at(1, 50);
  ASSERT_EQ(rig.command(0, Command::halt), Errc::ok);
  ASSERT_TRUE(rig.run_until([&] { return rig.motor(0).speed == 0 && rig.motor(1).speed == 0; }));
  rig.run(500ms);
  rig.run_at(0, 30);
  rig.run(500ms);
  EXPECT_EQ(rig.motor(0).speed, 300.0);
  EXPECT_EQ(rig.motor(1).speed, kStanding) << "its run was ended by the halt";
}

TEST(Pair, ADisableOfOneTakesTheTorqueOfBothAndTheOtherDoesNotGiveItBack) {
  PairRig rig;
  rig.enable();
  EXPECT_EQ(rig.command(1, Command::disable), Errc::ok);
  rig.run(2s);
  EXPECT_FALSE(rig.has_torque(0) || rig.has_torque(1));
  EXPECT_EQ(rig.motor(0).enables, 1);
  EXPECT_EQ(rig.motor(1).enables, 1);
}

TEST(Pair, WhileOneRunsTheOtherIsNotResetThroughDisable) {
  PairRig rig;
  rig.enable();
  rig.run_at(0, 100);
  rig.wire->drive.fail(1);
  rig.run(700ms);
  rig.mark();
  EXPECT_EQ(rig.command(1, Command::fault_reset), Errc::busy);
  EXPECT_THAT(rig.written(0x6040), IsEmpty());
  EXPECT_EQ(rig.motor(0).speed, 1000.0);
  EXPECT_EQ(rig.command(1, Command::quick_stop), Errc::ok) << "a stop is a stop";
  ASSERT_TRUE(rig.run_until([&] { return rig.motor(0).speed == 0; }));
}

TEST(Pair, IsNotEnabledWhileOneOfThemHasAFault) {
  PairRig rig;
  rig.wire->drive.fail(1);
  rig.run(700ms);
  EXPECT_EQ(rig.command(0, Command::enable), Errc::state_unsuitable);
  EXPECT_EQ(rig.command(1, Command::fault_reset), Errc::ok);
  EXPECT_EQ(rig.command(0, Command::enable), Errc::ok);
}

TEST(Pair, HasOneOwner) {
  PairRig rig({.on = true});
  rig.asker = rig.client(1);
  rig.enable();
  const auto other = rig.client(2);
  rig.asker = other;
  EXPECT_EQ(rig.command(1, Command::run_velocity, {{Quantity::target_velocity, 50'000}}), Errc::not_owner);
  EXPECT_TRUE(rig.axis(1).lease.owned_by(1));
  EXPECT_EQ(rig.command(1, Command::quick_stop), Errc::ok) << "stops are everybody's";
  EXPECT_TRUE(rig.latched(0));
}

TEST(Pair, TheEndOfItsOneLeaseStopsBoth) {
  PairRig rig({.on = true});
  rig.asker = rig.client(1);
  rig.enable();
  rig.run_at(1, 50);
  ASSERT_TRUE(rig.run_until([&] { return rig.latched(0) && rig.latched(1); }, 5s));
  rig.run(1s);
  EXPECT_EQ(rig.motor(1).speed, kStanding);
  EXPECT_FALSE(rig.has_torque(0) || rig.has_torque(1));
}

// --- EMCY ------------------------------------------------------------------------------------------------------------

TEST(Pair, TheNewestEmergencyIsTheErrorCodeUntilTheFaultIsOver) {
  PairRig rig;
  EXPECT_EQ(rig.axis(0)[Quantity::error_code].value, 0);
  EXPECT_TRUE(rig.axis(0)[Quantity::error_code].valid);
  rig.wire->emergency(0x2310);
  rig.wire->drive.fail(0);
  ASSERT_TRUE(rig.run_until([&] { return rig.axis(0).has(AxisInput::fault); }));
  EXPECT_EQ(rig.axis(0)[Quantity::error_code].value, 0x2310);
  EXPECT_EQ(rig.axis(1)[Quantity::error_code].value, 0) << "it has no fault";
  rig.wire->emergency(0x4310);
  rig.run(50ms);
  EXPECT_EQ(rig.axis(0)[Quantity::error_code].value, 0x4310);
  EXPECT_EQ(rig.command(0, Command::fault_reset), Errc::ok);
  EXPECT_EQ(rig.axis(0)[Quantity::error_code].value, 0);
  rig.wire->drive.fail(0);
  rig.run(1s);
  EXPECT_EQ(rig.axis(0)[Quantity::error_code].value, 0x1000) << "of this one nothing was heard";
}

TEST(Pair, AnEmergencyThatIsOverNamesNoFaultThatComesLater) {
  PairRig rig;
  rig.wire->emergency(0x2310);
  rig.run(50ms);
  rig.wire->emergency(0);
  rig.wire->drive.fail(0);
  rig.run(1s);
  EXPECT_EQ(rig.axis(0)[Quantity::error_code].value, 0x1000);
}

TEST(Pair, AFaultOfBeforeHasAnUnknownCauseAfterHalfASecond) {
  PairRig rig({.on = false}, [](simulated::PairDrive& drive) { drive.fail(0); });
  EXPECT_FALSE(rig.axis(0)[Quantity::error_code].valid);
  rig.run(600ms);
  EXPECT_TRUE(rig.axis(0)[Quantity::error_code].valid);
  EXPECT_EQ(rig.axis(0)[Quantity::error_code].value, 0x1000);
}

}  // namespace
}  // namespace axisgate::test
