// SPDX-License-Identifier: Apache-2.0
// 3.3 Zeros: what a scanner's image holds before its program runs asks for nothing; in some rows 0 means "leave as it
// is".
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

const Write kZeros = block(row::controlword, row::heartbeat, {});
const Write kFewerZeros = block(row::controlword, row::command, {});

class Zeros : public testing::TestWithParam<Subject> {
 protected:
  Zeros() { plant_.ready(); }
  Plant plant_{GetParam(), with_leases()};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
};

TEST_P(Zeros, OfAWholeBlockAskForNothingAndClaimNothing) {
  for (const Write& zeros : {kZeros, kFewerZeros, block(40, 56, {}, fc::read_write)}) {
    SCOPED_TRACE(text(zeros));
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(a_.write(zeros), kOk);
      EXPECT_EQ(a_.word(shown::owner), kNobody);
    }
  }
  EXPECT_TRUE(plant_.enabled());
  EXPECT_EQ(plant_.position(), 0);
}

TEST_P(Zeros, OfAWholeBlockDisturbNoOwner) {
  ASSERT_TRUE(plant_.start_endless(a_));
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(b_.write(kZeros), kOk);
    EXPECT_EQ(b_.word(shown::owner), kAnother);
    plant_.run(100ms);
    EXPECT_NE(plant_.velocity(), 0);
  }
  EXPECT_EQ(a_.word(shown::owner), kMe);
}

TEST_P(Zeros, InTheControlwordAfterAnotherValueAreAStop) {
  ASSERT_EQ(a_.row(row::controlword, 15), kOk);
  ASSERT_TRUE(plant_.start_endless(a_));
  EXPECT_EQ(a_.write(kZeros), kOk);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
  EXPECT_FALSE(plant_.enabled());
}

/// The owner's target_velocity 0 is another matter.
class ZerosInAMove : public Zeros {};

TEST_P(ZerosInAMove, AreOnlyRememberedWhereTheControlwordWasNeverWritten) {
  // Not so far that a Keya's own watchdog ends the move: in position mode nothing may be sent again.
  constexpr std::int64_t kWithinASecond = kFar / 2;
  ASSERT_EQ(a_.row(row::target_position, kWithinASecond), kOk);
  ASSERT_EQ(a_.command(kMove), kOk);
  plant_.run(200ms);
  EXPECT_EQ(a_.write(kZeros), kOk);
  EXPECT_TRUE(plant_.enabled());
  const std::int64_t at = plant_.comes_to_rest_at();
  EXPECT_LE(std::abs(at - kWithinASecond), kClose) << at;
}

TEST_P(Zeros, InRowsThatLeaveAsIsChangeNothingInABlockAndAreRefusedAlone) {
  struct Row {
    std::uint16_t offset;
    std::optional<unsigned> bit;  ///< in `supported`; none: every axis has it
  };
  const std::vector<Row> rows{{row::mode, 15},
                              {row::max_torque, 19},
                              {row::profile_velocity, 20},
                              {row::profile_acceleration, 21},
                              {row::profile_deceleration, 22},
                              {row::jog_velocity, 17},  // with target_velocity
                              {row::homing_speed_switch, 24},
                              {row::homing_speed_zero, 25},
                              {row::homing_acceleration, 26},
                              {row::quick_stop_deceleration, 28},
                              {row::max_velocity, 31}};
  if (plant_.has(17)) {
    ASSERT_EQ(a_.row(row::jog_velocity, kSpeed), kOk);
  }
  plant_.run(3s);  // every row has been polled
  for (const auto& [offset, bit] : rows) {
    if (bit && !plant_.has(*bit)) continue;
    SCOPED_TRACE("row " + std::to_string(offset));
    const auto shown = [&] { return is_wide(offset) ? a_.wide(offset) : a_.word(offset); };
    const std::int64_t before = shown();
    const auto last = static_cast<std::uint16_t>(offset + (is_wide(offset) ? 1 : 0));
    EXPECT_EQ(a_.write(block(offset, last, {}, fc::read_write)), kOk);
    plant_.run(3s);
    EXPECT_EQ(shown(), before);
    EXPECT_EQ(a_.row(offset, 0), kBadValue);
    EXPECT_EQ(shown(), before);
  }
}

TEST_P(Zeros, BesideACommandThatActsLeaveItsProfileAsItIs) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  Rows rows = plant_.endless_target();
  rows[row::command] = plant_.endless_command();
  rows[row::command_id] = 2;
  EXPECT_EQ(a_.rows(row::controlword, row::heartbeat, rows), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  EXPECT_TRUE(!has_speeds(GetParam()) || plant_.reaches(kSpeed)) << plant_.velocity();
}

class ZeroSpeed : public testing::TestWithParam<Subject> {
 protected:
  ZeroSpeed() { plant_.ready(); }
  void run() {
    ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
    ASSERT_EQ(plant_.a.command(kRun), kOk);
    ASSERT_TRUE(plant_.reaches(kSpeed));
  }
  Plant plant_{GetParam(), with_leases()};
};

TEST_P(ZeroSpeed, OfTheOwnersWholeBlockActsWhileARunIsOn) {
  run();
  EXPECT_EQ(plant_.a.write(kZeros), kOk);
  EXPECT_TRUE(plant_.comes_to_stand(1500ms)) << plant_.velocity();
  EXPECT_TRUE(plant_.enabled());
}

TEST_P(ZeroSpeed, OfTheOwnersWholeBlockActsOnARunThatStillWaits) {
  ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  plant_.a.begin(one(row::command, kRun));
  EXPECT_EQ(plant_.a.write(kZeros), kOk);
  EXPECT_TRUE(plant_.comes_to_stand(1500ms)) << plant_.velocity();
  plant_.run(1s);
  EXPECT_EQ(plant_.velocity(), 0);
  EXPECT_TRUE(plant_.enabled());
}

TEST_P(ZeroSpeed, OfAWholeBlockOfItsOwnerThatHasConnectedAnewActs) {
  run();
  plant_.a.disconnect();
  plant_.a.connect();
  EXPECT_EQ(plant_.a.write(kZeros), kOk);
  EXPECT_TRUE(plant_.comes_to_stand(1500ms)) << plant_.velocity();
  EXPECT_TRUE(plant_.enabled());
}

TEST_P(ZeroSpeed, OfAnotherClientsWholeBlockDoesNot) {
  run();
  EXPECT_EQ(plant_.b.write(kZeros), kOk);
  EXPECT_EQ(plant_.a.word(shown::owner), kMe);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(ZeroSpeed, OfARawModeIsAStopByItsControlword) {
  for (const std::int64_t word : {0, 6, 7, 15}) {
    plant_.scan(plant_.a,
                block(row::controlword, row::heartbeat,
                      {{row::controlword, word}, {row::mode, kVelocityMode}, {row::target_velocity, kSpeed}}),
                200ms);
  }
  ASSERT_TRUE(plant_.keeps_turning());
  EXPECT_EQ(plant_.a.write(kZeros), kOk);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
  EXPECT_FALSE(plant_.enabled());
}

INSTANTIATE_TEST_SUITE_P(Every, Zeros, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, ZerosInAMove, testing::ValuesIn(subjects(has_positions)), named);
INSTANTIATE_TEST_SUITE_P(Every, ZeroSpeed, testing::ValuesIn(subjects(has_speeds)), named);

}  // namespace
}  // namespace axisgate::test::obey
