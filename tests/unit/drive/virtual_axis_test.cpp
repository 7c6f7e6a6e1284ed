// SPDX-License-Identifier: Apache-2.0
// The built-in CiA 402 machine alone: states by controlword, and how a motion's end is worked out.
#include <gmock/gmock.h>

#include "gateway/drive/motion/virtual_axis.hpp"
#include "tests/unit/drive/alone.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;
using Seen = VirtualAxis::Seen;

class Machine {
 public:
  Machine() {
    facts_.gate_only = true;
    facts_.within = 10;
    seen.at = kStart;
    seen.enabled = true;
    seen.mode = 1;
    look();
  }
  void look() {
    ++seen.exchange;
    axis.observe(seen, facts_);
  }
  /// The position is read after the state that was shown last.
  void read_position(std::int64_t position) {
    seen.position = position;
    seen.position_exchange = ++seen.exchange;
    axis.observe(seen, facts_);
  }
  void control(std::uint16_t word) {
    seen.controlword = word;
    axis.control(word, facts_);
  }
  void enable() {
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{6, 7, 15}) control(word);
    look();
  }
  void start(MotionKind kind, std::optional<std::int64_t> goal) {
    seen.running = kind;
    axis.started(kind, goal, seen.at, seen.exchange);
  }
  void show(bool moving) {
    seen.moving = moving;
    seen.standing = !moving;
    look();
  }
  [[nodiscard]] std::uint16_t word() const { return axis.statusword(seen); }
  [[nodiscard]] bool reached() const { return (word() & model::statusword::kTargetReached) != 0; }

  VirtualAxis axis;
  Seen seen;
  model::VirtualProperties facts_;
};

TEST(VirtualAxis, GoesThroughTheStatesOfTheStandardByControlword) {
  Machine m;
  EXPECT_EQ(m.word(), 0x40) << "switch on disabled";
  m.control(15);
  EXPECT_EQ(m.word(), 0x40) << "not without the steps before it";
  m.control(6);
  EXPECT_EQ(m.word(), 0x21);
  m.control(7);
  EXPECT_EQ(m.word(), 0x23);
  m.control(15);
  EXPECT_EQ(m.word(), 0x27);
  m.control(7);
  EXPECT_EQ(m.word(), 0x23) << "disabled, though the drive holds torque";
  EXPECT_TRUE(m.axis.cannot_deenergise(m.seen, m.facts_));
  m.control(15);
  EXPECT_FALSE(m.axis.cannot_deenergise(m.seen, m.facts_));
  m.control(2);
  EXPECT_EQ(m.word(), 0x07) << "quick stop active: it stands energised";
  m.control(15);
  EXPECT_EQ(m.word(), 0x27);
  m.control(0);
  EXPECT_EQ(m.word(), 0x40);
}

TEST(VirtualAxis, NothingIsEnabledThatTheDriveDoesNotEnable) {
  Machine m;
  m.enable();
  m.seen.enabled = false;
  m.look();
  EXPECT_EQ(m.word(), 0x40);
  m.seen.enabled = true;
  m.look();
  EXPECT_EQ(m.word(), 0x40) << "the drive's own return is no enable";
}

TEST(VirtualAxis, AFaultClosesTheGateForGood) {
  Machine m;
  m.enable();
  m.seen.fault = true;
  m.look();
  EXPECT_EQ(m.word(), 0x08);
  m.seen.fault = false;
  m.look();
  EXPECT_EQ(m.word(), 0x40);
}

TEST(VirtualAxis, FoundMovingAtTheFirstLookItIsShownEnabledAndOnlyThen) {
  Machine still;
  still.show(true);
  EXPECT_EQ(still.word(), 0x40) << "somebody else moved it later: the gate is closed";
  VirtualAxis found;
  Seen seen;
  seen.at = kStart;
  seen.enabled = seen.moving = true;
  found.observe(seen, {});
  EXPECT_EQ(found.statusword(seen) & 0x6F, 0x27);
}

