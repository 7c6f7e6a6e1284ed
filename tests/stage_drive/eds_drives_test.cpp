// SPDX-License-Identifier: Apache-2.0
// Drives that are shipped by their EDS, each with a simulated one of its type: what a client does in its first quarter
// of an hour, seen by the motor. What is right of every drive, the tables over all subjects tell.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/simulated/eds_drive.hpp"
#include "tests/stage/gateway_stage.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::Cia402State;
using simulated::EdsDriveType;

constexpr std::int64_t kTurn = 10'000, kRpm = 1000, kRpmPerS = 10;

class EdsDrives : public testing::TestWithParam<const EdsDriveType*> {
 protected:
  EdsDrives() : stage({can_line_of({simulated::EdsDriveOptions{GetParam()}}, 1)}) {}
  void SetUp() override {
    ASSERT_TRUE(stage.come_online());
    carry_out(Command::enable);
    ASSERT_EQ(drive().state(), Cia402State::operation_enabled);
    fast();
  }

  const AxisImage& axis() { return stage.axis(1); }
  std::int64_t shown(Quantity quantity) { return axis()[quantity].value; }
  simulated::EdsDrive& drive() { return stage.eds_drive(0); }
  /// 1/10000 turn of the motor, and 0.001 rpm.
  std::int64_t turned() {
    return drive().axis().actual() * kTurn / (drive().encoder_counts() * simulated::fine_per_count);
  }
  std::int64_t speed() { return simulated::rpm_of(drive().axis().actual_speed(), drive().encoder_counts(), kRpm); }

  void write(Quantity quantity, std::int64_t value) {
    ASSERT_EQ(stage.write(1, quantity, value).outcome.code, Errc::ok) << static_cast<int>(quantity);
  }
  void carry_out(Command command) { ASSERT_EQ(stage.command(1, command).outcome.code, Errc::ok); }
  void fast() {
    write(Quantity::profile_velocity, 600 * kRpm);
    write(Quantity::profile_acceleration, 6000 * kRpmPerS);
    if (axis().supports(Quantity::profile_deceleration)) write(Quantity::profile_deceleration, 6000 * kRpmPerS);
    if (axis().supports(Quantity::quick_stop_deceleration)) write(Quantity::quick_stop_deceleration, 6000 * kRpmPerS);
  }
  bool completes() {
    return stage.run_until([this] { return axis().motion_state != MotionState::active; }) &&
           axis().motion_state == MotionState::completed;
  }
  bool stands() {
    return stage.run_until([this] { return speed() == 0; });
  }

  void run_at(std::int64_t rpm) {
    write(Quantity::target_velocity, rpm * kRpm);
    carry_out(Command::run_velocity);
  }

