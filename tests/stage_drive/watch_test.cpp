// SPDX-License-Identifier: Apache-2.0
// The watch on a stage: a drive that moves by itself, one that heeds no stop, one whose velocity does not fit its
// position; and what is done about them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

// 60FFh, as each counts: fast enough to be seen.
constexpr std::int64_t kKincoSpeed = 500'000, kLeadshineSpeed = 20'000;

/// As somebody at its keypad would, or another master: torque, speed mode, some speed.
void moves_by_itself(DriveRig& rig) {
  const auto set = [&](std::uint16_t index, std::int64_t value) {
    if (rig.subject() == Subject::leadshine)
      static_cast<void>(rig.stage.leadshine(0).poke({index, 0}, value));
    else
      static_cast<void>(rig.stage.drive(0).poke({index, 0}, value));
  };
  set(0x6060, 3);
  for (const std::int64_t word : {0x06, 0x07, 0x0F}) set(0x6040, word);
  set(0x60FF, rig.subject() == Subject::leadshine ? kLeadshineSpeed : kKincoSpeed);
}

GatewayStage::Line watched(Subject subject, model::WatchRules watch, std::optional<LeaseRules> lease = {}) {
  GatewayStage::Line line = line_with(subject, std::move(lease));
  for (auto& each : line.drives) each.axis.watch = watch;
  for (auto& each : line.rtu_drives) each.axis.watch = watch;
  for (auto& each : line.can_drives) each.axis.watch = watch;
  for (auto& each : line.keya_drives) each.axis.watch = watch;
  return line;
}

bool unexpected(DriveRig& rig) { return (rig.axis().alarms & bit(AxisAlarm::unexpected_motion)) != 0; }
bool disagree(DriveRig& rig) { return (rig.axis().alarms & bit(AxisAlarm::units_disagree)) != 0; }

class Unexpected : public testing::TestWithParam<Subject> {};