TEST(VirtualAxis, ATargetIsReachedWhenItHasMovedStandsAndThePositionSaysSo) {
  Machine m;
  m.enable();
  m.start(MotionKind::discrete, 1000);
  m.show(false);
  m.read_position(0);
  EXPECT_FALSE(m.reached()) << "it has not begun yet";
  m.show(true);
  m.read_position(500);
  EXPECT_FALSE(m.reached());
  m.show(false);
  EXPECT_FALSE(m.reached()) << "the position is from before it stood";
  m.read_position(1003);
  EXPECT_TRUE(m.reached());
  EXPECT_FALSE(m.axis.motion_failed());
}

TEST(VirtualAxis, AMotionThatEndsElsewhereHasFailed) {
  Machine m;
  m.enable();
  m.start(MotionKind::discrete, 1000);
  m.show(true);
  m.show(false);
  m.read_position(700);
  EXPECT_FALSE(m.axis.motion_failed()) << "it may be turning round";
  m.read_position(700);
  EXPECT_FALSE(m.reached());
  EXPECT_TRUE(m.axis.motion_failed()) << "a switch stopped it, or somebody else did";
}

TEST(VirtualAxis, AMoveThatTurnsRoundStandsForAnInstantAndHasNotFailed) {
  Machine m;
  m.enable();
  m.start(MotionKind::discrete, 1000);
  m.show(true);
  m.show(false);
  m.read_position(5000);
  m.show(true);
  m.read_position(4000);
  EXPECT_FALSE(m.axis.motion_failed());
  m.show(false);
  m.read_position(1000);
  EXPECT_TRUE(m.reached());
}

TEST(VirtualAxis, AMoveTooShortToBeSeenIsReachedAsSoonAsThePositionIsThere) {
  Machine m;
  m.enable();
  m.start(MotionKind::discrete, 1000);
  m.show(false);
  m.read_position(1000);
  EXPECT_TRUE(m.reached());
}

TEST(VirtualAxis, AMoveThatNeverBeginsFailsAfterItsTime) {
  Machine m;
  m.enable();
  m.start(MotionKind::discrete, 1000);
  m.show(false);
  m.read_position(0);
  m.seen.at += VirtualAxis::kStartShows;
  m.show(false);
  m.read_position(0);
  m.read_position(0);
  EXPECT_TRUE(m.axis.motion_failed());
}

TEST(VirtualAxis, WhatWasSampledBeforeTheStartTellsNothingOfIt) {
  Machine m;
  m.enable();
  m.show(false);
  m.read_position(1000);
  m.start(MotionKind::discrete, 1000);
  m.axis.observe(m.seen, m.facts_);
  EXPECT_FALSE(m.reached());
}

TEST(VirtualAxis, HomingIsAttainedOnlyWhereItsPositionSaysSo) {
  for (const bool there : {true, false}) {
    Machine m;
    m.seen.mode = 6;
    m.enable();
    m.start(MotionKind::homing, std::nullopt);
    m.show(true);
    m.show(false);
    EXPECT_FALSE(m.axis.homing_attained() || m.axis.homing_failed()) << "the position is not read yet";
    m.seen.homed_at = there;
    m.read_position(there ? 0 : 400);
    EXPECT_EQ(m.axis.homing_attained(), there);
    EXPECT_EQ(m.axis.homing_failed(), !there);
    EXPECT_EQ((m.word() & 0x1000) != 0, there) << "bit 12";
    EXPECT_EQ((m.word() & 0x2000) != 0, !there) << "bit 13";
  }
}

TEST(VirtualAxis, SetPointAcknowledgeFollowsBit4) {
  Machine m;
  m.enable();
  m.control(0x1F);
  m.start(MotionKind::discrete, 5);
  EXPECT_NE(m.word() & model::statusword::kSetpointAcknowledge, 0);
  m.control(0x0F);
  EXPECT_EQ(m.word() & model::statusword::kSetpointAcknowledge, 0);
}

TEST(VirtualAxis, AfterARestartNothingIsLeft) {
  Machine m;
  m.enable();
  m.start(MotionKind::homing, std::nullopt);
  m.axis.reset();
  m.look();
  EXPECT_EQ(m.word(), 0x40);
  EXPECT_FALSE(m.axis.homing_attained());
}

}  // namespace
}  // namespace axisgate::drive