  GatewayStage stage;
};
INSTANTIATE_TEST_SUITE_P(Types, EdsDrives,
                         testing::ValuesIn(simulated::eds_drive_types().begin(), simulated::eds_drive_types().end()),
                         [](const auto& tested) {
                           std::string name(tested.param->name);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(EdsDrives, MovesAsFarAsItWasAsked) {
  write(Quantity::target_position, 25'000);
  carry_out(Command::move_absolute);
  ASSERT_TRUE(completes());
  EXPECT_NEAR(static_cast<double>(turned()), 25'000, 20);
  EXPECT_NEAR(static_cast<double>(shown(Quantity::position_actual)), 25'000, 20);
  write(Quantity::target_position, -40'000);
  carry_out(Command::move_relative);
  ASSERT_TRUE(completes());
  EXPECT_NEAR(static_cast<double>(turned()), -15'000, 40);
}

TEST_P(EdsDrives, TurnsAsFastAsItWasAsked) {
  for (const std::int64_t rpm : {300, -120}) {
    run_at(rpm);
    stage.run(500ms);
    const std::int64_t before = turned();
    stage.run(1s);
    EXPECT_NEAR(static_cast<double>(speed()), static_cast<double>(rpm * kRpm), 1000);
    EXPECT_NEAR(static_cast<double>(turned() - before), static_cast<double>(rpm * kTurn) / 60, 500);
    EXPECT_NEAR(static_cast<double>(shown(Quantity::velocity_actual)), static_cast<double>(rpm * kRpm), 2000);
  }
  write(Quantity::target_velocity, 60 * kRpm);  // while it runs
  stage.run(1s);
  EXPECT_NEAR(static_cast<double>(speed()), 60.0 * kRpm, 1000);
  carry_out(Command::halt);
  ASSERT_TRUE(stands());
  EXPECT_EQ(drive().state(), Cia402State::operation_enabled);
}

// 600 rpm and a ramp of 6000 rpm/s: half a turn each.
TEST_P(EdsDrives, RampsAsItWasAsked) {
  run_at(600);
  ASSERT_TRUE(stage.run_until([this] { return speed() > 595 * kRpm; }));
  EXPECT_NEAR(static_cast<double>(turned()), 5'000, 1500) << "it goes on while it is looked at";
  const std::int64_t before = turned();
  carry_out(Command::quick_stop);
  ASSERT_TRUE(stands());
  EXPECT_NEAR(static_cast<double>(turned() - before), 5'000, 1500) << "the request takes its time too";
}

TEST_P(EdsDrives, IsEnabledAgainAfterAQuickStopAndAfterADisable) {
  for (const Command stop : {Command::quick_stop, Command::disable, Command::quick_stop}) {
    run_at(120);
    stage.run(300ms);
    carry_out(stop);
    ASSERT_TRUE(stands());
    stage.run(500ms);
    EXPECT_NE(drive().state(), Cia402State::operation_enabled);
    EXPECT_FALSE(axis().has(AxisInput::enabled));
    const std::int64_t before = turned();
    carry_out(Command::enable);
    EXPECT_EQ(drive().state(), Cia402State::operation_enabled);
    stage.run(1s);
    EXPECT_LE(std::abs(turned() - before), 20) << "an enable moves nothing";
  }
}

TEST_P(EdsDrives, CallsThePresentPositionZero) {
  write(Quantity::target_position, 12'345);
  carry_out(Command::move_absolute);
  ASSERT_TRUE(completes());
  write(Quantity::homing_method, 35);
  carry_out(Command::home);
  ASSERT_TRUE(completes());
  EXPECT_TRUE(axis().has(AxisInput::homed));
  EXPECT_EQ(drive().position(), 0);
  EXPECT_TRUE(stage.run_until([this] { return std::abs(shown(Quantity::position_actual)) < 20; }));
  EXPECT_EQ(speed(), 0);
}

TEST_P(EdsDrives, TellsItsFaultAndComesBackByAReset) {
  constexpr std::uint16_t kTooHighVoltage = 0x3210;
  run_at(120);
  stage.run(300ms);
  drive().inject_fault(kTooHighVoltage);
  ASSERT_TRUE(stage.run_until([this] { return axis().has(AxisInput::fault); }));
  ASSERT_TRUE(stands());
  stage.run(1s);
  EXPECT_EQ(shown(Quantity::error_code), kTooHighVoltage) << "by 603Fh or by its EMCY";
  drive().clear_fault_cause();
  carry_out(Command::fault_reset);
  EXPECT_EQ(drive().state(), Cia402State::switch_on_disabled);
  ASSERT_TRUE(stage.run_until([this] { return !axis().has(AxisInput::fault); }));
  carry_out(Command::enable);
  EXPECT_EQ(drive().state(), Cia402State::operation_enabled);
  stage.run(1s);
  EXPECT_EQ(speed(), 0);
}

// What no file says is not promised (register 98). With 6007h it does what CiA 402 has for it.
TEST_P(EdsDrives, StopsByItselfWhenTheGatewayDiesWhereAnObjectSaysSo) {
  constexpr simulated::ObjectKey kAbortConnectionOption{0x6007, 0};
  constexpr std::int64_t kFault = 1;
  EXPECT_EQ(axis().loss_stop_ms, kLossNotKnown);
  const auto option = drive().peek(kAbortConnectionOption);
  if (!option) return;
  if (*option == 0) static_cast<void>(drive().Cia402Drive::poke(kAbortConnectionOption, kFault));  // its check's remedy
  run_at(120);
  stage.run(1s);
  stage.crash();
  stage.run(4s);
  EXPECT_EQ(speed(), 0);
}

TEST_P(EdsDrives, SavesOnceWhenAskedTo) {
  const std::uint64_t before = drive().stores();
  carry_out(Command::disable);
  carry_out(Command::save_parameters);
  stage.run(1s);
  EXPECT_EQ(drive().stores(), before + 1);
}

}  // namespace
}  // namespace axisgate::test
