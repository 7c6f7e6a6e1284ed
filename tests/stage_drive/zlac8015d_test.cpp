// SPDX-License-Identifier: Apache-2.0
// A ZLAC8015D behind the shipped core: two axes behind one control word and one mode. What is asked of one is judged by
// both simulated motors.
#include <gmock/gmock.h>

#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::Zlac8015d;
using State = Zlac8015d::State;

constexpr std::size_t kLeft = Zlac8015d::left, kRight = Zlac8015d::right;
constexpr int kSpeed = 3, kPosition = 2;
constexpr std::uint16_t kTooMuchCurrent = 4;

GatewayStage::Line line_in(int mode, std::map<std::string, Rational> constants) {
  simulated::ZlacOptions options;
  options.stored = {{0x2030, 4096}};  // another encoder than the right motor's
  GatewayStage::Line line = rtu_line_of({options}, 1);
  line.rtu_drives.front().constants = std::move(constants);
  line.rtu_drives.front().constants.emplace("control_mode", mode);
  return line;
}

class ZlacRig {
 public:
  explicit ZlacRig(int mode, std::map<std::string, Rational> constants = {})
      : stage({line_in(mode, std::move(constants))}) {
    expect(stage.come_online(), "never online");
  }

  GatewayStage stage;

  [[nodiscard]] Zlac8015d& drive() { return stage.zlac8015d(0); }
  [[nodiscard]] const AxisImage& axis(AxisNumber number) { return stage.axis(number); }
  Errc ask(AxisNumber axis, Command command, std::initializer_list<Setpoint> with = {}) {
    return stage.ask(axis, with_command(command, with)).outcome.code;
  }
  /// In 1/10000 turn.
  std::int64_t position(std::size_t motor) {
    return simulated::divide_rounded(std::int64_t{drive().position(motor)} * 10'000, drive().counts_per_rev(motor));
  }
  /// In the next second, in 1/10000 turn.
  std::int64_t way(std::size_t motor) {
    const std::int64_t before = position(motor);
    stage.run(1s);
    return position(motor) - before;
  }
  bool ends(AxisNumber number, MotionState how) {
    return stage.run_until([&] { return axis(number).motion_state != MotionState::active; }, 60s) &&
           axis(number).motion_state == how;
  }
  /// Axis 1 runs at 60 rpm.
  void run() {
    expect(ask(1, Command::enable) == Errc::ok, "not enabled");
    expect(ask(1, Command::run_velocity, {{Quantity::target_velocity, 60'000}}) == Errc::ok, "does not run");
    stage.run(1s);
  }
};

TEST(Zlac8015d, EachMotorHasItsOwnSpeedAndItsOwnEncoder) {
  ZlacRig rig(kSpeed);
  ASSERT_EQ(rig.ask(1, Command::enable), Errc::ok);
  ASSERT_EQ(rig.ask(1, Command::run_velocity, {{Quantity::target_velocity, 60'000}}), Errc::ok);
  ASSERT_EQ(rig.ask(2, Command::enable), Errc::ok);
  ASSERT_EQ(rig.ask(1, Command::run_velocity, {{Quantity::target_velocity, 60'000}}), Errc::ok);
  ASSERT_EQ(rig.ask(2, Command::run_velocity, {{Quantity::target_velocity, -120'000}}), Errc::ok);
  rig.stage.run(1s);
  EXPECT_NEAR(static_cast<double>(rig.way(kLeft)), 10'000, 150);
  EXPECT_NEAR(static_cast<double>(rig.way(kRight)), -20'000, 300);
  EXPECT_NEAR(static_cast<double>(rig.axis(2)[Quantity::velocity_actual].value), -120'000, 200);
  EXPECT_NEAR(static_cast<double>(rig.axis(1)[Quantity::position_actual].value - rig.position(kLeft)), 0, 1'000);
}

TEST(Zlac8015d, EachMotorMovesByItself) {
  ZlacRig rig(kPosition);
  ASSERT_EQ(rig.ask(1, Command::enable), Errc::ok);
  ASSERT_EQ(rig.ask(2, Command::enable), Errc::ok);
  ASSERT_EQ(rig.ask(1, Command::move_absolute, {{Quantity::target_position, 15'000}}), Errc::ok);
  EXPECT_TRUE(rig.ends(1, MotionState::completed));
  EXPECT_EQ(rig.position(kLeft), 15'000);
  EXPECT_EQ(rig.position(kRight), 0) << "nobody asked it";
  ASSERT_EQ(
      rig.ask(2, Command::move_relative, {{Quantity::target_position, -5'000}, {Quantity::profile_velocity, 30'000}}),
      Errc::ok);
  EXPECT_TRUE(rig.ends(2, MotionState::completed));
  EXPECT_EQ(rig.position(kRight), -5'000);
  EXPECT_EQ(rig.position(kLeft), 15'000);
  ASSERT_EQ(rig.ask(2, Command::set_position), Errc::ok);
  EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis(2)[Quantity::position_actual].value == 0; }));
  EXPECT_EQ(rig.position(kLeft), 15'000) << "the other's position is its own";
}

TEST(Zlac8015d, AStopOfOneStopsAndLatchesBoth) {
  for (const Command stop : {Command::quick_stop, Command::halt}) {
    ZlacRig rig(kSpeed);
    rig.run();
    ASSERT_EQ(rig.ask(2, Command::enable), Errc::ok);
    ASSERT_EQ(rig.ask(1, Command::run_velocity, {{Quantity::target_velocity, 60'000}}), Errc::ok);
    ASSERT_EQ(rig.ask(2, Command::run_velocity, {{Quantity::target_velocity, 60'000}}), Errc::ok);
    rig.stage.run(1s);
    ASSERT_EQ(rig.ask(2, stop), Errc::ok);
    rig.stage.run(1s);
    EXPECT_EQ(rig.way(kLeft), 0);
    EXPECT_EQ(rig.way(kRight), 0);
    EXPECT_NE(rig.ask(1, Command::run_velocity, {{Quantity::target_velocity, 60'000}}), Errc::ok)
        << "a set-point of the one would undo the other's stop";
    EXPECT_EQ(rig.way(kLeft), 0);
  }
}

TEST(Zlac8015d, WhileOneIsLatchedNeitherIsEnabled) {
  ZlacRig rig(kSpeed);
  rig.run();
  ASSERT_EQ(rig.ask(1, Command::quick_stop), Errc::ok);
  EXPECT_NE(rig.ask(2, Command::enable), Errc::ok) << "it would end the stop of axis 1";
  EXPECT_EQ(rig.drive().state(), State::quick_stopped);
}

TEST(Zlac8015d, DisableTakesTheTorqueOfBoth) {
  ZlacRig rig(kSpeed);
  rig.run();
  EXPECT_TRUE(rig.drive().powered());
  ASSERT_EQ(rig.ask(1, Command::disable), Errc::ok);
  EXPECT_FALSE(rig.drive().powered());
  EXPECT_EQ(rig.way(kLeft), 0);
}

TEST(Zlac8015d, AnEnableMovesNeitherByWhatWasAskedBefore) {
  ZlacRig rig(kSpeed);
  rig.run();
  ASSERT_EQ(rig.ask(1, Command::disable), Errc::ok);
  ASSERT_EQ(rig.drive().poke(0x2089, 200), simulated::RtuException::none);  // left from somebody, of the right motor
  ASSERT_EQ(rig.ask(1, Command::enable), Errc::ok);
  EXPECT_EQ(rig.way(kLeft), 0);
  EXPECT_EQ(rig.way(kRight), 0);
}

TEST(Zlac8015d, AFaultOfOneMotorIsToldAndReset) {
  ZlacRig rig(kSpeed);
  rig.run();
  rig.drive().inject_fault(kLeft, kTooMuchCurrent);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis(1).has(AxisInput::fault); }));
  EXPECT_EQ(rig.axis(1)[Quantity::error_code].value, 0x2310);
  EXPECT_FALSE(rig.axis(2).has(AxisInput::fault));
  EXPECT_NE(rig.ask(1, Command::fault_reset), Errc::ok) << "its cause is there";
  rig.drive().clear_fault_cause();
  ASSERT_EQ(rig.ask(1, Command::fault_reset), Errc::ok);
  ASSERT_EQ(rig.ask(1, Command::enable), Errc::ok);
  EXPECT_TRUE(rig.drive().powered());
  EXPECT_EQ(rig.way(kLeft), 0);
}

TEST(Zlac8015d, RampsAreHadOnceItIsSaidWhatTheirTimeGoesTo) {
  ZlacRig without(kSpeed);
  EXPECT_EQ(without.axis(1).supported & bit(Quantity::profile_acceleration), 0U);
  ZlacRig rig(kSpeed, {{"ramp_speed_rpm", 1000}});
  ASSERT_EQ(rig.ask(1, Command::none, {{Quantity::profile_acceleration, 5'000}}), Errc::ok);
  EXPECT_EQ(rig.drive().peek(0x2080), 2000) << "500 rpm/s are 2000 ms to 1000 rpm";
  EXPECT_EQ(rig.drive().peek(0x2081), 500) << "the other motor's is its own";
}

TEST(Zlac8015d, TheGatewaySetsThatEachMotorIsStartedByItselfAndThatSilenceIsMinded) {
  ZlacRig rig(kPosition);
  EXPECT_EQ(rig.drive().peek(0x2000), 1000);
  EXPECT_EQ(rig.drive().writes(0x200F), 0U) << "it was so already";
}

}  // namespace
}  // namespace axisgate::test
