// The iD286pro behind the shipped core: a drive without CiA 402 that a client cannot tell from a servo, where it can be
// told at all, and that says so where it cannot.
#include <gmock/gmock.h>

#include "tests/unit/drive/stepper_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kAcceleration = 303, kPositioningSpeed = 306, kSpeed = 307, kTarget = 313, kControl = 323;

bool reads(const AxisImage& axis, Quantity quantity, std::int64_t value) {
  return axis[quantity].valid && axis[quantity].value == value;
}

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
  EXPECT_EQ(rig.motor().peek(kSpeed), 0) << "a speed set-point from before starts nothing later";
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
  EXPECT_EQ(rig.code(rig.mailbox_write(kControl, 2, 1)), Errc::state_unsuitable) << "nor by the back door";
  EXPECT_EQ(rig.code(rig.mailbox_write(kControl, 2, 16)), Errc::state_unsuitable) << "a stored program";
  EXPECT_EQ(rig.code(rig.mailbox_write(kControl, 2, 4)), Errc::state_unsuitable) << "jog";
  rig.stage.run(500ms);
  EXPECT_TRUE(rig.motor().starts().empty());
}

TEST(Stepper, AMoveRunsToItsTargetAndIsReportedCompletedThereAndNotBefore) {
  StepperRig rig;
  rig.online();
  rig.enable();
  Group group = with_command(Command::move_absolute, {{Quantity::target_position, 100'000}});
  group.command_id = 7;
  ASSERT_EQ(rig.code(rig.ask(group)), Errc::ok);
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
  EXPECT_EQ(rig.motor().peek(kControl), 7) << "the emergency stop, not the slow one";
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
  EXPECT_EQ(rig.code(rig.command(Command::enable)), Errc::state_unsuitable);
  rig.motor().set_enable_switch(true);
  rig.stage.run(1s);
  EXPECT_FALSE(rig.axis().has(AxisInput::enabled));
}

// Homing -------------------------------------------------------------------------------------------------------------

StepperOptions with_origin_switch() {
  StepperOptions options;
  options.drive.stored = {{400, 11}};
  options.drive.mechanics.home_from = -60'000;
  options.drive.mechanics.home_to = -40'000;
  return options;
}

TEST(Stepper, HomingNeedsAnInputThatListensForItsSwitch) {
  StepperRig rig;
  rig.online();
  rig.enable();
  EXPECT_EQ(rig.code(rig.command(Command::home)), Errc::bad_value) << "no method was written";
  const std::size_t starts = rig.motor().starts().size();
  EXPECT_EQ(rig.code(rig.ask(with_command(Command::home, {{Quantity::homing_method, 21}}))), Errc::state_unsuitable)
      << "it would run on for ever";
  EXPECT_EQ(rig.code(rig.write(Quantity::homing_method, 35)), Errc::bad_value);
  EXPECT_EQ(rig.motor().starts().size(), starts);
}

TEST(Stepper, HomingIsAttainedWhereItsPositionSaysSo) {
  for (const std::int64_t method : {19, 21}) {
    StepperRig rig(with_origin_switch());
    rig.online();
    EXPECT_FALSE(rig.axis().has(AxisInput::homed));
    rig.enable();
    const GroupResult asked = rig.ask(with_command(Command::home, {{Quantity::homing_method, method}}));
    ASSERT_EQ(rig.code(asked), Errc::ok) << method;
    EXPECT_EQ(rig.axis().axis_state, AxisState::homing);
    rig.stage.run_until([&] { return rig.axis().motion_state != MotionState::active; }, 70s);
    if (rig.axis().motion_state != MotionState::completed) continue;  // the switch lies the other way
    EXPECT_TRUE(rig.axis().has(AxisInput::homed));
    EXPECT_EQ(rig.axis()[Quantity::position_actual].value, 0);
    return;
  }
  FAIL() << "neither direction found the switch";
}

TEST(Stepper, AHomingThatIsStoppedIsNotAttained) {
  StepperOptions options = with_origin_switch();
  options.drive.stored[401] = 6;  // IN2 = decelerated stop
  StepperRig rig(options);
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.ask(with_command(Command::home, {{Quantity::homing_method, 19}}))), Errc::ok);
  rig.stage.run(300ms);
  rig.motor().set_input(2, true);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::failed; }, 10s));
  EXPECT_FALSE(rig.axis().has(AxisInput::homed));
}

