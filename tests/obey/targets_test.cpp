// SPDX-License-Identifier: Apache-2.0
// A start uses the set-point that was accepted last (3.3 What asks), whoever wrote it, by whichever way in, whatever
// the drive happens to hold.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class Targets : public testing::TestWithParam<Subject> {
 protected:
  Targets() { plant_.ready(); }
  /// 41..43.
  void block_with(Client& client, std::int64_t target) {
    ASSERT_EQ(client.rows(row::mode, 43, {{row::mode, 1}, {row::target_position, target}}), kOk);
  }
  /// As a panel without ids does it: 0 first.
  void press(Client& client, std::int64_t command) {
    ASSERT_EQ(client.command(0), kOk);
    ASSERT_EQ(client.command(command), kOk);
  }
  void move_to(Client& client, std::int64_t target) {
    ASSERT_EQ(client.row(row::target_position, target), kOk);
    press(client, kMove);
    ASSERT_TRUE(plant_.turns_within(1s));
    plant_.run(100ms);
  }
  void ends_at(std::int64_t target) {
    const std::int64_t at = plant_.comes_to_rest_at();
    EXPECT_LE(std::abs(at - target), kClose) << "it ends at " << at << " instead of " << target;
  }
  void enable_without_moving() {
    const std::int64_t before = plant_.position();
    press(a_, kEnable);
    plant_.run(300ms);
    EXPECT_LE(std::abs(plant_.position() - before), kClose)
        << "it moved from " << before << " to " << plant_.position();
  }
  Write whole_block(std::int64_t target, std::int64_t command, std::int64_t id) {
    Rows rows = plant_.profile_rows();
    rows[row::target_position] = target;
    rows[row::command] = command;
    rows[row::command_id] = id;
    return block(row::target_position, row::command_id, rows);
  }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
};

TEST_P(Targets, BesideTheNewerOfTwoStopsIsTheOneThatCounts) {
  const auto stop = [](std::int64_t target, std::int64_t command) {
    return block(row::target_position, row::command, {{row::target_position, target}, {row::command, command}});
  };
  ASSERT_EQ(a_.row(row::mode, 1), kOk);
  ASSERT_EQ(a_.command(0), kOk);
  ASSERT_EQ(b_.command(0), kOk);
  a_.begin(stop(kFar, kQuickStop));
  b_.begin(stop(kNear, kHalt));
  plant_.run(1s);
  press(a_, kEnable);
  press(a_, kMove);
  ends_at(kNear);
}

TEST_P(Targets, WrittenAndTakenBackWhileItMovesIsNotMovedTo) {
  move_to(a_, kFar);
  block_with(a_, kNear);
  block_with(a_, kFar);
  EXPECT_EQ(a_.wide(row::target_position), kFar);
  press(a_, kMove);
  ends_at(kFar);
}

TEST_P(Targets, WrittenAndTakenBackInSingleWritesIsNotMovedTo) {
  move_to(a_, kFar);
  ASSERT_EQ(a_.row(row::target_position, kNear), kOk);
  ASSERT_EQ(a_.row(row::target_position, kFar), kOk);
  press(a_, kMove);
  ends_at(kFar);
}

TEST_P(Targets, TakenBackInTheBlockThatStartsIsNotMovedTo) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  move_to(a_, kFar);
  block_with(a_, kNear);
  ASSERT_EQ(a_.write(whole_block(kFar, kMove, 2)), kOk);
  ends_at(kFar);
}

TEST_P(Targets, ChangedWhileItMovesIsMovedToByTheNextStart) {
  move_to(a_, kFar);
  block_with(a_, kNear);
  press(a_, kMove);
  ends_at(kNear);
}

TEST_P(Targets, OfAnotherClientTakenBackIsNotMovedTo) {
  move_to(a_, kFar);
  block_with(b_, kNear);
  ASSERT_EQ(a_.row(row::target_position, kFar), kOk);
  press(a_, kMove);
  ends_at(kFar);
}

TEST_P(Targets, OfAnotherClientIsMovedToWhereItWasWrittenLast) {
  move_to(a_, kFar);
  block_with(b_, kNear);
  press(a_, kMove);
  ends_at(kNear);
}

TEST_P(Targets, OfAnotherClientTakenBackInABlockThatStartsIsNotMovedTo) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  move_to(a_, kFar);
  block_with(b_, kNear);
  ASSERT_EQ(a_.write(whole_block(kFar, kMove, 2)), kOk);
  ends_at(kFar);
}

