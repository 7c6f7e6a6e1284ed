// SPDX-License-Identifier: Apache-2.0
// A drive of two motors without CiA 402, whose set-points move by being written: a client cannot tell its axes from
// servos, and no write moves or enables what was not asked for.
#include <gmock/gmock.h>

#include "tests/stage_drive/keya_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using testing::Each;
using testing::IsEmpty;

constexpr std::int64_t kRpm = 1'000;  // register units

class KeyaCommands : public testing::TestWithParam<Speech> {
 protected:
  [[nodiscard]] KeyaOptions in_mode(std::int16_t mode) const { return {.speech = GetParam(), .modes = {mode}}; }
  [[nodiscard]] static bool value_goes_before_torque(const KeyaRig& rig, std::int64_t value, std::uint16_t index);
};
INSTANTIATE_TEST_SUITE_P(Speeches, KeyaCommands, testing::Values(Speech::single, Speech::composed),
                         [](const auto& p) { return p.param == Speech::single ? "single" : "composed"; });

/// The set-point was sent with this number before anything turned motor A on.
bool KeyaCommands::value_goes_before_torque(const KeyaRig& rig, std::int64_t value, std::uint16_t index) {
  bool seen = false;
  for (const Sent& s : rig.writes()) {
    const bool turns_on = KeyaRig::field(s.exchange, kEnable, 1) == (GetParam() == Speech::single ? 0 : 1);
    if (turns_on && KeyaRig::field(s.exchange, kEnable, 1)) return seen;
    seen = seen || KeyaRig::field(s.exchange, index, 1) == value;
  }
  return false;
}

TEST_P(KeyaCommands, BeforeTorqueTheSpeedIsZeroWhateverWasLeftInTheDrive) {
  KeyaRig rig(in_mode(3));
  rig.online();
  rig.motor(0).value = 7'000;
  rig.mark();
  rig.enable(0);
  EXPECT_TRUE(value_goes_before_torque(rig, 0, kValue));
  EXPECT_THAT(rig.motor(0).moves, Each(0)) << "an enable never moves";
}