TEST(Stepper, SetPositionTakesAnyValueAtStandstill) {
  StepperRig rig;
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.move_to(10'000)), Errc::ok);
  Group set = with_command(Command::set_position);
  set.set_position_value = -77'000;
  EXPECT_EQ(rig.code(rig.ask(set)), Errc::busy);
  ASSERT_TRUE(rig.motion_ends());
  rig.stage.run(500ms);
  ASSERT_EQ(rig.code(rig.ask(set)), Errc::ok);
  EXPECT_TRUE(reads(rig.axis(), Quantity::position_actual, -77'000));
}

// Raw words ----------------------------------------------------------------------------------------------------------

TEST(Stepper, TakesTheControlwordsOfAServo) {
  StepperRig rig;
  rig.online();
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x06)), Errc::ok);
  EXPECT_TRUE(reads(rig.axis(), Quantity::statusword, 0x21));
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x07)), Errc::ok);
  EXPECT_TRUE(reads(rig.axis(), Quantity::statusword, 0x23));
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x0F)), Errc::ok);
  EXPECT_TRUE(reads(rig.axis(), Quantity::statusword, 0x27));
  ASSERT_EQ(rig.code(rig.write(Quantity::target_position, 40'000)), Errc::ok);
  rig.stage.run(300ms);
  EXPECT_TRUE(rig.motor().starts().empty()) << "a target is no start";
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x1F)), Errc::ok);
  EXPECT_NE(rig.axis()[Quantity::statusword].value & 0x1000, 0) << "set-point acknowledged";
  ASSERT_TRUE(rig.motion_ends());
  EXPECT_EQ(rig.motor().position(), 40'000);
  EXPECT_NE(rig.axis()[Quantity::statusword].value & 0x0400, 0) << "target reached";
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x0F)), Errc::ok);
  EXPECT_EQ(rig.axis()[Quantity::statusword].value & 0x1000, 0);
  ASSERT_EQ(rig.code(rig.write(Quantity::target_position, -1'000)), Errc::ok);
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x5F)), Errc::ok) << "bit 6: relative";
  ASSERT_TRUE(rig.motion_ends());
  EXPECT_EQ(rig.motor().position(), 39'000);
}

TEST(Stepper, Bit8HaltsAndItsFallStartsNothing) {
  StepperRig rig;
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.move_to(1'000'000)), Errc::ok);
  rig.stage.run(300ms);
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x010F)), Errc::ok);
  ASSERT_TRUE(rig.stands());
  const std::int32_t place = rig.motor().position();
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x000F)), Errc::ok);
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().position(), place);
}

