// SPDX-License-Identifier: Apache-2.0
// The motion rules alone, beside design 3.4: no drive, no wire, only samples and instants.
#include <gmock/gmock.h>

#include "gateway/drive/motion/motion.hpp"
#include "gateway/image/axis_record.hpp"
#include "tests/unit/drive/alone.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;
constexpr Duration kHomingTimeout = 60s;

struct Stage {
  AxisRecord record;
  Motion motion{std::chrono::milliseconds(300), record};
  AxisFacts facts;
  Stage() {
    facts.at = kStart;
    facts.reachable = true;
    facts.state = model::State402::operation_enabled;
    facts.mode = 1;
    facts.statusword_exchange = 10;
    see();
  }
  void see(Duration later = 1ms) {
    facts.at += later;
    ++facts.statusword_exchange;
    motion.observe(facts, kHomingTimeout);
  }
  void start(MotionKind kind) { motion.start(kind, 5, facts.at, facts.statusword_exchange); }
};

TEST(MotionRules, AMoveEndsWhenTheDriveSaysSoAfterItsStart) {
  Stage s;
  s.facts.target_reached = true;
  s.start(MotionKind::discrete);
  s.motion.observe(s.facts, kHomingTimeout);
  EXPECT_EQ(s.motion.state(), MotionState::active) << "that was the move before";
  s.facts.target_reached = false;
  s.see();
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::discrete_motion);
  s.facts.target_reached = true;
  s.see();
  EXPECT_EQ(s.motion.state(), MotionState::completed);
  EXPECT_EQ(s.motion.id(), 5);
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::standstill);
}

TEST(MotionRules, WhereNothingAcknowledgesASetPointReachedMustFallFirst) {
  Stage s;
  s.facts.acknowledges = false;
  s.facts.target_reached = s.facts.moving = true;
  s.see();
  s.start(MotionKind::discrete);
  s.see();
  EXPECT_EQ(s.motion.state(), MotionState::active) << "that was the move before";
  EXPECT_TRUE(s.motion.target_reached_masked());
  s.facts.target_reached = false;
  s.see();
  s.facts.target_reached = true;
  s.see();
  EXPECT_EQ(s.motion.state(), MotionState::completed);
}

TEST(MotionRules, EverythingThatEndsAMotionForGoodEndsItForGood) {
  const std::vector<std::pair<std::function<void(Stage&)>, MotionState>> ends{
      {[](Stage& s) { s.motion.stop(false, s.facts.at); }, MotionState::aborted},
      {[](Stage& s) { s.facts.state = model::State402::fault, s.see(); }, MotionState::failed},
      {[](Stage& s) { s.facts.state = model::State402::switch_on_disabled, s.see(); }, MotionState::failed},
      {[](Stage& s) { s.facts.reachable = false, s.see(); }, MotionState::failed}};
  for (const MotionKind kind : {MotionKind::discrete, MotionKind::velocity, MotionKind::torque, MotionKind::homing}) {
    for (const auto& [end, how] : ends) {
      Stage s;
      s.start(kind);
      s.see();
      const auto asked = s.record.now();
      end(s);
      EXPECT_EQ(s.motion.running(), MotionKind::none);
      EXPECT_EQ(s.motion.state(), how);
      EXPECT_TRUE(s.record.void_since(asked)) << "velocity and torque are needed again";
    }
  }
}

TEST(MotionRules, AReplacedMotionIsNotEndedForGood) {
  Stage s;
  const auto asked = s.record.now();
  s.start(MotionKind::velocity);
  s.start(MotionKind::discrete);
  EXPECT_FALSE(s.record.void_since(asked));
}

TEST(MotionRules, AChangeOfTheModeEndsWhatRanInTheModeBefore) {
  Stage s;
  s.start(MotionKind::velocity);
  s.motion.mode_changed();
  s.see();
  EXPECT_EQ(s.motion.state(), MotionState::aborted);
  EXPECT_NE(s.motion.axis_state(s.facts), AxisState::standstill) << "the velocity may be of before the start";
  s.see(300ms);
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::standstill);
  EXPECT_FALSE(s.motion.target_acts_now(Quantity::target_velocity, s.facts, false));
}

TEST(MotionRules, TargetsWrittenWhileDisabledAreKeptForTheStart) {
  Stage s;
  s.facts.state = model::State402::switch_on_disabled;
  s.see();
  const auto asked = s.record.now();
  for (int i = 0; i < 5; ++i) s.see();
  s.facts.state = model::State402::operation_enabled;
  s.see();
  ASSERT_FALSE(s.record.void_since(asked));
  s.facts.state = model::State402::switch_on_disabled;
  s.see();
  EXPECT_TRUE(s.record.void_since(asked)) << "a disable came after";
}

