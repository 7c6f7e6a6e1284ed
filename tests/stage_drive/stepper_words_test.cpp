// SPDX-License-Identifier: Apache-2.0
// The iD286pro: homing, and the raw words of a servo.
#include <gmock/gmock.h>

#include "tests/stage_drive/stepper_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

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
    const BatchResult asked = rig.ask(with_command(Command::home, {{Quantity::homing_method, method}}));
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

// 3.1 homed: "cleared by a drive restart", also one of which only what the drive forgets tells.
TEST(Stepper, AHomingDoesNotOutliveAQuickRestart) {
  constexpr std::int64_t kOwnSpeed = 60'000;
  int homed = 0;
  for (const std::int64_t method : {19, 21}) {
    StepperOptions options = with_origin_switch();
    options.drive.boot_time = 60ms;
    StepperRig rig(options);
    rig.online();
    ASSERT_EQ(rig.code(rig.write(Quantity::profile_velocity, kOwnSpeed)), Errc::ok);
    rig.enable();
    ASSERT_EQ(rig.code(rig.ask(with_command(Command::home, {{Quantity::homing_method, method}}))), Errc::ok);
    rig.stage.run_until([&] { return rig.axis().motion_state != MotionState::active; }, 70s);
    if (rig.axis().motion_state != MotionState::completed) continue;  // the switch lies the other way
    ++homed;
    rig.stage.run(1s);
    EXPECT_TRUE(rig.axis().has(AxisInput::homed));
    auto& link = rig.stage.rtu_link(0);
    link.line().restart(0, link.time_of(rig.stage.runtime().now()));
    rig.stage.run(5s);
    EXPECT_EQ(rig.axis().link_state, LinkState::online);
    EXPECT_FALSE(rig.axis().has(AxisInput::homed));
  }
  EXPECT_EQ(homed, 1);
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
  WriteBatch set = with_command(Command::set_position);
  set.set_position_value = -77'000;
  EXPECT_EQ(rig.code(rig.ask(set)), Errc::busy);
  ASSERT_TRUE(rig.motion_ends());
  rig.stage.run(500ms);
  ASSERT_EQ(rig.code(rig.ask(set)), Errc::ok);
  EXPECT_TRUE(reads(rig.axis(), Quantity::position_actual, -77'000));
}

TEST(Stepper, SetPositionTakesNoValueThatItsRegisterDoesNotHold) {
  constexpr std::int32_t kMost = 2'000'000'000;  // register 321, of 10,000 pulses a turn
  StepperRig rig;
  rig.online();
  rig.enable();
  for (const std::int32_t value : {kMost + 1, -kMost - 1}) {
    WriteBatch alone;
    alone.set_position_value = value;
    EXPECT_EQ(rig.code(rig.ask(alone)), Errc::bad_value) << value;
    WriteBatch both = with_command(Command::set_position);
    both.set_position_value = value;
    EXPECT_EQ(rig.code(rig.ask(both)), Errc::bad_value) << value;
  }
  EXPECT_TRUE(reads(rig.axis(), Quantity::position_actual, 0));
  WriteBatch most = with_command(Command::set_position);
  most.set_position_value = kMost;
  EXPECT_EQ(rig.code(rig.ask(most)), Errc::ok);
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

TEST(Stepper, ARawModeWriteHaltsWhatRunsInTheModeBefore) {
  StepperRig rig;
  rig.online();
  rig.enable();
  rig.run_at(300'000);
  ASSERT_EQ(rig.code(rig.write(Quantity::mode, 1)), Errc::ok);
  EXPECT_TRUE(reads(rig.axis(), Quantity::mode_display, 1));
  EXPECT_TRUE(rig.stands());
}

}  // namespace
}  // namespace axisgate::test