TEST(Stepper, AControlwordThatStopsStopsTheMotor) {
  for (const std::int64_t word : {0x00, 0x02, 0x06, 0x07}) {
    StepperRig rig;
    rig.online();
    rig.enable();
    rig.run_at(300'000);
    ASSERT_EQ(rig.code(rig.write(Quantity::controlword, word)), Errc::ok) << word;
    EXPECT_TRUE(rig.stands()) << word;
    EXPECT_FALSE(rig.axis().has(AxisInput::enabled));
    EXPECT_EQ(rig.axis().has(AxisInput::stop_latched), word == 0x02);
  }
}

TEST(Stepper, ARawModeWriteHaltsWhatRunsInTheModeBefore) {
  StepperRig rig;
  rig.online();
  rig.enable();
  rig.run_at(300'000);
  ASSERT_EQ(rig.code(rig.write(Quantity::mode, 1)), Errc::ok);
  EXPECT_TRUE(reads(rig.axis(), Quantity::mode_display, 1));
  EXPECT_TRUE(rig.stands());
}

TEST(Stepper, RawVelocityModeFollowsItsTargetOnceEnabled) {
  StepperRig rig;
  rig.online();
  ASSERT_EQ(rig.code(rig.write(Quantity::mode, 3)), Errc::ok);
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x06)), Errc::ok);
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x0F)), Errc::ok);
  rig.stage.run(500ms);
  EXPECT_TRUE(rig.motor().starts().empty());
  ASSERT_EQ(rig.code(rig.write(Quantity::target_velocity, 120'000)), Errc::ok);
  rig.stage.run(1s);
  EXPECT_NEAR(static_cast<double>(rig.axis()[Quantity::velocity_actual].value), 120'000, 2'000);
  EXPECT_EQ(rig.code(rig.write(Quantity::mode, 4)), Errc::bad_value) << "it has no torque mode";
}

// What only this drive needs -----------------------------------------------------------------------------------------

TEST(Stepper, FollowingExternalPulsesItRefusesToBeEnabledAndSaysWhy) {
  StepperRig rig({.drive = {.internal_pulses = false}});
  rig.online();
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::local_control), 0U);
  EXPECT_FALSE(rig.axis().has(AxisInput::ready));
  EXPECT_EQ(rig.code(rig.command(Command::enable)), Errc::state_unsuitable);
}

TEST(Stepper, FoundRunningItIsAdoptedAndNothingIsWrittenToIt) {
  StepperRig rig;
  ASSERT_EQ(rig.motor().poke(kSpeed, 200), simulated::RtuException::none);
  ASSERT_EQ(rig.motor().poke(kControl, 3), simulated::RtuException::none);
  rig.online();
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::adopted_running), 0U);
  EXPECT_TRUE(rig.axis().has(AxisInput::enabled));
  EXPECT_EQ(rig.axis().axis_state, AxisState::discrete_motion);
  EXPECT_EQ(rig.writes(), 0U);
  ASSERT_EQ(rig.code(rig.command(Command::quick_stop)), Errc::ok);
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.axis().alarms & bit(AxisAlarm::adopted_running), 0U);
}