TEST_P(Targets, ChangedWhileStopLatchedAreUsedByTheNextStart) {
  move_to(a_, kFar);
  ASSERT_EQ(a_.command(kQuickStop), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  block_with(a_, kNear);
  block_with(a_, kAway);
  enable_without_moving();
  press(a_, kMove);
  ends_at(kAway);
}

TEST_P(Targets, TakenBackWhileStopLatchedAreNotMovedTo) {
  move_to(a_, kFar);
  ASSERT_EQ(a_.command(kQuickStop), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  block_with(a_, kNear);
  block_with(a_, kFar);
  press(a_, kEnable);
  press(a_, kMove);
  ends_at(kFar);
}

TEST_P(Targets, ChangedWhileDisabledAreUsedByTheNextStart) {
  move_to(a_, kFar);
  ASSERT_EQ(a_.command(kDisable), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  block_with(a_, kNear);
  block_with(a_, kAway);
  enable_without_moving();
  press(a_, kMove);
  ends_at(kAway);
}

TEST_P(Targets, ThatAreTheSameAreMovedToAgainAfterAHalt) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  for (std::int64_t id = 2; id < 8; id += 2) {
    ASSERT_EQ(a_.write(whole_block(kFar, kMove, id)), kOk);
    ASSERT_TRUE(plant_.turns_within(1s)) << id;
    plant_.run(100ms);
    ASSERT_EQ(a_.command(kHalt, id + 1), kOk);
    ASSERT_TRUE(plant_.comes_to_stand());
    ASSERT_LT(plant_.position(), kFar - kNear);
    // Where the drive has no halt, what takes its place may leave it latched.
    ASSERT_EQ(b_.command(kEnable), kOk);
    ASSERT_EQ(b_.command(0), kOk);
  }
  ASSERT_EQ(a_.command(kMove, 9), kOk);
  ends_at(kFar);
}

// Relative to a point that the axis is still leaving, a distance means nothing (3.4): some drives show bit 10 of a halt
// before they stand, and a velocity of before the move passes for rest.
using Ramps = Targets;

TEST_P(Ramps, OfAHaltAreAwaitedByARelativeMove) {
  ASSERT_EQ(a_.row(row::profile_deceleration, 3'000), kOk);  // 300 rpm/s
  for (const Duration pause : {5ms, 45ms, 120ms, 350ms}) {
    move_to(a_, kFar * 4);
    press(a_, kHalt);
    plant_.run(pause);
    ASSERT_EQ(a_.row(row::target_position, kNear), kOk);
    ASSERT_EQ(a_.command(0), kOk);
    ASSERT_GT(std::abs(plant_.velocity()), 60'000) << "it has slowed down before it was asked";
    const std::int64_t velocity = plant_.velocity();
    EXPECT_NE(a_.command(kRelative), kOk) << "at " << velocity << " mrpm";
    ASSERT_TRUE(plant_.comes_to_stand(10s));
    plant_.run(1s);
    press(a_, kEnable);  // a JD has left that state by its halt
    ASSERT_EQ(a_.row(row::target_position, 0), kOk);
    press(a_, kMove);
    plant_.comes_to_rest_at();
  }
}

class DriveObject : public Targets {};

/// A Keya's as well, whose object holds a speed or a torque in other modes.
std::optional<TargetObject> target_of(Subject subject) {
  if (subject == Subject::keya_canopen_position) return TargetObject{0x6081, 0};
  if (subject == Subject::keya_can_position) return TargetObject{0x2002, 1};
  return target_object(subject);
}

// A write of the object that a quantity uses is a write of that quantity: accepted last, it is what a start goes to.
// Who waits for the end of a move looks where the axis is, in the same reply: bit 10, input 5 and motion_state say
// nothing before the position does.
TEST_P(Targets, AreShownAsReachedTogetherWithThePosition) {
  constexpr std::uint16_t kTargetReached = 1U << 10, kDone = 2;
  const auto wide = [](const std::vector<std::uint16_t>& words) {
    return static_cast<std::int32_t>(std::uint32_t{words[shown::position]} << 16 | words[shown::position + 1]);
  };
  for (const std::int64_t target : {kFar, kNear, kAway, std::int64_t{0}}) {
    move_to(a_, target);
    int looks = 0;
    for (bool done = false; !done;) {
      plant_.run(1ms);
      const std::vector<std::uint16_t> words = a_.read(0, 40);
      done = words[shown::motion_state] == kDone;
      if (done || (words[shown::statusword] & kTargetReached) != 0) {
        ASSERT_LE(std::abs(wide(words) - target), kClose) << (done ? "motion_state" : "bit 10");
      }
      ASSERT_LT(++looks, 60'000);
    }
    EXPECT_LE(std::abs(plant_.position() - target), kClose);
  }
}

TEST_P(DriveObject, WrittenByTheMailboxIsASetPointLikeAnyOther) {
  const TargetObject object = *target_of(GetParam());
  ASSERT_EQ(a_.row(row::target_position, kNear), kOk);
  constexpr std::int64_t kCounts = 54'321;
  ASSERT_TRUE(b_.mailbox_write(object.index, object.subindex, 4, kCounts));
  // A Keya is sent it with the start alone, and no register tells it before; the row shows what the drive holds. Its
  // range of 10,000 is that of speeds in the same object.
  const std::int64_t shown = is_keya(GetParam()) ? kCounts : a_.wide(row::target_position);
  ASSERT_NE(shown, kNear);
  press(a_, kMove);
  ends_at(shown);
}

class Speeds : public testing::TestWithParam<Subject> {
 protected:
  Speeds() { plant_.ready(); }
  Plant plant_{GetParam()};
};

TEST_P(Speeds, ThatAreTheSameRunAgainInABlockWithANewId) {
  ASSERT_EQ(plant_.a.command(0, 1), kOk);
  Rows rows = plant_.profile_rows();
  rows[row::target_velocity] = kSpeed;
  for (std::int64_t id = 2; id < 8; id += 2) {
    SCOPED_TRACE(id);
    rows[row::command] = kRun;
    rows[row::command_id] = id;
    EXPECT_EQ(plant_.a.rows(row::target_velocity, row::command_id, rows), kOk);
    EXPECT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
    EXPECT_EQ(plant_.a.command(kHalt, id + 1), kOk);
    EXPECT_TRUE(plant_.comes_to_stand());
  }
}

// 3.4: after a stop "velocity, torque and start are needed anew"; G1: "a start whose target does not hold is refused
// (0x04, result 9, log: write the target anew)".
TEST_P(Speeds, AcceptedBeforeAHaltAreNeededAnew) {
  ASSERT_EQ(plant_.a.command(0, 1), kOk);
  ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(plant_.a.command(kRun, 2), kOk);
  ASSERT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
  ASSERT_EQ(plant_.a.command(kHalt, 3), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  EXPECT_EQ(plant_.a.command(kRun, 4), kFailed);
  EXPECT_EQ(plant_.a.result(), kNoState);
  EXPECT_TRUE(plant_.logged("write target_velocity anew"));
  plant_.run(500ms);
  EXPECT_TRUE(plant_.stands()) << plant_.velocity();
  EXPECT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  EXPECT_EQ(plant_.a.command(kRun, 5), kOk);
  EXPECT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
}

TEST_P(Speeds, WrittenAfterAHaltStartNothing) {
  ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(plant_.a.command(kRun), kOk);
  ASSERT_TRUE(plant_.reaches(kSpeed));
  ASSERT_EQ(plant_.a.command(kHalt), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  EXPECT_EQ(plant_.a.row(row::target_velocity, kOtherSpeed), kOk);
  plant_.run(500ms);
  EXPECT_TRUE(plant_.stands()) << plant_.velocity();
}

class Homing : public testing::TestWithParam<Subject> {};

TEST_P(Homing, MethodInABlockWithTheNumberThatTheDriveHoldsCountsAsWritten) {
  Plant plant(GetParam());
  plant.ready();
  // Kincos come with a number that means none.
  constexpr std::int64_t kOnTheSpot = 35;
  if (is_kinco(GetParam())) plant.stage.drive(0).poke({0x6098, 0}, kOnTheSpot);
  plant.run(3s);
  const auto held = static_cast<std::int16_t>(plant.a.word(row::homing_method));
  ASSERT_EQ(plant.a.rows(row::homing_method, 61, {{row::homing_method, held}}), kOk) << held;
  EXPECT_EQ(plant.a.command(kHome), kOk) << "method " << held;
}

// iD286pro: "homing from a motion is not described", and it is refused.
TEST(HomingOfTheStepper, ThatIsRefusedLeavesTheRunAsItWas) {
  Plant plant(Subject::id286pro);
  plant.ready();
  constexpr std::int64_t kHomeSwitch = 19;
  ASSERT_EQ(plant.a.row(row::homing_method, kHomeSwitch), kOk);
  ASSERT_EQ(plant.a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(plant.a.command(kRun), kOk);
  ASSERT_TRUE(plant.reaches(kSpeed));
  EXPECT_EQ(plant.a.command(kHome), kNotNow);
  EXPECT_EQ(plant.a.row(row::target_velocity, kOtherSpeed), kOk);
  EXPECT_TRUE(plant.reaches(kOtherSpeed)) << plant.velocity();
}

INSTANTIATE_TEST_SUITE_P(Every, Targets, testing::ValuesIn(subjects(has_positions)), named);
INSTANTIATE_TEST_SUITE_P(Every, Ramps, testing::ValuesIn(subjects([](Subject s) { return !is_keya(s); })), named);
INSTANTIATE_TEST_SUITE_P(Every, DriveObject,
                         testing::ValuesIn(subjects([](Subject s) { return target_of(s).has_value(); })), named);
INSTANTIATE_TEST_SUITE_P(Every, Speeds, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, Homing, testing::ValuesIn(subjects(has_homing)), named);

}  // namespace
}  // namespace axisgate::test::obey