TEST(MotionRules, WhatMayReachTheDriveNow) {
  Stage s;
  const auto acts = [&](Quantity q, bool held_back = false) { return s.motion.target_acts_now(q, s.facts, held_back); };
  EXPECT_TRUE(acts(Quantity::target_position));
  EXPECT_FALSE(acts(Quantity::target_position, true));
  EXPECT_FALSE(acts(Quantity::target_velocity));
  EXPECT_FALSE(acts(Quantity::target_torque));
  s.start(MotionKind::velocity);
  EXPECT_TRUE(acts(Quantity::target_velocity));
  EXPECT_FALSE(acts(Quantity::target_torque));
  s.start(MotionKind::discrete);
  EXPECT_FALSE(acts(Quantity::target_position));
  EXPECT_FALSE(acts(Quantity::target_velocity));
  s.motion.stop(false, s.facts.at);
  s.facts.mode = 3;
  s.motion.run_raw();
  EXPECT_TRUE(acts(Quantity::target_velocity) && acts(Quantity::target_torque));
  s.facts.mode = 8;
  EXPECT_TRUE(acts(Quantity::target_position, true)) << "the demand of every cycle";
  s.motion.stop(true, s.facts.at);
  for (const Quantity q : {Quantity::target_position, Quantity::target_velocity, Quantity::target_torque})
    EXPECT_FALSE(acts(q));
  EXPECT_TRUE(acts(Quantity::profile_velocity)) << "a parameter moves nothing";
}

TEST(MotionRules, WhatIsFoundRunningFollowsTheTargetOfItsModeUntilAnythingEndsIt) {
  constexpr Quantity kVelocity = Quantity::target_velocity, kTorque = Quantity::target_torque;
  const auto found = [](int mode) {
    Stage s;
    s.facts.reachable = false;
    s.see();
    s.facts.reachable = true;
    s.facts.mode = mode;
    s.facts.follows = true;
    s.see();
    return s;
  };
  const auto acts = [](Stage& s, Quantity target) { return s.motion.target_acts_now(target, s.facts, false); };
  for (const int mode : {3, 9}) {
    Stage s = found(mode);
    EXPECT_TRUE(acts(s, kVelocity)) << mode;
    EXPECT_FALSE(acts(s, kTorque)) << mode;
  }
  Stage own = found(-3);
  EXPECT_FALSE(acts(own, kVelocity)) << "what a drive's own mode does is not known";
  own.facts.own_velocity_mode = true;
  EXPECT_TRUE(acts(own, kVelocity)) << "but by its profile";
  EXPECT_FALSE(acts(own, kTorque));
  for (const int mode : {4, 10}) {
    Stage s = found(mode);
    EXPECT_TRUE(acts(s, kTorque)) << mode;
    EXPECT_FALSE(acts(s, kVelocity)) << mode;
  }
  Stage moves = found(1);
  EXPECT_FALSE(acts(moves, kVelocity));
  Stage stands = found(3);
  stands.facts.follows = false;
  EXPECT_FALSE(acts(stands, kVelocity));
  Stage halted = found(3);
  halted.motion.stop(false, halted.facts.at);
  halted.see();
  EXPECT_FALSE(acts(halted, kVelocity));
  Stage changed = found(3);
  changed.motion.mode_changed();
  EXPECT_FALSE(acts(changed, kVelocity));
  Stage enabled;
  enabled.facts.state = model::State402::switched_on;
  enabled.see();
  enabled.facts.state = model::State402::operation_enabled;
  enabled.facts.mode = 3;
  enabled.facts.follows = true;
  enabled.see();
  EXPECT_FALSE(acts(enabled, kVelocity)) << "it was in sight all the time";
}

TEST(MotionRules, TheLatchIsLeftByTheTwoStepsInTheirOrder) {
  Stage s;
  s.motion.stop(true, s.facts.at);
  EXPECT_FALSE(s.motion.may_start(s.facts));
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::stopping);
  EXPECT_FALSE(s.motion.passes(model::Request402::enable_operation));
  EXPECT_FALSE(s.motion.passes(model::Request402::other));
  s.motion.passed(model::Request402::enable_operation);
  EXPECT_TRUE(s.motion.latched());
  s.motion.passed(model::Request402::quick_stop);
  EXPECT_FALSE(s.motion.passes(model::Request402::enable_operation));
  s.motion.passed(model::Request402::shutdown);
  EXPECT_TRUE(s.motion.passes(model::Request402::enable_operation));
  s.motion.stop(true, s.facts.at);
  EXPECT_FALSE(s.motion.passes(model::Request402::enable_operation)) << "another stop came between";
  s.motion.passed(model::Request402::switch_on);
  s.motion.passed(model::Request402::enable_operation);
  EXPECT_FALSE(s.motion.latched());
}