TEST_P(Unexpected, MotionAfterAStartHasEndedIsToldAndTheNextEnableClearsIt) {
  DriveRig rig(GetParam());
  rig.bring_to(Situation::enabled);
  ASSERT_EQ(rig.ask(with_command(Command::move_absolute, {{Quantity::target_position, 20'000}})).outcome.code,
            Errc::ok);
  rig.stage.run(10s);
  ASSERT_FALSE(unexpected(rig));
  moves_by_itself(rig);
  ASSERT_TRUE(rig.stage.run_until([&] { return unexpected(rig); }, 6s));
  EXPECT_TRUE(rig.told("turns from 2.00, expected standstill since what the gateway has asked for ended"));
  rig.stage.run(20s);
  EXPECT_TRUE(rig.turns()) << "alarm alone";
  EXPECT_EQ(rig.times_told("unexpected_motion: "), 1U) << "what goes on is no news";
  ASSERT_EQ(rig.command(Command::fault_reset).outcome.code, Errc::ok);
  EXPECT_FALSE(unexpected(rig));
}

TEST_P(Unexpected, MotionAfterAStopHasThatStopOnceMore) {
  DriveRig rig(GetParam());
  rig.bring_to(Situation::enabled);
  ASSERT_EQ(rig.ask(rig.motion()).outcome.code, Errc::ok);
  rig.stage.run(1s);
  ASSERT_EQ(rig.command(Command::quick_stop).outcome.code, Errc::ok);
  rig.stage.run(10s);
  ASSERT_FALSE(unexpected(rig));
  moves_by_itself(rig);
  ASSERT_TRUE(rig.stage.run_until([&] { return unexpected(rig); }, 6s));
  EXPECT_TRUE(rig.told("expected standstill since the quick_stop of the gateway: quick_stop"));
  rig.stage.run(3s);
  EXPECT_FALSE(rig.turns());
  EXPECT_TRUE(unexpected(rig)) << "until somebody looks";
  ASSERT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
  EXPECT_FALSE(unexpected(rig));
}

TEST_P(Unexpected, TorqueAfterADisableIsTakenAwayOnceMore) {
  DriveRig rig(GetParam());
  rig.bring_to(Situation::enabled);
  ASSERT_EQ(rig.command(Command::disable).outcome.code, Errc::ok);
  rig.stage.run(10s);
  moves_by_itself(rig);
  ASSERT_TRUE(rig.stage.run_until([&] { return unexpected(rig); }, 6s));
  EXPECT_TRUE(rig.told("expected no torque since the disable of the gateway: disable"));
  rig.stage.run(3s);
  EXPECT_FALSE(rig.powered());
}

// Its state shows the stop, and it turns on. Of no use it is asked for once more; the torque is taken away only where
// the configuration does so when nobody is there.
TEST_P(Unexpected, MotionThroughAStopEndsWithoutTorqueWhereTheConfigurationDoesSo) {
  for (const LeaseAction action : {LeaseAction::quick_stop, LeaseAction::disable}) {
    LeaseRules lease;
    lease.on_expiry = action;
    DriveRig rig(GetParam(), watched(GetParam(), {}, lease));
    rig.bring_to(Situation::enabled);
    ASSERT_EQ(rig.ask(rig.motion()).outcome.code, Errc::ok);
    rig.stage.run(1s);
    ignore_quick_stop(rig.stage, GetParam(), true);
    EXPECT_EQ(rig.command(Command::quick_stop).outcome.code, Errc::not_reached);
    ASSERT_TRUE(rig.stage.run_until([&] { return unexpected(rig); }, 6s));
    rig.stage.run(10s);
    EXPECT_EQ(rig.told(": disable"), action == LeaseAction::disable);
    EXPECT_EQ(rig.turns(), action != LeaseAction::disable);
  }
}

TEST_P(Unexpected, MotionIsStoppedOrLeftAsTheConfigurationSays) {
  for (const auto reaction : {model::WatchReaction::stop, model::WatchReaction::off}) {
    model::WatchRules rules;
    rules.reaction = reaction;
    DriveRig rig(GetParam(), watched(GetParam(), rules));
    rig.bring_to(Situation::enabled);
    rig.stage.run(5s);
    moves_by_itself(rig);
    rig.stage.run(8s);
    const bool stops = reaction == model::WatchReaction::stop;
    EXPECT_EQ(unexpected(rig), stops);
    EXPECT_EQ(rig.turns(), !stops);
    EXPECT_EQ(rig.told("unexpected_motion: "), stops);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Unexpected, testing::ValuesIn(subjects(is_cia402)), named);

// --- A velocity that does not fit the position
// ------------------------------------------------------------------------

GatewayStage::Line of_unlike_velocity(bool watched_units = true) {
  model::WatchRules rules;
  rules.units = watched_units;
  GatewayStage::Line line = watched(Subject::leadshine, rules);
  line.can_drives.front().profile = "tests/stage/unlike-velocity.json";
  return line;
}

WriteBatch run_at(std::int64_t velocity) {
  return with_command(Command::run_velocity, {{Quantity::target_velocity, velocity}});
}

WriteBatch jog_velocity(std::uint32_t velocity) {
  WriteBatch batch;
  batch.jog_velocity = velocity;
  return batch;
}

TEST(UnitsDisagree, RefusesEachStartUntilAFaultReset) {
  DriveRig rig(Subject::leadshine, of_unlike_velocity());
  rig.bring_to(Situation::enabled);
  ASSERT_EQ(rig.ask(run_at(30'000)).outcome.code, Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return disagree(rig); }, 30s));
  EXPECT_TRUE(rig.told("units_disagree: velocity_actual shows 30.0 rpm, and position_actual changes by 300"));
  EXPECT_TRUE(rig.turns()) << "the motion under way goes on";
  EXPECT_EQ(rig.write(Quantity::target_velocity, 20'000).outcome.code, Errc::ok) << "and is led";
  const Outcome refused = rig.ask(run_at(10'000)).outcome;
  EXPECT_EQ(refused.code, Errc::state_unsuitable) << "exception 0x04, result 9";
  EXPECT_EQ(rig.command(Command::halt).outcome.code, Errc::ok);
  EXPECT_EQ(rig.ask(with_command(Command::move_absolute, {{Quantity::target_position, 0}})).outcome.code,
            Errc::state_unsuitable);
  ASSERT_EQ(rig.ask(jog_velocity(10'000)).outcome.code, Errc::ok);
  EXPECT_EQ(rig.command(Command::jog_forward).outcome.code, Errc::state_unsuitable);
  EXPECT_EQ(rig.command(Command::disable).outcome.code, Errc::ok);
  EXPECT_EQ(rig.command(Command::enable).outcome.code, Errc::ok) << "which moves nothing";
  EXPECT_TRUE(disagree(rig));
  EXPECT_EQ(rig.command(Command::fault_reset).outcome.code, Errc::ok);
  EXPECT_FALSE(disagree(rig));
  EXPECT_EQ(rig.ask(run_at(30'000)).outcome.code, Errc::ok);
  EXPECT_TRUE(rig.stage.run_until([&] { return disagree(rig); }, 30s)) << "its cause is there still";
}

TEST(UnitsDisagree, IsNotLookedForWhereItIsOff) {
  DriveRig rig(Subject::leadshine, of_unlike_velocity(false));
  rig.bring_to(Situation::enabled);
  ASSERT_EQ(rig.ask(run_at(30'000)).outcome.code, Errc::ok);
  rig.stage.run(20s);
  EXPECT_FALSE(disagree(rig));
}

// Its motor is held just short of where its move ends.
TEST(UnreachedTarget, IsToldOnce) {
  DriveRig rig(Subject::jd_serial);
  rig.bring_to(Situation::enabled);
  ASSERT_EQ(rig.ask(with_command(Command::move_absolute,
                                 {{Quantity::target_position, 20'000}, {Quantity::profile_velocity, 20'000}}))
                .outcome.code,
            Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.position() > 19'300; }));
  rig.stage.drive(0).jam(true);
  rig.stage.run(4s);
  EXPECT_FALSE(rig.told("does not say that it is there"));
  rig.stage.run(20s);
  EXPECT_EQ(rig.times_told("does not say that it is there"), 1U);
  EXPECT_FALSE(unexpected(rig));
}

// --- A life in which nothing is unexpected
// ----------------------------------------------------------------------------

class NormalLife : public testing::TestWithParam<Subject> {
 protected:
  void nothing_is_said() {
    EXPECT_FALSE(unexpected(rig_));
    EXPECT_FALSE(disagree(rig_));
    for (const std::string& line : rig_.stage.log())
      if (line.find("unexpected_motion") != line.npos || line.find("units_disagree") != line.npos)
        ADD_FAILURE() << line;
  }
  void asks(const WriteBatch& batch) {
    static_cast<void>(rig_.ask(batch));  // not every drive has all
  }
  DriveRig rig_{GetParam(), watched(GetParam(), {.reaction = model::WatchReaction::stop})};
};

TEST_P(NormalLife, OfMovesRunsStopsAndHomings) {
  rig_.bring_to(Situation::enabled);
  const WriteBatch motion = rig_.motion();
  for (const Duration pause : {0ms, 370ms, 1300ms, 4000ms}) {
    SCOPED_TRACE(pause / 1ms);
    for (const std::int64_t target : {15'000, -4'000, 40'000}) {
      asks(with_command(Command::move_absolute, {{Quantity::target_position, target}}));
      rig_.stage.run(pause);
    }
    rig_.stage.run(3s);
    for (const Command stop : {Command::halt, Command::quick_stop, Command::disable}) {
      asks(motion);
      rig_.stage.run(1500ms);
      asks(with_command(stop));
      rig_.stage.run(pause);
      asks(with_command(Command::enable));
      rig_.stage.run(pause);
    }
    asks(with_command(Command::home, {{Quantity::homing_method, has_homing(GetParam()) ? 35 : 0}}));
    rig_.stage.run(pause);
    asks(with_command(Command::halt));
    rig_.stage.run(pause);
    WriteBatch set = with_command(Command::set_position);
    set.set_position_value = 77'000;
    asks(set);
    rig_.stage.run(2s + pause);
  }
  asks(motion);
  rig_.stage.run(20s);
  nothing_is_said();
}

// What the drive was found doing, what was done while nobody saw it, and what a fault has made of it.
TEST_P(NormalLife, OfGapsRestartsAndFaults) {
  rig_.bring_to(Situation::running);
  rig_.silence_the_drive();
  rig_.stage.run(600ms);
  rig_.mend();
  rig_.stage.run(5s);
  rig_.unplug();
  rig_.stage.run(4s);
  rig_.mend();
  rig_.stage.run(8s);
  asks(rig_.motion());
  rig_.stage.run(2s);
  rig_.stage.crash();
  rig_.stage.run(500ms);
  rig_.stage.start();
  rig_.stage.run(12s);
  asks(with_command(Command::halt));
  rig_.stage.run(6s);
  rig_.restart_the_drive();
  rig_.stage.run(8s);
  asks(with_command(Command::enable));
  asks(rig_.motion());
  rig_.stage.run(2s);
  rig_.fail_the_drive();
  rig_.stage.run(3s);
  asks(with_command(Command::fault_reset));
  asks(with_command(Command::enable));
  rig_.stage.run(5s);
  nothing_is_said();
}

INSTANTIATE_TEST_SUITE_P(All, NormalLife, testing::ValuesIn(kSubjects), named);

// What it tells is what its own generator has reached.
TEST(Watch, SaysNothingOfAnAxisWhosePositionIsOnlyCommanded) {
  DriveRig rig(Subject::id286pro);
  rig.bring_to(Situation::enabled);
  rig.stage.run(5s);
  static_cast<void>(rig.stage.id286pro(0).poke(323, 3));
  rig.stage.run(10s);
  EXPECT_FALSE(unexpected(rig));
}

}  // namespace
}  // namespace axisgate::test
