// SPDX-License-Identifier: Apache-2.0
// The iD286pro behind the shipped core: a drive without CiA 402 that a client cannot tell from a servo, where it can be
// told at all, and that says so where it cannot.
#include <gmock/gmock.h>

#include "gateway/drive/state/fault_watch.hpp"
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

TEST(Stepper, EnableOpensTheGateAndDisableClosesItAndSaysThatTorqueStays) {
  StepperRig rig;
  rig.online();
  rig.enable();
  EXPECT_TRUE(reads(rig.axis(), Quantity::statusword, 0x27));
  EXPECT_EQ(rig.axis().alarms & bit(AxisAlarm::cannot_deenergise), 0U);
  rig.run_at(300'000);
  ASSERT_EQ(rig.code(rig.command(Command::disable)), Errc::ok);
  EXPECT_EQ(rig.axis()[Quantity::statusword].value, 0x23);
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::cannot_deenergise), 0U);
  ASSERT_TRUE(rig.stands());
  EXPECT_EQ(rig.code(rig.move_to(1000)), Errc::state_unsuitable) << "the gate is closed";
  EXPECT_EQ(rig.axis().axis_state, AxisState::disabled);
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

TEST(Stepper, AnUnknownFaultNumberIsAGenericError) {
  StepperRig rig;
  rig.online();
  rig.motor().inject_fault(99);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().has(AxisInput::fault); }, 2s));
  rig.stage.run(drive::kCauseTime);
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