TEST(MotionRules, HomingEndsByReferenceByErrorOrByTime) {
  Stage s;
  s.facts.mode = 6;
  s.facts.reference = true;
  s.start(MotionKind::homing);
  s.see();
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::homing) << "the bit may be that of the homing before";
  s.facts.moving = true;
  s.see(600ms);
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::homing) << "it still moves";
  s.facts.moving = false;
  s.see();
  EXPECT_EQ(s.motion.state(), MotionState::completed);
  s.start(MotionKind::homing);
  s.facts.reference = false;
  s.facts.homing_failed = true;
  s.see();
  EXPECT_EQ(s.motion.state(), MotionState::failed);
  EXPECT_FALSE(s.motion.take_homing_timeout());
  s.facts.homing_failed = false;
  s.start(MotionKind::homing);
  s.see();
  EXPECT_LE(s.motion.deadline(), s.facts.at + kHomingTimeout);
  s.see(kHomingTimeout);
  EXPECT_EQ(s.motion.state(), MotionState::failed);
  EXPECT_TRUE(s.motion.take_homing_timeout());
  EXPECT_FALSE(s.motion.take_homing_timeout()) << "once";
}

TEST(MotionRules, StandstillIsWhatTheDriveSaysBeforeTheSampledVelocityDoes) {
  Stage s;
  s.start(MotionKind::discrete);
  s.facts.moving = true;
  s.see(1s);
  EXPECT_FALSE(s.motion.at_rest(s.facts));
  s.facts.target_reached = true;
  s.see();
  EXPECT_TRUE(s.motion.at_rest(s.facts)) << "mode 1: target reached";
  s.facts.mode = 3;
  s.facts.moving = false;
  s.start(MotionKind::velocity);
  s.motion.stop(false, s.facts.at);
  s.see();
  EXPECT_FALSE(s.motion.at_rest(s.facts)) << "a velocity sampled each 200 ms may be of before the start";
  s.see(300ms);
  EXPECT_TRUE(s.motion.at_rest(s.facts));
}

TEST(MotionRules, WhatHasArrivedStandsWhateverOldVelocityIsShown) {
  Stage s;
  s.facts.mode = 6;
  s.start(MotionKind::homing);
  s.see(1s);
  s.facts.reference = true;
  s.see();
  ASSERT_EQ(s.motion.state(), MotionState::completed);
  s.facts.moving = true;
  s.see();
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::standstill);
  s.see(300ms);
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::homing);
}

// Two commands are told in another order than they were accepted in: whoever looks sees the later one.
TEST(MotionRules, TheLaterOfTwoCommandsCountsWhicheverIsToldFirst) {
  constexpr ClientId kOne = 1, kTwo = 2, kThird = 3;
  AxisRecord record;
  const auto first = record.accepted(), between = record.accepted(), second = record.accepted();
  record.commanded(kTwo, second);
  record.commanded(kOne, first);
  EXPECT_TRUE(record.ended(between, kThird));
  EXPECT_FALSE(record.ended(between, kTwo));
}

TEST(MotionRules, AStopOfWhatStandsLeavesItStanding) {
  Stage s;
  s.motion.stop(false, s.facts.at);
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::standstill);
  s.motion.mask_target_reached();
  s.motion.stop(false, s.facts.at);
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::stopping) << "a start may have reached the drive";
  s.motion.mask_target_reached(false);
  s.see(300ms);
  s.facts.follows = true;
  s.see();
  s.motion.stop(false, s.facts.at);
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::stopping) << "its velocity is sampled late";
}

TEST(MotionRules, AnAxisThatMovesWithoutAStartOfOursIsNotSaidToStand) {
  Stage s;
  s.facts.moving = true;
  s.see();
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::discrete_motion);
  s.facts.mode = 3;
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::continuous_motion);
  s.motion.stop(false, s.facts.at);
  s.see();
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::stopping);
  s.facts.state = model::State402::switch_on_disabled;
  s.see();
  EXPECT_EQ(s.motion.axis_state(s.facts), AxisState::disabled);
}

}  // namespace
}  // namespace axisgate::drive