TEST(Stepper, StopsWhenTheClientThatCommandedItsMotionIsGone) {
  StepperRig rig;
  rig.online();
  rig.enable();
  Group run = with_command(Command::run_velocity, {{Quantity::target_velocity, 300'000}});
  run.client = 5;
  ASSERT_EQ(rig.code(rig.ask(run)), Errc::ok);
  rig.stage.run(500ms);
  rig.stage.gateway().client_gone(6);
  rig.stage.run(500ms);
  EXPECT_TRUE(rig.axis().has(AxisInput::moving)) << "somebody else has gone";
  rig.stage.gateway().client_gone(5);
  EXPECT_TRUE(rig.stands());
  EXPECT_TRUE(rig.axis().has(AxisInput::stop_latched));
  EXPECT_TRUE(rig.has_event(EventKind::command, "is gone"));
}

TEST(Stepper, AClientThatGoesBeforeItsCommandWasSentLeavesNothingRunning) {
  StepperRig rig;
  rig.online();
  rig.enable();
  Group run = with_command(Command::run_velocity, {{Quantity::target_velocity, 300'000}});
  run.client = 5;
  const auto place = rig.stage.begin(1, run);
  rig.stage.gateway().client_gone(5);
  rig.stage.run(1s);
  EXPECT_TRUE(place->has_value());
  EXPECT_TRUE(rig.stands());
}

TEST(Stepper, AClientWhoseMotionIsOverMayGo) {
  StepperRig rig;
  rig.online();
  rig.enable();
  Group move = with_command(Command::move_absolute, {{Quantity::target_position, 10'000}});
  move.client = 5;
  ASSERT_EQ(rig.code(rig.ask(move)), Errc::ok);
  ASSERT_TRUE(rig.motion_ends());
  rig.stage.run(500ms);
  rig.stage.gateway().client_gone(5);
  rig.stage.run(500ms);
  EXPECT_FALSE(rig.axis().has(AxisInput::stop_latched));
}

// The object mailbox -------------------------------------------------------------------------------------------------

TEST(Stepper, TheMailboxReachesAnyRegister) {
  StepperRig rig;
  rig.online();
  EXPECT_EQ(rig.mailbox_read(299, 4).object_data, 19200U) << "32 bits, low word first";
  EXPECT_EQ(rig.mailbox_read(213, 2).outcome.code, Errc::ok);
  EXPECT_EQ(rig.mailbox_read(999, 2).outcome.code, Errc::refused_by_drive) << "a hole";
  EXPECT_EQ(rig.mailbox_read(999, 2).outcome.detail, 2U) << "the drive's own exception";
  for (std::uint16_t i = 0; i < 8; ++i)
    ASSERT_EQ(rig.code(rig.mailbox_write(static_cast<std::uint16_t>(1024 + i), 2, 100U + i)), Errc::ok) << i;
  EXPECT_EQ(rig.mailbox_read(1030, 2).object_data, 106U);
  EXPECT_EQ(rig.mailbox_read(kControl, 2).outcome.code, Errc::ok);
}

TEST(Stepper, TheDrivesOwnCommandsByTheMailboxKnowTheGateAndTheLatch) {
  StepperRig rig;
  rig.online();
  rig.enable();
  ASSERT_EQ(rig.code(rig.write(Quantity::target_position, 20'000)), Errc::ok);
  ASSERT_EQ(rig.code(rig.mailbox_write(kControl, 2, 1)), Errc::ok);
  EXPECT_EQ(rig.axis().motion_state, MotionState::active) << "it is the same command";
  ASSERT_EQ(rig.code(rig.mailbox_write(kControl, 2, 7)), Errc::ok);
  EXPECT_TRUE(rig.axis().has(AxisInput::stop_latched));
  EXPECT_EQ(rig.code(rig.mailbox_write(kControl, 2, 1)), Errc::state_unsuitable);
}

TEST(Stepper, TheMailboxCannotWriteHalfATargetBehindTheLimits) {
  StepperOptions options;
  options.axis.position_limits = Range{-50'000, 50'000};
  StepperRig rig(options);
  rig.online();
  rig.enable();
  EXPECT_EQ(rig.code(rig.mailbox_write(kTarget, 4, 60'000)), Errc::bad_value);
  EXPECT_EQ(rig.code(rig.mailbox_write(kTarget + 1, 2, 1)), Errc::bad_value) << "the high word alone";
  EXPECT_EQ(rig.code(rig.mailbox_write(kTarget - 1, 4, 1)), Errc::bad_value) << "its neighbour and the low word";
  EXPECT_EQ(rig.code(rig.mailbox_write(kPositioningSpeed, 4, 1)), Errc::bad_value) << "two speeds at once";
  EXPECT_EQ(rig.code(rig.mailbox_write(kTarget, 4, 40'000)), Errc::ok);
  EXPECT_EQ(rig.motor().peek(kTarget), 40'000);
}

// EEPROM -------------------------------------------------------------------------------------------------------------

Group block(std::int64_t method) {
  return setpoints({{Quantity::target_position, 5'000},
                    {Quantity::profile_velocity, 300'000},
                    {Quantity::profile_acceleration, 60'000},
                    {Quantity::homing_method, method},
                    {Quantity::position_limit_min, -1'000'000},
                    {Quantity::position_limit_max, 1'000'000}});
}

TEST(Eeprom, AnHourOfAPlcWritingTheSameBlockWritesEachRegisterOnce) {
  StepperRig rig;
  rig.online();
  for (int i = 0; i < 36'000; ++i) {  // ten times a second
    static_cast<void>(rig.stage.begin(1, block(19)));
    rig.stage.run(100ms);
  }
  for (const auto& [number, count] : rig.motor().registers().stored_writes()) EXPECT_LE(count, 1U) << number;
  for (const auto& [number, count] : rig.motor().registers().unknown_writes()) EXPECT_LE(count, 1U) << number;
  EXPECT_EQ(rig.motor().peek(kTarget), 5'000);
}

TEST(Eeprom, AnHourWithACableThatFailsEachMinuteStillWritesNothingAnew) {
  StepperRig rig;
  rig.online();
  static_cast<void>(rig.ask(block(19)));
  for (int minute = 0; minute < 60; ++minute) {
    rig.cut();
    rig.stage.run(2s);
    rig.plug();
    rig.online();
    for (int i = 0; i < 20; ++i) {
      static_cast<void>(rig.stage.begin(1, block(19)));
      rig.stage.run(200ms);
    }
  }
  for (const auto& [number, count] : rig.motor().registers().stored_writes()) EXPECT_LE(count, 1U) << number;
}

TEST(Eeprom, AValueThatChangesWithEachWriteIsHeldBackWithAnAlarmAndStopsAreNot) {
  StepperRig rig;
  rig.online();
  rig.enable();
  int busy = 0;
  for (int i = 0; i < 600; ++i) {
    const GroupResult result = rig.write(Quantity::homing_method, i % 2 == 0 ? 19 : 21);
    if (result.outcome.code == Errc::busy) ++busy;
    rig.stage.run(100ms);
  }
  EXPECT_GT(busy, 250) << "the other half asks for what the drive holds";
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::nvm_budget), 0U);
  EXPECT_TRUE(rig.has_event(EventKind::warning, "nvm_budget"));
  EXPECT_LE(rig.motor().registers().stored_writes().at(305), 13U);
  EXPECT_EQ(rig.code(rig.command(Command::quick_stop)), Errc::ok);
  EXPECT_EQ(rig.code(rig.write(Quantity::profile_acceleration, 120'000)), Errc::ok) << "kept in RAM: free";
  EXPECT_EQ(rig.motor().peek(kAcceleration), 200);
}

// Runs of registers --------------------------------------------------------------------------------------------------

TEST(Runs, NeighboursAreReadInOneRequest) {
  StepperRig rig;
  rig.online();
  rig.mark();
  rig.stage.run(1s);
  EXPECT_GT(rig.reads_of(108, 2), 3U) << "fault and run state";
  EXPECT_GT(rig.reads_of(117, 3), 3U) << "position and speed";
  EXPECT_EQ(rig.reads_of(108, 1) + rig.reads_of(109, 1) + rig.reads_of(117, 2) + rig.reads_of(119, 1), 0U);
}

TEST(Runs, ADriveThatRefusesThemIsReadInSmallerPartsForGood) {
  StepperRig rig({.drive = {.most_registers = 2}});
  rig.online();
  EXPECT_TRUE(rig.axis()[Quantity::position_actual].valid);
  EXPECT_TRUE(rig.axis()[Quantity::velocity_actual].valid);
  EXPECT_TRUE(rig.axis()[Quantity::profile_velocity].valid);
  EXPECT_TRUE(rig.axis()[Quantity::position_limit_max].valid);
  rig.mark();
  rig.stage.run(2s);
  EXPECT_EQ(rig.reads_of(117, 3), 0U) << "not tried again";
  EXPECT_GT(rig.reads_of(117, 2), 3U);
  rig.cut();
  rig.stage.run(1s);
  rig.plug();
  rig.mark();
  rig.online();
  EXPECT_EQ(rig.reads_of(117, 3), 0U) << "nor after the line's return";
}

}  // namespace
}  // namespace axisgate::test
