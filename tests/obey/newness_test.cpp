// SPDX-License-Identifier: Apache-2.0
// What is new (3.3 Edges) and what says that it is not (3.3 Not new): commands, their ids, and the set-points beside
// them.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kDone = 2;

class Newness : public testing::TestWithParam<Subject> {
 protected:
  Newness() { plant_.ready(); }
  /// An endless motion's target beside its command, in a block 42 to 55.
  Write start_block(std::int64_t id) {
    Rows rows = plant_.profile_rows();
    rows.merge(plant_.endless_target());
    rows[row::command] = start_;
    rows[row::command_id] = id;
    return block(row::target_position, row::command_id, rows);
  }
  void nothing_moves() {
    plant_.run(500ms);
    EXPECT_EQ(plant_.velocity(), 0);
    EXPECT_EQ(plant_.position(), 0);
  }
  /// By the panel, which then has nothing to do with it.
  void stop_and_enable() {
    ASSERT_EQ(b_.command(kQuickStop), kOk);
    ASSERT_TRUE(plant_.comes_to_stand());
    ASSERT_EQ(b_.command(kEnable), kOk);
  }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
  std::int64_t start_ = plant_.endless_command();
};

TEST_P(Newness, OfAnIdIsNotKnownWhereNoneIsKeptSoThePairIsOnlyRemembered) {
  const std::uint16_t seen = a_.word(shown::id_seen);
  const std::uint16_t motion = a_.word(shown::motion_id);
  EXPECT_EQ(a_.write(start_block(9)), kOk);
  nothing_moves();
  EXPECT_EQ(a_.result(), kNotNew);
  EXPECT_EQ(a_.word(shown::id_seen), seen);
  EXPECT_EQ(a_.word(shown::motion_id), motion);
  // The same again is what it was, and the next id acts.
  EXPECT_EQ(a_.write(start_block(9)), kOk);
  nothing_moves();
  EXPECT_EQ(a_.write(start_block(10)), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(Newness, OnAnEmptyMemoryABlockOnlyRemembersItsSetpoints) {
  ASSERT_EQ(b_.command(0), kOk);
  EXPECT_EQ(a_.write(start_block(9)), kOk);
  // Nobody has ever had a target accepted.
  b_.command(start_);
  plant_.run(500ms);
  EXPECT_EQ(plant_.velocity(), 0);
  EXPECT_LE(std::abs(plant_.position()), kClose);
}

TEST_P(Newness, WithoutAnIdABlockOnAnEmptyMemoryOnlyRemembers) {
  EXPECT_EQ(a_.write(start_block(0)), kOk);
  nothing_moves();
  EXPECT_EQ(a_.result(), kNotNew);
}

TEST_P(Newness, BeginsWithCommandZeroAndAnId) {
  EXPECT_EQ(a_.command(0, 41), kOk);
  EXPECT_EQ(a_.write(start_block(41)), kOk);
  nothing_moves();
  EXPECT_EQ(a_.write(start_block(42)), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
  EXPECT_EQ(a_.word(shown::id_seen), 42);
}

TEST_P(Newness, OfAnIdIsNeverBroughtBackByTimeOrZeros) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  ASSERT_EQ(a_.write(start_block(2)), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  stop_and_enable();
  const std::int64_t rests_at = plant_.position();
  plant_.run(1500ms);
  EXPECT_EQ(a_.write(start_block(2)), kOk);
  EXPECT_EQ(a_.command(0, 0), kOk);
  EXPECT_EQ(a_.rows(row::command, row::heartbeat, {}), kOk);
  plant_.run(1500ms);
  EXPECT_EQ(a_.write(start_block(2)), kOk);
  plant_.run(500ms);
  EXPECT_LE(std::abs(plant_.position() - rests_at), kClose);
  EXPECT_EQ(a_.write(start_block(3)), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(Newness, OfIdsIsKeptForAMinuteAfterTheLastConnection) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  a_.disconnect();
  plant_.run(55s);
  a_.connect();
  EXPECT_EQ(a_.write(start_block(1)), kOk);
  nothing_moves();
  EXPECT_EQ(a_.write(start_block(2)), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
  stop_and_enable();
  const std::int64_t rests_at = plant_.position();
  a_.disconnect();
  plant_.run(65s);
  a_.connect();
  EXPECT_EQ(a_.write(start_block(3)), kOk);
  EXPECT_EQ(a_.result(), kNotNew);
  plant_.run(500ms);
  EXPECT_LE(std::abs(plant_.position() - rests_at), kClose);
}

TEST_P(Newness, OfIdsIsSharedByTheConnectionsOfAnAddress) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  const auto other = plant_.connection_from(Plant::kHostOfA);
  EXPECT_EQ(other->write(start_block(1)), kOk);
  nothing_moves();
  EXPECT_EQ(other->write(start_block(2)), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(Newness, IsNotAskedForByAnIdAlone) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  ASSERT_EQ(plant_.set_endless(a_), kOk);
  EXPECT_EQ(a_.row(row::command_id, 2), kOk);
  nothing_moves();
  EXPECT_EQ(a_.command(start_, 2), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(Newness, OfASecondEnableIsNothingButNoFaultEither) {
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_EQ(a_.command(kEnable), kOk);
  plant_.run(1200ms);
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_EQ(a_.result(), kDone);
}

TEST_P(Newness, OfAnEnableAfterAnothersStopIsRefusedUntilZeroWasWritten) {
  ASSERT_EQ(a_.command(kEnable), kOk);
  ASSERT_EQ(b_.command(kDisable), kOk);
  plant_.run(200ms);
  EXPECT_EQ(a_.command(kEnable), kNotNow);
  EXPECT_EQ(a_.result(), kNotNew);
  EXPECT_TRUE(plant_.logged("write 0 first"));
  plant_.run(1500ms);
  EXPECT_EQ(a_.command(kEnable), kNotNow);
  EXPECT_FALSE(plant_.motor().enabled.value_or(false));
  EXPECT_EQ(a_.command(0), kOk);
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_TRUE(plant_.motor().enabled.value_or(true));
}

TEST_P(Newness, OfAStartAfterAnothersStopIsRefusedUntilZeroWasWritten) {
  ASSERT_EQ(plant_.set_endless(a_), kOk);
  ASSERT_EQ(a_.command(start_), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  stop_and_enable();
  const std::int64_t rests_at = plant_.position();
  EXPECT_EQ(a_.command(start_), kNotNow);
  plant_.run(1500ms);
  EXPECT_EQ(a_.command(start_), kNotNow);
  EXPECT_EQ(a_.result(), kNotNew);
  EXPECT_LE(std::abs(plant_.position() - rests_at), kClose);
  ASSERT_EQ(plant_.set_endless(a_), kOk);
  EXPECT_EQ(a_.command(0), kOk);
  EXPECT_EQ(a_.command(start_), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(Newness, OfABlockThatRepeatsWhatActedLeavesItsResult) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  ASSERT_EQ(a_.write(start_block(2)), kOk);
  ASSERT_EQ(a_.result(), kDone);
  plant_.scan(a_, start_block(2), 300ms);
  EXPECT_EQ(a_.result(), kDone);
  EXPECT_EQ(a_.word(shown::id_seen), 2);
}

TEST_P(Newness, OfAFirstPairIsToldAsLongAsItIsScanned) {
  plant_.scan(a_, start_block(5), 300ms);
  EXPECT_EQ(a_.result(), kNotNew);
  plant_.scan(a_, start_block(5), 300ms);
  EXPECT_EQ(a_.result(), kNotNew);
  nothing_moves();
}

class NewTargets : public testing::TestWithParam<Subject> {
 protected:
  NewTargets() { plant_.ready(); }
  void stops_and_enables() {
    ASSERT_EQ(plant_.b.command(kQuickStop), kOk);
    ASSERT_TRUE(plant_.comes_to_stand());
    ASSERT_EQ(plant_.b.command(kEnable), kOk);
  }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
};

TEST_P(NewTargets, WithinASecondAreNotMovedToAndSaySo) {
  ASSERT_EQ(a_.row(row::target_position, kFar), kOk);
  ASSERT_EQ(a_.command(kMove), kOk);
  for (const std::int64_t target : {kNear, kAway}) {
    plant_.run(150ms);
    EXPECT_EQ(a_.row(row::target_position, target), kOk);
    EXPECT_EQ(a_.command(kMove), kNotNow) << target;
    EXPECT_EQ(a_.result(), kNotNew);
  }
  EXPECT_TRUE(plant_.logged("write 0 first"));
  const std::int64_t at = plant_.comes_to_rest_at();
  EXPECT_LE(std::abs(at - kFar), kClose) << at;
  EXPECT_EQ(a_.command(0), kOk);
  EXPECT_EQ(a_.command(kMove), kOk);
  const std::int64_t then = plant_.comes_to_rest_at();
  EXPECT_LE(std::abs(then - kAway), kClose) << then;
}

TEST_P(NewTargets, AreMovedToByTheSameCommandAfterTheRearmTime) {
  ASSERT_EQ(a_.row(row::target_position, kNear), kOk);
  ASSERT_EQ(a_.command(kMove), kOk);
  plant_.run(1300ms);
  ASSERT_EQ(a_.row(row::target_position, kAway), kOk);
  EXPECT_EQ(a_.command(kMove), kOk);
  const std::int64_t at = plant_.comes_to_rest_at();
  EXPECT_LE(std::abs(at - kAway), kClose) << at;
}

TEST_P(NewTargets, ThatAreTheOldOnesAreAnsweredAsDone) {
  ASSERT_EQ(a_.row(row::target_position, kNear), kOk);
  ASSERT_EQ(a_.command(kMove), kOk);
  EXPECT_EQ(a_.command(kMove), kOk);
  const std::int64_t at = plant_.comes_to_rest_at();
  EXPECT_LE(std::abs(at - kNear), kClose) << at;
}

TEST_P(NewTargets, OfARelativeMoveThatIsNotNewAreNeverAdded) {
  ASSERT_EQ(a_.row(row::target_position, kNear), kOk);
  ASSERT_EQ(a_.command(kRelative), kOk);
  EXPECT_EQ(a_.command(kRelative), kNotNow);
  EXPECT_EQ(a_.result(), kNotNew);
  EXPECT_EQ(a_.command(kRelative), kNotNow);
  const std::int64_t at = plant_.comes_to_rest_at();
  EXPECT_LE(std::abs(at - kNear), kClose) << at;
}

TEST(NewAfterALoss, ARelativeMoveIsOnlyWhenZeroWasWrittenSince) {
  Plant plant(Subject::jd_serial);
  plant.ready();
  ASSERT_EQ(plant.a.row(row::target_position, kNear), kOk);
  ASSERT_EQ(plant.a.command(kRelative), kOk);
  const std::int64_t at = plant.comes_to_rest_at();
  plant.stage.link(0).unplug();
  plant.run(500ms);
  plant.stage.link(0).plug();
  plant.run(10s);
  EXPECT_EQ(plant.a.command(kRelative), kNotNow);
  EXPECT_EQ(plant.a.result(), kNotNew);
  EXPECT_LE(std::abs(plant.comes_to_rest_at() - at), kClose);
  EXPECT_EQ(plant.a.command(0), kOk);
  EXPECT_EQ(plant.a.command(kRelative), kOk);
  EXPECT_LE(std::abs(plant.comes_to_rest_at() - at - kNear), kClose);
}

// Of two requests that come in one instant the refusal of one made the press of the other forgotten.
TEST_P(NewTargets, AreNotMovedToAgainAfterAnothersStopWhateverElseWasRefusedInThatInstant) {
  ASSERT_EQ(a_.row(row::target_position, kFar), kOk);
  const RequestNumber start = a_.begin(one_coil(coil::start_absolute, true));
  const RequestNumber refused = a_.begin(one(row::command, kRelative));  // the axis moves already
  ASSERT_TRUE(plant_.stage.run_until([&] { return a_.answer_of(start) && a_.answer_of(refused); }));
  ASSERT_EQ(*a_.answer_of(start), kOk);
  ASSERT_EQ(*a_.answer_of(refused), kNotNow);
  ASSERT_TRUE(plant_.turns_within(1s));
  stops_and_enables();
  const std::int64_t rests_at = plant_.position();
  for (const Duration later : {0ms, 1500ms}) {
    plant_.run(later);
    EXPECT_EQ(a_.coil(coil::start_absolute, true), kNotNow);
    EXPECT_EQ(a_.result(), kNotNew);
    EXPECT_LE(std::abs(plant_.comes_to_rest_at() - rests_at), kClose);
  }
  EXPECT_EQ(a_.coil(coil::start_absolute, false), kOk);
  EXPECT_EQ(a_.coil(coil::start_absolute, true), kOk);
  EXPECT_LE(std::abs(plant_.comes_to_rest_at() - kFar), kClose);
}

class WordsBesideCommands : public NewTargets {};

// The command of its request was refused, and so the controlword counted as never written.
TEST_P(WordsBesideCommands, AreNotNewAgainAfterAnothersStopAlthoughTheCommandFailed) {
  ASSERT_EQ(a_.row(row::mode, 1), kOk);
  ASSERT_EQ(a_.row(row::target_position, kFar), kOk);
  const auto words = [](std::int64_t word, std::int64_t command) {
    return block(row::controlword, row::command,
                 {{row::controlword, word}, {row::mode, 1}, {row::target_position, kFar}, {row::command, command}});
  };
  ASSERT_EQ(a_.write(words(15, 0)), kOk);
  ASSERT_EQ(a_.write(words(0x1F, kRelative)), kNotNow);
  ASSERT_TRUE(plant_.turns_within(1s)) << "what was done stays done";
  stops_and_enables();
  const std::int64_t rests_at = plant_.position();
  plant_.run(1500ms);
  EXPECT_EQ(a_.row(row::controlword, 0x1F), kNotNow);
  EXPECT_EQ(a_.result(), kNotNew);
  EXPECT_LE(std::abs(plant_.comes_to_rest_at() - rests_at), kClose);
}

TEST_P(NewTargets, InABlockBesideAHeldCommandAreToldOnceAndNotMovedTo) {
  Rows rows = plant_.profile_rows();
  ASSERT_EQ(a_.command(0), kOk);
  rows[row::target_position] = kNear;
  rows[row::command] = kMove;
  ASSERT_EQ(a_.rows(row::target_position, row::command_id, rows), kOk);
  const std::int64_t at = plant_.comes_to_rest_at();
  ASSERT_LE(std::abs(at - kNear), kClose) << at;
  rows[row::target_position] = kAway;
  EXPECT_EQ(a_.rows(row::target_position, row::command_id, rows), kOk);
  EXPECT_EQ(a_.result(), kNotNew);
  const std::int64_t then = plant_.comes_to_rest_at();
  EXPECT_LE(std::abs(then - kNear), kClose) << then;
}

INSTANTIATE_TEST_SUITE_P(Every, Newness, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, NewTargets, testing::ValuesIn(subjects(has_positions)), named);
INSTANTIATE_TEST_SUITE_P(Every, WordsBesideCommands, testing::ValuesIn(subjects(has_positions)), named);

}  // namespace
}  // namespace axisgate::test::obey
