// SPDX-License-Identifier: Apache-2.0
// Design 3.4 Jog, on an axis that really moves: while its button is held, and not a moment longer.
#include <gmock/gmock.h>

#include "tests/stage_drive/leased_axis.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

struct JoggedAxis : LeasedAxis {
  explicit JoggedAxis(const RigOptions& options = leased()) : LeasedAxis(options) {
    EXPECT_EQ(command(plc, Command::enable), Errc::ok);
    WriteBatch speed;
    speed.jog_velocity = 60'000;
    EXPECT_EQ(ask(plc, speed), Errc::ok);
  }
  void hold(Command direction, Duration time) {
    for (Duration done{}; done < time; done += 100ms) {
      WriteBatch again;
      again.jog_again = direction;
      // not_new: the jog has ended meanwhile, and the button is held in vain.
      EXPECT_THAT(ask(plc, again), testing::AnyOf(Errc::ok, Errc::not_new));
      rig.stage.run(100ms);
    }
  }
  /// And its owner goes on asking meanwhile.
  bool homes() {
    EXPECT_EQ(command(plc, Command::home), Errc::ok);
    return rig.stage.run_until([this] {
      plc->last_request = rig.stage.runtime().now();
      return rig.axis().has(AxisInput::homed);
    });
  }
  std::int64_t speed() { return rig.axis()[Quantity::velocity_actual].value; }
};

TEST(JogOnAnAxis, EndsWhenTheReleaseIsLostThoughItsOwnerLives) {
  JoggedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  EXPECT_TRUE(axis.rig.turns());
  axis.keep(axis.plc, 3s);  // reads go on; nobody writes the coil
  EXPECT_FALSE(axis.rig.turns());
  axis.hold(Command::jog_forward, 1s);
  EXPECT_FALSE(axis.rig.turns()) << "a button that is still held starts nothing";
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 500ms);
  EXPECT_TRUE(axis.rig.turns());
}

TEST(JogOnAnAxis, NeedsAVelocity) {
  LeasedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::enable), Errc::ok);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::bad_value);
}

TEST(JogOnAnAxis, AStopIsCarriedOutWhateverJogVelocityStandsBesideIt) {
  JoggedAxis axis;
  WriteBatch stop = with_command(Command::quick_stop);
  stop.jog_velocity = 4'000'000'000;
  EXPECT_EQ(axis.ask(axis.plc, stop), Errc::bad_value);
  EXPECT_TRUE(axis.latched());
  stop.jog_velocity = 5'000;
  EXPECT_EQ(axis.ask(axis.panel, stop), Errc::not_owner);
  EXPECT_EQ(axis.rig.axis().jog_velocity, 60'000U) << "what is refused is not kept";
}

// From 600 rpm it takes 30 turns to stop.
TEST(JogOnAnAxis, IsRefusedWhereItCouldNotEndBeforeTheLimit) {
  RigOptions options = leased();
  options.axis.limits.position = Range{-30'000, 30'000};
  options.axis.homing_method = 35;
  JoggedAxis axis(options);
  ASSERT_TRUE(axis.homes());
  WriteBatch slow = setpoints({{Quantity::profile_deceleration, 1'000}});
  slow.jog_velocity = 600'000;
  EXPECT_EQ(axis.ask(axis.plc, slow), Errc::ok);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::state_unsuitable);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_reverse), Errc::state_unsuitable);
  EXPECT_FALSE(axis.rig.turns());
  slow.jog_velocity = 60'000;
  EXPECT_EQ(axis.ask(axis.plc, slow), Errc::ok);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
}

// Where its register cannot show the position any more, the limits are further away still.
TEST(JogOnAnAxis, GoesNoFurtherWhereItStandsBeyondWhatItsRegisterCanShow) {
  RigOptions options = leased();
  options.axis.units_per_rev = Rational(10'000'000);
  options.axis.limits.position = Range{-2'000'000'000, 2'000'000'000};
  options.axis.homing_method = 35;
  JoggedAxis axis(options);
  ASSERT_TRUE(axis.homes());
  EXPECT_EQ(axis.ask(axis.plc, with_command(Command::run_velocity, {{Quantity::target_velocity, 3'000'000}})),
            Errc::ok);
  axis.keep(axis.plc, 6s);
  EXPECT_EQ(axis.command(axis.plc, Command::halt), Errc::ok);
  axis.keep(axis.plc, 3s);
  ASSERT_FALSE(axis.rig.axis()[Quantity::position_actual].valid);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::state_unsuitable);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_reverse), Errc::ok);
  axis.hold(Command::jog_reverse, 1s);
  EXPECT_LT(axis.speed(), 0) << "back is open";
}

