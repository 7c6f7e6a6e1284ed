// SPDX-License-Identifier: Apache-2.0
// The iD286pro: what only this drive needs. Its gate, its memory, its runs of registers, and a client that goes away.
#include <gmock/gmock.h>

#include "tests/stage_drive/stepper_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kAcceleration = 303, kPositioningSpeed = 306, kTarget = 313;

// What only this drive needs -----------------------------------------------------------------------------------------

TEST(Stepper, FollowingExternalPulsesItRefusesToBeEnabledAndSaysWhy) {
  StepperRig rig({.drive = {.internal_pulses = false}});
  rig.online();
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::local_control), 0U);
  EXPECT_FALSE(rig.axis().has(AxisInput::ready));
  EXPECT_EQ(rig.code(rig.command(Command::enable)), Errc::state_unsuitable);
  ASSERT_EQ(rig.code(rig.write(Quantity::controlword, 0x06)), Errc::ok);
  EXPECT_EQ(rig.code(rig.write(Quantity::controlword, 0x0F)), Errc::state_unsuitable) << "nor by the raw words";
  EXPECT_FALSE(rig.axis().has(AxisInput::enabled));
}

TEST(Stepper, StopsWhenTheClientThatCommandedItsMotionIsGone) {
  StepperRig rig;
  rig.online();
  rig.enable();
  WriteBatch run = with_command(Command::run_velocity, {{Quantity::target_velocity, 300'000}});
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
  WriteBatch run = with_command(Command::run_velocity, {{Quantity::target_velocity, 300'000}});
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
  WriteBatch move = with_command(Command::move_absolute, {{Quantity::target_position, 10'000}});
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
  EXPECT_EQ(rig.mailbox_read(kControlRegister, 2).outcome.code, Errc::ok);
}

TEST(Stepper, TheDrivesOwnCommandsByTheMailboxKnowTheGateAndTheLatch) {
  StepperRig rig;
  rig.online();
  EXPECT_EQ(rig.code(rig.mailbox_write(kControlRegister, 2, 1)), Errc::state_unsuitable);
  EXPECT_TRUE(rig.motor().starts().empty());
  rig.enable();
  ASSERT_EQ(rig.code(rig.write(Quantity::target_position, 20'000)), Errc::ok);
  ASSERT_EQ(rig.code(rig.mailbox_write(kControlRegister, 2, 1)), Errc::ok);
  EXPECT_EQ(rig.axis().motion_state, MotionState::active) << "it is the same command";
  ASSERT_EQ(rig.code(rig.mailbox_write(kControlRegister, 2, 7)), Errc::ok);
  EXPECT_TRUE(rig.axis().has(AxisInput::stop_latched));
  EXPECT_EQ(rig.code(rig.mailbox_write(kControlRegister, 2, 1)), Errc::state_unsuitable);
}

TEST(Stepper, TheMailboxStartsNothingThatNoRegisterStarts) {
  constexpr std::uint16_t kJogSpeed = 308, kSimulatedInput = 410;
  constexpr std::array kOwnMotions{4U, 5U, 16U};  // jog to and fro, a stored program
  StepperRig rig;
  rig.online();
  rig.enable();
  for (const std::uint32_t number : kOwnMotions)
    EXPECT_EQ(rig.code(rig.mailbox_write(kControlRegister, 2, number)), Errc::bad_value) << number;
  EXPECT_EQ(rig.code(rig.mailbox_write(kJogSpeed, 2, 5'000)), Errc::bad_value);
  EXPECT_EQ(rig.code(rig.mailbox_write(kJogSpeed, 4, 5'000)), Errc::bad_value) << "and its neighbour";
  EXPECT_EQ(rig.code(rig.mailbox_write(kSimulatedInput, 2, 1)), Errc::bad_value);
  EXPECT_EQ(rig.motor().peek(kJogSpeed), 1'000);
  EXPECT_EQ(rig.mailbox_read(kJogSpeed, 2).outcome.code, Errc::ok);
}

TEST(Stepper, TheMailboxCannotWriteHalfATargetBehindTheLimits) {
  StepperOptions options;
  options.axis.limits.position = Range{-50'000, 50'000};
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

WriteBatch block(std::int64_t method) {
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
    rig.unplug();
    rig.stage.run(2s);
    rig.mend();
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
    const BatchResult result = rig.write(Quantity::homing_method, i % 2 == 0 ? 19 : 21);
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
  rig.unplug();
  rig.stage.run(1s);
  rig.mend();
  rig.mark();
  rig.online();
  EXPECT_EQ(rig.reads_of(117, 3), 0U) << "nor after the line's return";
}

}  // namespace
}  // namespace axisgate::test
