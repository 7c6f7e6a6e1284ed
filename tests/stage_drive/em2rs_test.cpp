// SPDX-License-Identifier: Apache-2.0
// EM2RS and CS2RS behind the shipped core, by the motor's own position: enable, move, run, stop, home, fault and reset.
// Ramps are times there, so that a steeper one is a smaller number.
#include <gmock/gmock.h>

#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::Em2rsOptions;

constexpr std::uint16_t kOvercurrent = 1, kOvercurrentOfCs2rs = 0xE0;

class Em2rsRig {
 public:
  explicit Em2rsRig(Em2rsOptions options = {}) : stage({rtu_line_of({std::move(options)}, 1)}) {
    expect(stage.come_online(), "never online");
  }

  GatewayStage stage;

  [[nodiscard]] simulated::Em2rs& motor() { return stage.em2rs(0); }
  [[nodiscard]] const AxisImage& axis() { return stage.axis(1); }
  Errc ask(Command command, std::initializer_list<Setpoint> with = {}) {
    return stage.ask(1, with_command(command, with)).outcome.code;
  }
  /// In 1/10000 turn, as the simulated motor stands.
  std::int64_t position() { return simulated::divide_rounded(motor().position() * 10'000, motor().pulses_per_rev()); }
  bool ends(MotionState how) {
    return stage.run_until([&] { return axis().motion_state != MotionState::active; }, 60s) &&
           axis().motion_state == how;
  }
  bool stands() {
    return stage.run_until([&] { return !motor().running() && !axis().has(AxisInput::moving); }, 10s);
  }
};

class Em2rs : public ::testing::TestWithParam<bool> {
 protected:
  Em2rsOptions options() const { return {.closed_loop = GetParam()}; }
};
INSTANTIATE_TEST_SUITE_P(Loop, Em2rs, ::testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Cs2rs" : "Em2rs"; });

TEST_P(Em2rs, IsEnabledMovesAndIsDisabledByTheBus) {
  Em2rsRig rig(options());
  EXPECT_FALSE(rig.motor().enabled());
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  EXPECT_TRUE(rig.motor().enabled());
  ASSERT_EQ(
      rig.ask(Command::move_absolute, {{Quantity::target_position, 25'000}, {Quantity::profile_velocity, 300'000}}),
      Errc::ok);
  EXPECT_TRUE(rig.ends(MotionState::completed));
  EXPECT_EQ(rig.position(), 25'000);
  ASSERT_EQ(rig.ask(Command::move_relative, {{Quantity::target_position, -5'000}}), Errc::ok);
  EXPECT_TRUE(rig.ends(MotionState::completed));
  EXPECT_EQ(rig.position(), 20'000);
  EXPECT_EQ(rig.axis()[Quantity::position_actual].value, 20'000);
  ASSERT_EQ(rig.ask(Command::disable), Errc::ok);
  EXPECT_FALSE(rig.motor().enabled());
}

TEST_P(Em2rs, CountsByThePulsesThatItIsSetTo) {
  Em2rsOptions fine = options();
  fine.stored = {{0x0001, 1600}};
  Em2rsRig rig(fine);
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  EXPECT_NE(rig.ask(Command::move_absolute, {{Quantity::target_position, 10'000}}), Errc::ok) << "at no speed";
  ASSERT_EQ(
      rig.ask(Command::move_absolute, {{Quantity::target_position, 10'000}, {Quantity::profile_velocity, 300'000}}),
      Errc::ok);
  EXPECT_TRUE(rig.ends(MotionState::completed));
  EXPECT_EQ(rig.motor().position(), 1600) << "one turn";
}

TEST_P(Em2rs, RunsBothWaysAndAQuickStopEndsItEnergised) {
  Em2rsRig rig(options());
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  for (const std::int64_t rpm : {300, -300}) {
    ASSERT_EQ(rig.ask(Command::run_velocity, {{Quantity::target_velocity, rpm * 1000}}), Errc::ok);
    rig.stage.run(1s);
    const std::int64_t before = rig.position();
    rig.stage.run(1s);
    EXPECT_NEAR(static_cast<double>(rig.position() - before), static_cast<double>(rpm) / 60 * 10'000, 300);
  }
  ASSERT_EQ(rig.ask(Command::quick_stop), Errc::ok);
  EXPECT_FALSE(rig.motor().running());
  EXPECT_TRUE(rig.motor().enabled());
  EXPECT_NE(rig.ask(Command::run_velocity, {{Quantity::target_velocity, 60'000}}), Errc::ok) << "latched";
}

TEST_P(Em2rs, ARunDoesNotBecomeTheSpeedOfTheNextMove) {
  Em2rsRig rig(options());
  ASSERT_EQ(rig.ask(Command::none, {{Quantity::profile_velocity, 120'000}}), Errc::ok);
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  ASSERT_EQ(rig.ask(Command::run_velocity, {{Quantity::target_velocity, -600'000}}), Errc::ok);
  rig.stage.run(1s);
  ASSERT_EQ(rig.ask(Command::halt), Errc::ok);
  ASSERT_TRUE(rig.stands());
  const std::int64_t from = rig.position();
  ASSERT_EQ(rig.ask(Command::move_absolute, {{Quantity::target_position, from + 100'000}}), Errc::ok);
  rig.stage.run(1500ms);
  const std::int64_t before = rig.position();
  rig.stage.run(1s);
  EXPECT_NEAR(static_cast<double>(rig.position() - before), 20'000, 300) << "120 rpm, as the client had asked";
}

// raw = 1,000,000 / (rpm/s): 1000 rpm/s are 1000 ms to 1000 rpm.
TEST_P(Em2rs, ARampIsATimeToTheDrive) {
  Em2rsRig rig(options());
  ASSERT_EQ(
      rig.ask(Command::none, {{Quantity::profile_acceleration, 10'000}, {Quantity::profile_deceleration, 40'000}}),
      Errc::ok);
  EXPECT_EQ(rig.motor().peek(0x6204), 1000);
  EXPECT_EQ(rig.motor().peek(0x6205), 250);
  EXPECT_EQ(rig.axis()[Quantity::profile_acceleration].value, 10'000);
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  ASSERT_EQ(rig.ask(Command::run_velocity, {{Quantity::target_velocity, 1'000'000}}), Errc::ok);
  const std::int64_t before = rig.position();
  rig.stage.run(500ms);
  EXPECT_NEAR(static_cast<double>(rig.position() - before), 500.0 / 60 * 10'000 / 4, 2500)
      << "a quarter second of 500 rpm";
  EXPECT_NE(rig.ask(Command::none, {{Quantity::profile_acceleration, 0}}), Errc::ok) << "no time is long enough";
}

TEST_P(Em2rs, HomesToItsSwitch) {
  Em2rsOptions wired = options();
  wired.stored = {{0x0147, 0x27}};
  wired.mechanics.home_from = 7'000;
  Em2rsRig rig(wired);
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  ASSERT_EQ(rig.ask(Command::home, {{Quantity::homing_method, 19}}), Errc::ok);
  EXPECT_TRUE(rig.ends(MotionState::completed));
  EXPECT_EQ(rig.position(), 0);
  EXPECT_NEAR(static_cast<double>(simulated::counts_of(rig.motor().axis().physical())), 7'000, 20);
}

TEST_P(Em2rs, HomesOnlyWhereAnInputIsForTheSwitchThatItLooksFor) {
  Em2rsOptions wired = options();
  wired.stored = {{0x0149, 0xA6}};  // negative limit, normally closed
  wired.mechanics.negative_limit = -5'000;
  Em2rsRig rig(wired);
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  EXPECT_NE(rig.ask(Command::home, {{Quantity::homing_method, 19}}), Errc::ok) << "no input is a home switch";
  EXPECT_FALSE(rig.motor().running());
  ASSERT_EQ(rig.ask(Command::home, {{Quantity::homing_method, 17}}), Errc::ok);
  EXPECT_TRUE(rig.ends(MotionState::completed));
  EXPECT_NEAR(static_cast<double>(simulated::counts_of(rig.motor().axis().physical())), -5'000, 20);
}

TEST_P(Em2rs, AFaultTakesItsTorqueAndIsResetOnceItsCauseIsGone) {
  Em2rsRig rig(options());
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  ASSERT_EQ(rig.ask(Command::run_velocity, {{Quantity::target_velocity, 300'000}}), Errc::ok);
  rig.stage.run(500ms);
  rig.motor().inject_fault(GetParam() ? kOvercurrentOfCs2rs : kOvercurrent);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().has(AxisInput::fault); }));
  EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis()[Quantity::error_code].value == 0x2310; }));
  EXPECT_NE(rig.ask(Command::fault_reset), Errc::ok) << "its cause is there";
  rig.motor().clear_fault_cause();
  ASSERT_EQ(rig.ask(Command::fault_reset), Errc::ok);
  EXPECT_FALSE(rig.motor().enabled());
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  EXPECT_TRUE(rig.motor().enabled());
}

TEST_P(Em2rs, AsDeliveredItsInputEnablesItAndThatIsTold) {
  Em2rsOptions fresh = options();
  fresh.input_enables = true;
  Em2rsRig rig(fresh);
  EXPECT_TRUE(rig.motor().enabled());
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::local_control), 0U);
  EXPECT_NE(rig.ask(Command::enable), Errc::ok);
}

TEST_P(Em2rs, SavesAndTellsWhen) {
  Em2rsRig rig(options());
  EXPECT_EQ(rig.ask(Command::save_parameters), Errc::ok);
}

}  // namespace
}  // namespace axisgate::test
