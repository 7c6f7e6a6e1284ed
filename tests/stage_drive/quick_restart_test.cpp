// SPDX-License-Identifier: Apache-2.0
// A drive that restarts on a line that does not tell so, sooner than anybody misses it (3.1 homed, 3.4 What survives);
// what every start goes by then (3.3 Set-points). And a run that the drive itself has ended.
#include <gtest/gtest.h>

#include "tests/stage_drive/rig.hpp"
#include "tests/stage_drive/stepper_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using enum Situation;

constexpr std::int64_t kSlowly = 60'000;  // 60 rpm: each of these drives has more of its own

void restart(Rig& rig) {
  auto& link = rig.stage.link(0);
  link.line().restart(0, link.time_of(rig.stage.runtime().now()));
}

void restart(StepperRig& rig) {
  auto& link = rig.stage.rtu_link(0);
  link.line().restart(0, link.time_of(rig.stage.runtime().now()));
}

class QuickRestart : public testing::TestWithParam<KincoType> {
 protected:
  static RigOptions quick(simulated::Time boot_time) {
    RigOptions options;
    options.drive.boot_time = boot_time;
    options.axis.homing_method = 35;
    return options;
  }
  /// However restart and start meet. `limit`: of its velocity; `before`: what happens before the restart.
  static void starts_slowly_right_after(std::optional<std::int64_t> limit, void (*before)(Rig&)) {
    for (const auto boot_time : {60ms, 200ms, 500ms}) {
      for (const auto pause : {0ms, 20ms, 50ms, 100ms, 200ms, 400ms}) {
        SCOPED_TRACE(testing::Message() << boot_time.count() << ' ' << pause.count());
        RigOptions options = quick(boot_time);
        options.axis.limits.velocity = limit;
        Rig rig(GetParam(), options);
        rig.bring_to(enabled);
        ASSERT_NO_FATAL_FAILURE(before(rig));
        restart(rig);
        rig.stage.run(boot_time + pause);
        static_cast<void>(rig.command(Command::enable));
        static_cast<void>(rig.ask(with_command(Command::move_relative, {{Quantity::target_position, 500'000}})));
        std::int64_t fastest = 0;
        for (int i = 0; i < 100; ++i, rig.stage.run(10ms))
          fastest = std::max(fastest, rig.axis()[Quantity::velocity_actual].value);
        EXPECT_LE(fastest, kSlowly + kSlowly / 20);
      }
    }
  }
};

TEST_P(QuickRestart, IsSeenByTheReferenceThatIsLost) {
  constexpr std::int64_t kCycle = 20;  // of the polls, in ms: between two of them no request meets the shortest one
  for (const auto boot_time : {0ms, 200ms}) {
    for (std::int64_t at = 0; at < kCycle; ++at) {
      SCOPED_TRACE(testing::Message() << boot_time.count() << " ms, " << at);
      Rig rig(GetParam(), quick(boot_time));
      rig.bring_to(enabled);
      ASSERT_EQ(rig.command(Command::home).outcome.code, Errc::ok);
      ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }));
      ASSERT_EQ(rig.write(Quantity::profile_velocity, kSlowly).outcome.code, Errc::ok);
      rig.stage.run(1s + std::chrono::milliseconds(at));
      ASSERT_TRUE(rig.axis().has(AxisInput::homed));
      restart(rig);
      rig.stage.run(5s);
      EXPECT_EQ(rig.axis().link_state, LinkState::online);
      EXPECT_FALSE(rig.axis().has(AxisInput::homed));
      EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::not_homed), 0U);
      EXPECT_GT(rig.axis()[Quantity::profile_velocity].value, kSlowly) << "what the drive holds is shown";
    }
  }
}

// 3.3: "the last accepted set-point is the one that every start uses, whatever was sent to the drive for it".
TEST_P(QuickRestart, AndASlowOneLeavesTheSpeedThatWasAskedFor) {
  for (const auto boot_time : {1ms, 200ms, 2000ms}) {
    for (const bool raw : {false, true}) {
      SCOPED_TRACE(testing::Message() << boot_time.count() << (raw ? " raw" : ""));
      Rig rig(GetParam(), quick(boot_time));
      rig.bring_to(enabled);
      ASSERT_EQ(rig.command(Command::home).outcome.code, Errc::ok);
      ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }));
      ASSERT_EQ(rig.write(Quantity::profile_velocity, kSlowly).outcome.code, Errc::ok);
      rig.stage.run(1s);
      restart(rig);
      rig.stage.run(10s);
      ASSERT_EQ(rig.axis().link_state, LinkState::online);
      ASSERT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
      ASSERT_EQ(rig.write(Quantity::target_position, 500'000).outcome.code, Errc::ok);
      if (raw) {
        ASSERT_EQ(rig.write(Quantity::mode, 1).outcome.code, Errc::ok);
        ASSERT_EQ(rig.ask(with_controlword(0x000F)).outcome.code, Errc::ok);
        ASSERT_EQ(rig.ask(with_controlword(0x003F)).outcome.code, Errc::ok);
      } else {
        ASSERT_EQ(rig.command(Command::move_absolute).outcome.code, Errc::ok);
      }
      std::int64_t fastest = 0;
      for (int i = 0; i < 200; ++i, rig.stage.run(10ms))
        fastest = std::max(fastest, rig.axis()[Quantity::velocity_actual].value);
      EXPECT_GT(fastest, kSlowly / 2);
      EXPECT_LE(fastest, kSlowly + kSlowly / 20);
      EXPECT_EQ(rig.axis()[Quantity::profile_velocity].value, kSlowly);
    }
  }
}