TEST_P(KeyaCommands, BeforeTorqueThePositionIsWhereTheMotorStands) {
  KeyaRig rig(in_mode(1));
  rig.online();
  rig.motor(0).position = 123'456;
  rig.mark();
  rig.enable(0);
  EXPECT_TRUE(value_goes_before_torque(rig, 123'456, GetParam() == Speech::single ? kPositionValue : kValue));
  rig.run(100ms);
  EXPECT_EQ(rig.motor(0).position, 123'456);
}

TEST_P(KeyaCommands, InTorqueModeARawEnableGivesTheTorqueThatWasAskedFor) {
  KeyaRig rig(in_mode(4));
  rig.online();
  rig.word(0, 6);
  ASSERT_EQ(KeyaRig::code(rig.write(0, Quantity::target_torque, 200)), Errc::ok);
  EXPECT_EQ(rig.motor(0).value, 0);
  ASSERT_EQ(KeyaRig::code(rig.word(0, 15)), Errc::ok);
  EXPECT_EQ(rig.motor(0).value, 2'000);
  ASSERT_EQ(KeyaRig::code(rig.write(0, Quantity::target_torque, -100)), Errc::ok);
  EXPECT_EQ(rig.motor(0).value, -1'000);
  ASSERT_EQ(KeyaRig::code(rig.command(0, Command::halt)), Errc::ok);
  EXPECT_EQ(rig.motor(0).value, 0);
}

TEST_P(KeyaCommands, AModeNeedsADisabledAxisAndTheEnableIsThatOfTheMode) {
  KeyaRig rig({.speech = GetParam(), .modes = {3, 1}});
  rig.online();
  rig.enable(0);
  WriteBatch mode = KeyaRig::batch_of(Command::none);
  mode.mode = 1;
  EXPECT_EQ(KeyaRig::code(rig.ask(0, mode)), Errc::state_unsuitable);
  EXPECT_EQ(KeyaRig::code(rig.ask(0, KeyaRig::batch_of(Command::move_absolute, {{Quantity::target_position, 5}}))),
            Errc::state_unsuitable);
  EXPECT_EQ(rig.axis(0)[Quantity::mode].value, 3);
  ASSERT_EQ(KeyaRig::code(rig.command(0, Command::disable)), Errc::ok);
  EXPECT_EQ(KeyaRig::code(rig.ask(0, mode)), Errc::ok);
  rig.motor(0).mode = 1;
  rig.motor(0).position = 4'000;
  rig.mark();
  rig.enable(0);
  EXPECT_TRUE(value_goes_before_torque(rig, 4'000, GetParam() == Speech::single ? kPositionValue : kValue));
  EXPECT_EQ(rig.motor(0).position, 4'000);
}

TEST_P(KeyaCommands, TheOnlyModeMayBeWrittenAndNoOther) {
  KeyaRig rig(in_mode(3));
  rig.online();
  rig.enable(0);
  WriteBatch mode = KeyaRig::batch_of(Command::none);
  mode.mode = 3;
  EXPECT_EQ(KeyaRig::code(rig.ask(0, mode)), Errc::ok);
  mode.mode = 1;
  EXPECT_EQ(KeyaRig::code(rig.ask(0, mode)), Errc::bad_value);
  EXPECT_TRUE(rig.motor(0).enabled);
}

TEST_P(KeyaCommands, ASetPointForAMotorThatHasJustTrippedIsNotCalledDone) {
  KeyaRig rig(in_mode(3));
  rig.online();
  rig.enable(0);
  rig.run_at(0, kRpm150);
  rig.wire->acted = [&](const bus::Exchange& e) {
    if (e.access != bus::Access::write) return;
    rig.motor(0).enabled = false;
    rig.motor(0).faults = 0x0040;
  };
  rig.mark();
  const BatchResult result = rig.write(0, Quantity::target_velocity, 2 * kRpm150);
  EXPECT_EQ(KeyaRig::code(result), Errc::state_unsuitable);
  EXPECT_EQ(result.outcome.detail, kDetailDeviceState);
  EXPECT_GE(rig.reads_of(kFaultQuery), 1U) << "the state decides";
  EXPECT_TRUE(rig.axis(0).has(AxisInput::fault));
}

TEST_P(KeyaCommands, TwoClientsMoveBothMotorsAtOnceAndNeitherDisturbsTheOther) {
  KeyaRig rig(in_mode(3));
  rig.online();
  const auto one = rig.begin(0, KeyaRig::batch_of(Command::enable));
  const auto two = rig.begin(1, KeyaRig::batch_of(Command::enable));
  ASSERT_TRUE(rig.run_until([&] { return one->has_value() && two->has_value(); }));
  EXPECT_TRUE(rig.motor(0).enabled && rig.motor(1).enabled);
  const auto run = [](std::int64_t velocity) {
    return KeyaRig::batch_of(Command::run_velocity, {{Quantity::target_velocity, velocity}});
  };
  for (int i = 1; i <= 20; ++i) {
    const auto a = rig.begin(0, run(i * 15 * kRpm));
    const auto b = rig.begin(1, run(-i * 30 * kRpm));
    ASSERT_TRUE(rig.run_until([&] { return a->has_value() && b->has_value(); }));
    EXPECT_EQ(KeyaRig::code(**a), Errc::ok);
    EXPECT_EQ(KeyaRig::code(**b), Errc::ok);
    EXPECT_EQ(rig.motor(0).value, i * 100);
    EXPECT_EQ(rig.motor(1).value, -i * 200);
  }
  ASSERT_EQ(KeyaRig::code(rig.command(0, Command::quick_stop)), Errc::ok);
  EXPECT_FALSE(rig.motor(0).enabled);
  EXPECT_TRUE(rig.motor(1).enabled);
  EXPECT_EQ(rig.motor(1).value, -4'000);
  EXPECT_EQ(rig.motor(1).enables, 1);
}

TEST_P(KeyaCommands, FoundEnabledItIsShownSoAndIsCommandedAfterAnEnableThatSendsNothing) {
  KeyaRig rig(in_mode(3));
  rig.motor(0).enabled = true;
  rig.motor(0).commanded = rig.runtime.now();
  rig.online();
  EXPECT_EQ(rig.axis(0)[Quantity::statusword].value & 0x6F, 0x27);
  EXPECT_NE(rig.axis(0).alarms & bit(AxisAlarm::adopted_running), 0U);
  rig.mark();
  ASSERT_EQ(KeyaRig::code(rig.command(0, Command::enable)), Errc::ok);
  EXPECT_THAT(rig.writes(), IsEmpty());
  rig.run_at(0, kRpm150);
  EXPECT_EQ(rig.motor(0).value, kRaw150);
  EXPECT_EQ(rig.motor(0).enables, 0);
}

TEST_P(KeyaCommands, EnabledByAnotherMasterItNeedsAnEnableBeforeAStartAndAHaltIsNone) {
  KeyaRig rig(in_mode(3));
  rig.online();
  rig.motor(0).enabled = true;
  rig.motor(0).commanded = rig.runtime.now();
  rig.run(100ms);
  ASSERT_EQ(rig.axis(0)[Quantity::statusword].value & 0x6F, 0x27);
  const auto start = [&] {
    return KeyaRig::code(rig.ask(0, KeyaRig::batch_of(Command::run_velocity, {{Quantity::target_velocity, kRpm150}})));
  };
  EXPECT_EQ(start(), Errc::state_unsuitable);
  EXPECT_EQ(KeyaRig::code(rig.command(0, Command::halt)), Errc::ok);
  EXPECT_EQ(start(), Errc::state_unsuitable);
  ASSERT_EQ(KeyaRig::code(rig.command(0, Command::enable)), Errc::ok);
  EXPECT_EQ(start(), Errc::ok);
}

// --- The back door -----------------------------------------------------------------------------------------------

TEST_P(KeyaCommands, AnObjectOfTheOtherMotorCannotBeWrittenThroughThisAxis) {
  KeyaRig rig(in_mode(3));
  rig.online();
  rig.enable(0);
  rig.enable(1);
  rig.run_at(1, kRpm150);
  rig.mark();
  EXPECT_EQ(KeyaRig::code(rig.mailbox(0, true, kValue, 2, 4, 9)), Errc::bad_value);
  EXPECT_EQ(KeyaRig::code(rig.mailbox(0, true, kEnable, 2, 4, 0)), Errc::bad_value);
  EXPECT_THAT(rig.writes(), IsEmpty());
  EXPECT_EQ(KeyaRig::code(rig.mailbox(0, false, kFaultQuery, 1, 2)), Errc::ok) << "reads are free";
}

TEST_P(KeyaCommands, WhatEnablesOrMovesWithoutAQuantityCannotBeWritten) {
  KeyaRig rig(in_mode(3));
  rig.online();
  rig.mark();
  EXPECT_EQ(KeyaRig::code(rig.mailbox(0, true, kEnable, 1, 4, 1)), Errc::bad_value);
  EXPECT_EQ(KeyaRig::code(rig.mailbox(0, true, kEnable, 1, 4, 0)), Errc::bad_value);
  if (GetParam() == Speech::single) {
    EXPECT_EQ(KeyaRig::code(rig.mailbox(0, true, kTorqueValue, 1, 4, 10)), Errc::bad_value);
  } else {
    EXPECT_EQ(KeyaRig::code(rig.mailbox(0, true, 0x4711, 0, 4, 10)), Errc::bad_value) << "no field of the frame";
  }
  rig.run(100ms);
  EXPECT_THAT(rig.writes(), IsEmpty());
  EXPECT_EQ(rig.motor(0).enables, 0);
}

TEST_P(KeyaCommands, AMailboxWriteOfASetPointIsAWriteOfTheQuantityOfTheModeInForce) {
  KeyaRig rig({.speech = GetParam(), .modes = {3, 1}});
  rig.online();
  rig.enable(0);
  rig.mark();
  EXPECT_EQ(KeyaRig::code(rig.mailbox(0, true, kValue, 1, 4, 700)), Errc::ok);
  EXPECT_THAT(rig.writes(), IsEmpty()) << "kept: nothing runs";
  ASSERT_EQ(KeyaRig::code(rig.command(0, Command::run_velocity)), Errc::ok);
  EXPECT_EQ(rig.motor(0).value, 700);
}

}  // namespace
}  // namespace axisgate::test