TEST(JogOnAnAxis, EndsAtThePositionLimitOfAHomedAxis) {
  for (const bool of_the_drive : {false, true}) {
    RigOptions options = leased();
    if (!of_the_drive) options.axis.limits.position = Range{-30'000, 30'000};
    options.axis.homing_method = 35;
    JoggedAxis axis(options);
    const WriteBatch limits =
        setpoints({{Quantity::position_limit_min, -30'000}, {Quantity::position_limit_max, 30'000}});
    EXPECT_EQ(axis.ask(axis.plc, of_the_drive ? limits : WriteBatch{}), Errc::ok);
    ASSERT_TRUE(axis.homes());
    EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
    axis.hold(Command::jog_forward, 10s);
    EXPECT_FALSE(axis.rig.turns());
    const std::int64_t end = axis.rig.axis()[Quantity::position_actual].value;
    EXPECT_LE(end, 30'000);
    EXPECT_GT(end, 20'000);
    EXPECT_TRUE(axis.rig.has_event(EventKind::warning, "halted at the position limit"));
    EXPECT_EQ(axis.ask(axis.plc, with_command(Command::move_absolute, {{Quantity::target_position, 30'000}})),
              Errc::ok);
    axis.keep(axis.plc, 4s);
    EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::state_unsuitable) << "it stands at the limit";
    EXPECT_EQ(axis.command(axis.plc, Command::jog_reverse), Errc::ok);
    axis.hold(Command::jog_reverse, 1s);
    EXPECT_LT(axis.speed(), 0) << "back is open";
  }
}

// What is asked of the drive keeps the polls waiting: the position is older than it looks.
TEST(JogOnAnAxis, EndsAtThePositionLimitAlsoWhereSomebodyWritesAllTheTime) {
  RigOptions options = leased();
  options.axis.limits.position = Range{-300'000, 300'000};
  options.axis.homing_method = 35;
  JoggedAxis axis(options);
  ASSERT_TRUE(axis.homes());
  WriteBatch fast = setpoints({{Quantity::profile_acceleration, 100'000}, {Quantity::profile_deceleration, 100'000}});
  fast.jog_velocity = 1'500'000;
  EXPECT_EQ(axis.ask(axis.plc, fast), Errc::ok);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  WriteBatch held;
  held.jog_again = Command::jog_forward;
  for (int i = 0; i < 300; ++i) {
    static_cast<void>(axis.ask(axis.plc, held));
    static_cast<void>(axis.ask(axis.plc, setpoints({{Quantity::homing_speed_zero, 60'000 + 6'000 * (i % 2)}})));
  }
  axis.keep(axis.plc, 2s);
  EXPECT_FALSE(axis.rig.turns());
  const std::int64_t end = axis.rig.axis()[Quantity::position_actual].value;
  EXPECT_LE(end, 300'000);
  EXPECT_GT(end, 100'000);
}

TEST(JogOnAnAxis, TheButtonOfAnotherClientDoesNotEndIt) {
  JoggedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  EXPECT_EQ(axis.ask(axis.panel, with_command(Command::jog_end), false), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  EXPECT_TRUE(axis.rig.turns());
}

TEST(JogOnAnAxis, OfARunThatAFaultHasEndedIsOverAndTheHeldButtonIsToldSo) {
  JoggedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  axis.rig.motor().inject_fault(1, 0x0020);
  axis.hold(Command::jog_forward, 400ms);
  axis.rig.motor().clear_fault_cause(1, 0x0020);
  EXPECT_EQ(axis.command(axis.plc, Command::fault_reset), Errc::ok);
  EXPECT_EQ(axis.command(axis.plc, Command::enable), Errc::ok);
  EXPECT_EQ(axis.rig.axis().level_coils >> 8 & 3U, 0U);
  WriteBatch again;
  again.jog_again = Command::jog_forward;
  EXPECT_EQ(axis.ask(axis.plc, again), Errc::not_new);
}

TEST(JogOnAnAxis, IsHaltedWhenItsOwnerReleasesTheAxis) {
  RigOptions options = leased();
  options.axis.jog_timeout = 60s;
  JoggedAxis axis(options);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  EXPECT_EQ(axis.command(axis.plc, Command::release), Errc::ok);
  axis.rig.stage.run(1500ms);
  EXPECT_FALSE(axis.rig.turns()) << "before anybody's lease has run out";
  EXPECT_FALSE(axis.latched());
}

}  // namespace
}  // namespace axisgate::test
