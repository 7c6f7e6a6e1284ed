// SPDX-License-Identifier: Apache-2.0
// The iD286pro behind the shipped core: a drive without CiA 402 that a client cannot tell from a servo, where it can be
// told at all, and that says so where it cannot.
#include <gmock/gmock.h>

#include "tests/stage_drive/stepper_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

TEST(Stepper, ComesOnlineWithTheQuantitiesOfItsManualAndACiA402State) {
  StepperRig rig;
  rig.online();
  const AxisImage& axis = rig.axis();
  for (const Quantity q :
       {Quantity::statusword, Quantity::mode_display, Quantity::position_actual, Quantity::velocity_actual,
        Quantity::vendor_error, Quantity::error_code, Quantity::dc_voltage, Quantity::controlword, Quantity::mode,
        Quantity::target_position, Quantity::profile_velocity, Quantity::profile_acceleration,
        Quantity::profile_deceleration}) {
    EXPECT_TRUE(axis[q].valid) << row(q).name;
  }
  for (const Quantity q : {Quantity::torque_actual, Quantity::following_error, Quantity::drive_temperature,
                           Quantity::target_torque, Quantity::digital_inputs})
    EXPECT_EQ(axis.supported & bit(q), 0U) << row(q).name << ": the drive does not tell it";
  EXPECT_TRUE(reads(axis, Quantity::statusword, 0x40));
  EXPECT_TRUE(reads(axis, Quantity::dc_voltage, 480));
  EXPECT_TRUE(reads(axis, Quantity::profile_velocity, 600'000)) << "10.00 rev/s";
  EXPECT_TRUE(reads(axis, Quantity::profile_acceleration, 300'000)) << "500 rev/s2";
  EXPECT_NE(axis.alarms & bit(AxisAlarm::no_comm_watchdog), 0U);
  EXPECT_NE(axis.alarms & bit(AxisAlarm::cannot_deenergise), 0U) << "disabled, but it holds torque";
  EXPECT_TRUE(rig.has_command(Command::home));
  EXPECT_FALSE(rig.has_command(Command::run_torque));
  EXPECT_FALSE(rig.has_command(Command::save_parameters));
}

TEST(Stepper, PositionsAreScaledByTheMicrostepsThatTheDriveIsSetTo) {
  StepperRig rig({.drive = {.stored = {{242, 51200}}}});
  rig.online();
  rig.enable();
  EXPECT_EQ(rig.code(rig.move_to(25'000)), Errc::ok);
  ASSERT_TRUE(rig.motion_ends());
  EXPECT_EQ(rig.motor().position(), 2 * 51200 + 25600) << "2.5 turns";
  EXPECT_TRUE(reads(rig.axis(), Quantity::position_actual, 25'000));
}

TEST(Stepper, EnableOpensTheGateAndNothingMoves) {
  StepperRig rig;
  rig.online();
  ASSERT_EQ(rig.code(rig.write(Quantity::target_velocity, 300'000)), Errc::ok);
  ASSERT_EQ(rig.code(rig.command(Command::enable)), Errc::ok);
  EXPECT_TRUE(reads(rig.axis(), Quantity::statusword, 0x27));
  EXPECT_TRUE(rig.axis().has(AxisInput::enabled));
  EXPECT_EQ(rig.axis().alarms & bit(AxisAlarm::cannot_deenergise), 0U);
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().starts().size(), 0U);
  EXPECT_EQ(rig.motor().peek(kSpeedRegister), 0) << "a speed set-point from before starts nothing later";
}

TEST(Stepper, DisableStopsClosesTheGateAndSaysThatTorqueStays) {
  StepperRig rig;
  rig.online();
  rig.enable();
  rig.run_at(300'000);
  ASSERT_EQ(rig.code(rig.command(Command::disable)), Errc::ok);
  EXPECT_EQ(rig.axis()[Quantity::statusword].value, 0x23);
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::cannot_deenergise), 0U);
  ASSERT_TRUE(rig.stands());
  EXPECT_EQ(rig.code(rig.move_to(1000)), Errc::state_unsuitable) << "the gate is closed";
  EXPECT_EQ(rig.axis().axis_state, AxisState::disabled);
}

TEST(Stepper, NothingMovesBeforeAnEnable) {
  StepperRig rig;
  rig.online();
  for (const Command command : {Command::move_absolute, Command::run_velocity, Command::home, Command::set_position})
    EXPECT_EQ(rig.code(rig.command(command)), Errc::state_unsuitable) << text(command);
  EXPECT_EQ(rig.code(rig.mailbox_write(kControlRegister, 2, 1)), Errc::state_unsuitable) << "nor by the back door";
  rig.stage.run(500ms);
  EXPECT_TRUE(rig.motor().starts().empty());
}

TEST(Stepper, AMoveRunsToItsTargetAndIsReportedCompletedThereAndNotBefore) {
  StepperRig rig;
  rig.online();
  rig.enable();
  WriteBatch batch = with_command(Command::move_absolute, {{Quantity::target_position, 100'000}});
  batch.command_id = 7;
  ASSERT_EQ(rig.code(rig.ask(batch)), Errc::ok);
  EXPECT_FALSE(rig.axis().has(AxisInput::target_reached));
  EXPECT_EQ(rig.axis().motion_state, MotionState::active);
  EXPECT_EQ(rig.axis().axis_state, AxisState::discrete_motion);
  ASSERT_TRUE(rig.stage.run_until([&] {
    const bool there = rig.motor().position() == 100'000;
    EXPECT_TRUE(there || !rig.axis().has(AxisInput::target_reached)) << rig.motor().position();
    return rig.axis().motion_state == MotionState::completed;
  }));
  EXPECT_EQ(rig.axis().motion_id, 7);
  EXPECT_TRUE(reads(rig.axis(), Quantity::position_actual, 100'000));
  EXPECT_TRUE(rig.axis().has(AxisInput::target_reached));
  EXPECT_EQ(rig.axis().axis_state, AxisState::standstill);
}

TEST(Stepper, AMoveToWhereItStandsIsCompleted) {
  StepperRig rig;
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.move_to(0)), Errc::ok);
  EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }, 2s));
}

TEST(Stepper, AMoveUnderWayIsReplacedAtOnce) {
  StepperRig rig;
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.move_to(1'000'000)), Errc::ok);
  rig.stage.run(300ms);
  ASSERT_EQ(rig.code(rig.move_to(-20'000)), Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }, 30s));
  EXPECT_EQ(rig.motor().position(), -20'000);
}

TEST(Stepper, ATargetWrittenDuringAMoveWaitsForItsStart) {
  StepperRig rig;
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.move_to(200'000)), Errc::ok);
  rig.stage.run(200ms);
  ASSERT_EQ(rig.code(rig.write(Quantity::target_position, 5)), Errc::ok);
  ASSERT_TRUE(rig.motion_ends());
  EXPECT_EQ(rig.motor().position(), 200'000) << "in the drive, the write itself would have changed the move";
}

TEST(Stepper, ARelativeMoveNeedsStandstillAndEndsWhereItShould) {
  StepperRig rig;
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.move_to(30'000)), Errc::ok);
  EXPECT_EQ(rig.code(rig.move_by(1000)), Errc::busy);
  ASSERT_TRUE(rig.motion_ends());
  rig.stage.run(500ms);
  ASSERT_EQ(rig.code(rig.move_by(-5'000)), Errc::ok);
  ASSERT_TRUE(rig.motion_ends());
  EXPECT_EQ(rig.motor().position(), 25'000);
  EXPECT_EQ(rig.axis().motion_state, MotionState::completed);
}

TEST(Stepper, ASwitchThatEndsAMoveMakesItFailedNotReached) {
  StepperRig rig({.drive = {.stored = {{400, 6}}}});  // IN1 = decelerated stop
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.move_to(1'000'000)), Errc::ok);
  rig.stage.run(500ms);
  rig.motor().set_input(1, true);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::failed; }, 5s));
  EXPECT_FALSE(rig.axis().has(AxisInput::target_reached));
}

TEST(Stepper, RunsAtAVelocityAndFollowsANewOneAtOnce) {
  for (const bool follows : {false, true}) {
    StepperRig rig({.drive = {.speed_follows_register = follows}});
    rig.online();
    rig.enable();
    rig.run_at(300'000);
    EXPECT_EQ(rig.axis().axis_state, AxisState::continuous_motion);
    EXPECT_NEAR(static_cast<double>(rig.axis()[Quantity::velocity_actual].value), 300'000, 3'000);
    ASSERT_EQ(rig.code(rig.write(Quantity::target_velocity, -60'000)), Errc::ok);
    rig.stage.run(1s);
    EXPECT_NEAR(static_cast<double>(rig.axis()[Quantity::velocity_actual].value), -60'000, 1'000);
    ASSERT_EQ(rig.code(rig.write(Quantity::target_velocity, 0)), Errc::ok);
    rig.stage.run(1s);
    EXPECT_EQ(rig.axis()[Quantity::velocity_actual].value, 0);
  }
}

TEST(Stepper, QuickStopLatchesAndOnlyAnEnableEndsIt) {
  StepperRig rig;
  rig.online();
  rig.enable();
  rig.run_at(600'000);
  ASSERT_EQ(rig.code(rig.command(Command::quick_stop)), Errc::ok);
  EXPECT_EQ(rig.motor().peek(kControlRegister), 7) << "the emergency stop, not the slow one";
  EXPECT_TRUE(rig.axis().has(AxisInput::stop_latched));
  EXPECT_EQ(rig.axis()[Quantity::statusword].value & 0x6F, 0x07) << "it stands, energised";
  ASSERT_TRUE(rig.stands());
  EXPECT_EQ(rig.code(rig.move_to(5)), Errc::state_unsuitable);
  ASSERT_EQ(rig.code(rig.command(Command::enable)), Errc::ok);
  EXPECT_FALSE(rig.axis().has(AxisInput::stop_latched));
  EXPECT_EQ(rig.code(rig.move_to(5)), Errc::ok);
}

TEST(Stepper, HaltStopsStaysEnabledAndNothingResumes) {
  StepperRig rig;
  rig.online();
  rig.enable();
  rig.run_at(600'000);
  ASSERT_EQ(rig.code(rig.command(Command::halt)), Errc::ok);
  ASSERT_TRUE(rig.stands());
  EXPECT_TRUE(rig.axis().has(AxisInput::enabled));
  const auto starts = rig.motor().starts().size();
  ASSERT_EQ(rig.code(rig.command(Command::end_halt)), Errc::ok);
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().starts().size(), starts);
  EXPECT_EQ(rig.code(rig.move_to(0)), Errc::ok);
  EXPECT_TRUE(rig.motion_ends());
}

TEST(Stepper, ALongRampIsNoReasonToKeepTheClientWaiting) {
  StepperRig rig;
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.write(Quantity::profile_deceleration, 6'000)), Errc::ok) << "10 rev/s2";
  rig.run_at(3'000'000);
  ASSERT_EQ(rig.code(rig.command(Command::halt)), Errc::ok);
  EXPECT_TRUE(rig.axis().has(AxisInput::moving));
  EXPECT_EQ(rig.axis().axis_state, AxisState::stopping);
  EXPECT_EQ(rig.axis().motion_state, MotionState::aborted);
  EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis().axis_state == AxisState::standstill; }, 10s));
}

TEST(Stepper, AFaultIsShownWithItsCodeAndResetLeavesTheAxisDisabled) {
  StepperRig rig;
  rig.online();
  rig.enable();
  rig.run_at(300'000);
  rig.motor().inject_fault(14);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().has(AxisInput::fault); }, 2s));
  EXPECT_TRUE(reads(rig.axis(), Quantity::error_code, 0x3210));
  EXPECT_TRUE(reads(rig.axis(), Quantity::vendor_error, 14));
  EXPECT_EQ(rig.axis()[Quantity::statusword].value & 0x4F, 0x08);
  EXPECT_EQ(rig.axis().motion_state, MotionState::failed);
  EXPECT_EQ(rig.code(rig.command(Command::enable)), Errc::state_unsuitable);
  rig.motor().clear_fault_cause();
  ASSERT_EQ(rig.code(rig.command(Command::fault_reset)), Errc::ok);
  EXPECT_EQ(rig.axis()[Quantity::statusword].value, 0x40);
  EXPECT_TRUE(reads(rig.axis(), Quantity::error_code, 0));
}

TEST(Stepper, AnUnknownFaultNumberIsAGenericError) {
  StepperRig rig;
  rig.online();
  rig.motor().inject_fault(99);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().has(AxisInput::fault); }, 2s));
  EXPECT_TRUE(reads(rig.axis(), Quantity::error_code, 0x1000));
  EXPECT_TRUE(reads(rig.axis(), Quantity::vendor_error, 99));
}

TEST(Stepper, TheEnableSwitchAtTheDriveIsALossOfEnableThatItsReturnDoesNotUndo) {
  StepperRig rig;
  rig.online();
  rig.enable();
  rig.motor().set_enable_switch(false);
  ASSERT_TRUE(rig.stage.run_until([&] { return !rig.axis().has(AxisInput::enabled); }, 2s));
  EXPECT_EQ(rig.axis()[Quantity::statusword].value, 0x40);
  EXPECT_EQ(rig.axis().alarms & bit(AxisAlarm::cannot_deenergise), 0U) << "now it holds no torque";
  EXPECT_EQ(rig.code(rig.command(Command::enable)), Errc::not_reached);
  rig.motor().set_enable_switch(true);
  rig.stage.run(1s);
  EXPECT_FALSE(rig.axis().has(AxisInput::enabled));
}

// A button that is answered as done and moves nothing would be a lie: the drive counts in whole turns a minute.
TEST(StepperJog, TakesNoSpeedThatTheDriveWouldHoldAsZero) {
  StepperRig rig;
  rig.online();
  rig.enable();
  WriteBatch batch;
  for (const auto& [speed, code] : {std::pair{100U, Errc::bad_value}, {0U, Errc::ok}, {1'000U, Errc::ok}}) {
    batch.jog_velocity = speed;
    EXPECT_EQ(rig.code(rig.ask(batch)), code) << speed;
  }
}

// 3.1: "on Modbus RTU the register and sub 0". The wire has no sub-index: another one would be the same register, by a
// name that no limit and no gate knows.
TEST(StepperObjects, HaveNoSubindex) {
  constexpr std::uint16_t kSpeed = 307, kTrigger = 323, kRun = 3;
  StepperRig rig;
  rig.online();
  const std::size_t starts = rig.motor().starts().size();
  for (const auto& [index, value] : {std::pair{kSpeed, std::uint16_t{3000}}, {kTrigger, kRun}}) {
    for (const bool write : {false, true}) {
      WriteBatch batch;
      batch.role = Role::engineer;
      batch.object = ObjectRequest{.write = write, .index = index, .subindex = 1, .size = 2, .data = value};
      EXPECT_EQ(rig.code(rig.ask(batch)), Errc::bad_value) << index << write;
    }
  }
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().starts().size(), starts);
  EXPECT_EQ(rig.motor().run_state(), simulated::Id286pro::RunState::stopped);
}

// There is no register after the last one.
TEST(StepperObjects, TheLastRegisterIsOneRegister) {
  StepperRig rig;
  rig.online();
  for (const bool write : {false, true}) {
    WriteBatch batch;
    batch.role = Role::engineer;
    batch.object = ObjectRequest{.write = write, .index = 0xFFFF, .size = 4};
    EXPECT_EQ(rig.code(rig.ask(batch)), Errc::bad_value) << write;
    batch.object->size = 2;
    EXPECT_EQ(rig.code(rig.ask(batch)), Errc::refused_by_drive) << write;
    batch.object->index = 0xFFFE;
    batch.object->size = 4;
    EXPECT_EQ(rig.code(rig.ask(batch)), Errc::refused_by_drive) << write;
  }
  WriteBatch batch;
  batch.object = ObjectRequest{.index = 0xFFFF, .count = 4};
  EXPECT_EQ(rig.code(rig.ask(batch)), Errc::bad_value);
}

}  // namespace
}  // namespace axisgate::test
