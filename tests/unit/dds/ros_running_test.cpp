// SPDX-License-Identifier: Apache-2.0
// What becomes of a run that a ROS 2 stream began when no sample asks for it any more, or when the name is taken.
#include "tests/unit/dds/ros_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using dds::RosAction;

// Samples that do not act are no sign of life of the program whose stream moves the motor.
struct RosRunning : Ros {
  void SetUp() override {
    act(RosAction::enable);
    ASSERT_TRUE(stream_until(velocities(0), [&] { return enabled(); }));
    stream(velocities(0), 200ms);
    ASSERT_TRUE(stream_until(velocities(3), [&] { return std::fabs(rig.state().velocity - 3) < 0.1; }));
  }
  dds::JointCommandsRecord velocities_of(std::uint8_t writer, double velocity) {
    auto out = velocities(velocity);
    out.writer = guid(writer);
    return out;
  }
  bool stopped() { return (rig.state().alarms & bit(AxisAlarm::stop_latched)) != 0; }
  /// Its lease has run out while this was streamed.
  void expect_stop(const dds::JointCommandsRecord& record) {
    const Instant silent = rig.now();
    EXPECT_TRUE(stream_until(record, [&] { return stopped(); }));
    EXPECT_LE(rig.now() - silent, 2200ms);
    EXPECT_TRUE(rig.run_until([&] { return !rig.turns(); }, 5s));
  }
};

TEST_F(RosRunning, AnothersStreamOutOfStepKeepsNoRunAlive) { expect_stop(velocities_of(2, 3)); }

TEST_F(RosRunning, AnothersPositionsOutOfStepKeepNoRunAlive) { expect_stop(sample({-1000}, 2)); }

TEST_F(RosRunning, AValueThatNoRegisterHoldsKeepsNoRunAlive) { expect_stop(velocities(1e12)); }

TEST_F(RosRunning, AVelocityThatTheAxisRefusesKeepsNoRunAlive) { expect_stop(velocities(1e5)); }

TEST_F(RosRunning, PositionsOfItsOwnNodeThatAreNotWhereItIsEndTheRunAtOnce) {
  const double hold = position() - 10;
  stream(sample({hold}), 1s);
  EXPECT_FALSE(rig.turns());
  EXPECT_TRUE(enabled()) << "halted, and no more than that";
  stream(sample({hold}), 3s);
  EXPECT_FALSE(rig.turns());
  stream(velocities(3), 1s);
  EXPECT_FALSE(rig.turns()) << "it was not 0 since";
}

TEST_F(RosRunning, AnEnableThatChangesNothingLeavesTheStreamInStep) {
  act(RosAction::enable);
  EXPECT_TRUE(stream_until(velocities(-3), [&] { return std::fabs(rig.state().velocity + 3) < 0.1; }));
}

TEST_F(RosRunning, AnActionThatChangesNothingOrIsRefusedKeepsNoRunAlive) {
  const Instant silent = rig.now();
  for (; !stopped() && rig.now() < silent + 5s; rig.run(100ms))
    for (const RosAction action : {RosAction::enable, RosAction::fault_reset, RosAction::home}) act(action);
  EXPECT_LE(rig.now() - silent, 2200ms);
}

// The stream goes on while the drive's zero moves: what it asks for is the place of before, and counts from another
// zero.
struct RosWithoutLease : Ros {
  RosWithoutLease() : Ros({.lease = {.on = false}}) {}
};

TEST_F(RosWithoutLease, AStreamThatGoesOnOverAHomingMovesNothing) {
  constexpr std::int16_t kHere = 35;  // CiA 402: the present position is the home
  dds::CommandRecord method = command(guid(7), 0, 1, kServo);
  method.mask = dds::kHasHomingMethod;
  method.homing_method = kHere;
  ASSERT_EQ(rig.ask(method).result, kDone);
  for (const bool by_another : {false, true})
    for (int phase = 0; phase < 12; ++phase) {
      SCOPED_TRACE(std::to_string(phase) + (by_another ? ", by another" : ""));
      control();
      const double away = position() + 12;
      ASSERT_TRUE(reaches(away));
      stream(sample({away}), 500ms);
      rig.run(phase * 1ms);
      if (by_another)
        rig.send(command(guid(7), static_cast<std::uint8_t>(Command::set_position), 0, kServo));
      else
        act(RosAction::home);
      stream(sample({away}), 3s);
      EXPECT_LT(std::fabs(position()), kNear);
      EXPECT_FALSE(rig.turns());
    }
}

// Contract: starts are refused, and running motions keep their leases.
struct RosNamesake : RosRunning {
  void take_name(bool gone = false) { rig.give(dds::NamesakeRecord{guid(9), kServo, "192.168.1.8", gone}); }
};

TEST_F(RosNamesake, ARunThatIsOnIsChangedAndStoppedByItsStream) {
  take_name();
  EXPECT_TRUE(stream_until(velocities(-3), [&] { return std::fabs(rig.state().velocity + 3) < 0.1; }));
  stream(velocities(-3), 3s);
  EXPECT_FALSE(stopped()) << "it keeps its lease";
  stream(velocities(0), 1s);
  EXPECT_FALSE(rig.turns());
}

TEST_F(RosNamesake, AnothersZeroStopsARun) {
  take_name();
  stream(velocities_of(2, 0), 1s);
  EXPECT_FALSE(rig.turns());
}

TEST_F(RosNamesake, NothingStartsWhileItIsTakenNorByItself) {
  act(RosAction::disable);
  ASSERT_TRUE(rig.run_until([&] { return !enabled(); }));
  control();
  take_name();
  const double before = position();
  stream(sample({before}), 100ms);
  stream(sample({before + 1}), 500ms);
  stream(velocities(0), 100ms);
  stream(velocities(3), 500ms);
  stream(sample({before + 1}), 500ms);
  take_name(true);
  stream(sample({before + 1}), 500ms);
  EXPECT_NEAR(position(), before, 1e-3);
  stream(sample({position()}), 100ms);
  EXPECT_TRUE(reaches(before + 1));
}

TEST_F(RosNamesake, APositionEndsARunAndStartsNoMove) {
  take_name();
  EXPECT_TRUE(rig.turns());
  for (int i = 0; i < 100; ++i) stream(sample({position()}), kPeriod);
  EXPECT_FALSE(rig.turns());
}

}  // namespace
}  // namespace axisgate::test