// 3.3: a number is "known to hold" only "with no timeout since": a start that comes at once finds others in the drive.
TEST_P(QuickRestart, RightBeforeAStartLeavesTheSpeedThatWasAskedFor) {
  starts_slowly_right_after({}, [](Rig& rig) {
    ASSERT_EQ(rig.write(Quantity::profile_velocity, kSlowly).outcome.code, Errc::ok);
    rig.stage.run(2s);
  });
}

// A speed that only a limit has written is the drive's own again: nobody has asked for it, and it is beyond the limit.
TEST_P(QuickRestart, RightBeforeAStartLeavesTheSpeedWithinItsLimit) {
  starts_slowly_right_after(kSlowly, [](Rig& rig) {
    EXPECT_EQ(rig.ask(with_command(Command::move_relative, {{Quantity::target_position, 50'000}})).outcome.code,
              Errc::ok);
    rig.stage.run(6s);
  });
}

INSTANTIATE_TEST_SUITE_P(Every, QuickRestart, testing::Values(KincoType::jd, KincoType::md),
                         [](const auto& tested) { return name(tested.param); });

// A parameter that the drive refuses holds up no start.
TEST(SpeedsOfAStart, AreNotThoseThatTheDriveHasRefused) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  rig.stage.link(0).on_traffic = [&](bool to_drive, Bytes bytes) {
    const WireRequest r = decoded(kLongAgo, bytes);
    if (to_drive && r.write && r.index == 0x6081) rig.stage.link(0).fate = SimLink::Fate::refused;
  };
  EXPECT_EQ(rig.write(Quantity::profile_velocity, kSlowly).outcome.code, Errc::refused_by_drive);
  rig.stage.link(0).on_traffic = [](bool, Bytes) {};
  EXPECT_EQ(rig.ask(with_command(Command::move_absolute, {{Quantity::target_position, 50'000}})).outcome.code,
            Errc::ok);
  EXPECT_TRUE(rig.turns());
}

// 3.3 Zeros: a speed or ramp of 0 is none, also where the drive's own number is too coarse for it.
TEST(SpeedsOfAStart, AreNoneThatTheDriveWouldHoldAsZero) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  for (const Quantity quantity :
       {Quantity::profile_acceleration, Quantity::profile_deceleration, Quantity::homing_acceleration,
        Quantity::max_velocity, Quantity::homing_speed_switch, Quantity::homing_speed_zero}) {
    if (rig.axis().limits[static_cast<std::size_t>(quantity)].min <= 1) continue;  // fine enough
    EXPECT_EQ(rig.write(quantity, 1).outcome.code, Errc::bad_value) << row(quantity).name;
    EXPECT_NE(rig.axis()[quantity].value, 0) << row(quantity).name;
  }
  EXPECT_EQ(rig.write(Quantity::profile_deceleration, 1).outcome.code, Errc::bad_value);
  EXPECT_TRUE(rig.writes_of(0x6084).empty());
}

// Its emergency stop is an input of its own, of which no word tells.
TEST(StepperRun, EndsWhereTheDriveEndsIt) {
  constexpr int kInput = 1;
  constexpr std::uint16_t kFunction = 400, kEmergencyStop = 7;
  StepperRig rig;
  rig.online();
  rig.motor().poke(kFunction, kEmergencyStop);
  rig.enable();
  rig.run_at(100'000);
  rig.motor().set_input(kInput, true);
  rig.stage.run(100ms);
  rig.motor().set_input(kInput, false);
  rig.stage.run(2s);
  EXPECT_EQ(rig.axis().motion_state, MotionState::failed);
  EXPECT_EQ(rig.axis().axis_state, AxisState::standstill);
  EXPECT_EQ(rig.axis().level_coils >> 7 & 1U, 0U) << "coil 7";
  EXPECT_EQ(rig.code(rig.write(Quantity::target_velocity, 140'000)), Errc::ok) << "it waits for a start";
  rig.stage.run(2s);
  EXPECT_EQ(rig.motor().run_state(), simulated::Id286pro::RunState::stopped);
  EXPECT_EQ(rig.code(rig.command(Command::run_velocity)), Errc::ok);
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().run_state(), simulated::Id286pro::RunState::running);
}

TEST(StepperRun, GoesOnAtASpeedOfZeroAndThroughIt) {
  StepperRig rig;
  rig.online();
  rig.enable();
  rig.run_at(100'000);
  for (const std::int64_t speed : {0, 80'000, -80'000, 0, 100'000}) {
    ASSERT_EQ(rig.code(rig.write(Quantity::target_velocity, speed)), Errc::ok);
    rig.stage.run(3s);
    EXPECT_EQ(rig.axis().motion_state, MotionState::active) << speed;
    EXPECT_EQ(rig.motor().run_state() == simulated::Id286pro::RunState::running, speed != 0) << speed;
  }
}

// A PLC that writes its ramp all the time: "velocity, torque and start are needed anew".
TEST(StepperRun, DoesNotSurviveAQuickRestart) {
  for (const auto boot_time : {100ms, 300ms, 1000ms}) {
    SCOPED_TRACE(boot_time.count());
    StepperOptions options;
    options.drive.boot_time = boot_time;
    StepperRig rig(options);
    rig.online();
    rig.enable();
    rig.run_at(100'000);
    restart(rig);
    rig.stage.run(boot_time);
    const std::size_t starts = rig.motor().starts().size();
    for (int i = 0; i < 30; ++i) {
      static_cast<void>(rig.write(Quantity::target_velocity, 100'000 + 600 * i));
      rig.stage.run(100ms);
    }
    EXPECT_EQ(rig.motor().starts().size(), starts);
    EXPECT_NE(rig.axis().axis_state, AxisState::continuous_motion);
  }
}

TEST(StepperRestart, IsSeenByWhatItForgets) {
  for (const auto boot_time : {100ms, 200ms, 1000ms}) {
    SCOPED_TRACE(boot_time.count());
    StepperOptions options;
    options.drive.boot_time = boot_time;
    StepperRig rig(options);
    rig.online();
    ASSERT_EQ(rig.code(rig.write(Quantity::profile_velocity, kSlowly)), Errc::ok);
    rig.enable();
    ASSERT_EQ(rig.code(rig.move_to(20'000)), Errc::ok);
    ASSERT_TRUE(rig.motion_ends());
    rig.stage.run(1s);
    restart(rig);
    rig.stage.run(5s);
    EXPECT_EQ(rig.axis().link_state, LinkState::online);
    EXPECT_EQ(rig.axis().axis_state, AxisState::disabled);
    EXPECT_EQ(rig.code(rig.move_to(1'000)), Errc::state_unsuitable) << "no enable since";
    rig.enable();
    ASSERT_EQ(rig.code(rig.move_to(30'000)), Errc::ok);
    rig.stage.run(300ms);
    EXPECT_LE(rig.axis()[Quantity::velocity_actual].value, kSlowly + kSlowly / 20);
  }
}

// Whoever enables and starts it before anybody has seen the restart: what was accepted is not what it holds by then.
TEST(StepperRestart, RightBeforeAStartLeavesNoMotorTurningOnAnAxisThatIsDisabled) {
  for (const auto boot_time : {0ms, 60ms, 500ms}) {
    for (const auto pause : {0ms, 20ms, 60ms, 100ms, 200ms, 400ms, 700ms}) {
      for (const Command start : {Command::run_velocity, Command::move_relative}) {
        SCOPED_TRACE(testing::Message() << boot_time.count() << ' ' << pause.count() << ' ' << text(start));
        StepperOptions options;
        options.drive.boot_time = boot_time;
        StepperRig rig(options);
        rig.online();
        ASSERT_EQ(rig.code(rig.write(Quantity::profile_velocity, kSlowly)), Errc::ok);
        rig.stage.run(2s);
        restart(rig);
        rig.stage.run(boot_time + pause);
        static_cast<void>(rig.command(Command::enable));
        const auto target = start == Command::move_relative ? Quantity::target_position : Quantity::target_velocity;
        static_cast<void>(rig.ask(with_command(start, {{target, 90'000}})));
        std::int64_t fastest = 0;
        for (int i = 0; i < 50; ++i, rig.stage.run(20ms))
          fastest = std::max(fastest, rig.axis()[Quantity::velocity_actual].value);
        if (start == Command::move_relative) {
          EXPECT_LE(fastest, kSlowly + kSlowly / 20);
        }
        rig.stage.run(5s);
        const bool runs = rig.motor().run_state() == simulated::Id286pro::RunState::running;
        EXPECT_FALSE(runs && rig.axis().axis_state == AxisState::disabled);
        EXPECT_EQ(runs, rig.axis().motion_state == MotionState::active);
      }
    }
  }
}

}  // namespace
}  // namespace axisgate::test
