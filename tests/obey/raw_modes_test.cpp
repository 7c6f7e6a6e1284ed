// SPDX-License-Identifier: Apache-2.0
// Raw velocity and torque modes, as a servo's programmer writes them (3.4): the motor does what the set-point says, as
// long as the mode runs.
#include <gtest/gtest.h>

#include <functional>

#include "tests/obey/dds_writers.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kTorqueMode = 4, kSomeTorque = 200;  // 20 % of rated

/// What a raw mode follows: a row, and two of its values.
struct Followed {
  std::int64_t mode;
  std::uint16_t row, last;
  std::int64_t value, other;
};
constexpr Followed kByVelocity{kVelocityMode, row::target_velocity, row::target_velocity + 1, kSpeed, kOtherSpeed};
constexpr Followed kByTorque{kTorqueMode, row::target_torque, row::target_torque, kSomeTorque, kSomeTorque};

class RawMode : public testing::TestWithParam<std::tuple<Subject, Followed>> {
 protected:
  RawMode() {
    plant_.ready_but_disabled();
    // Not every drive has it, and without it a torque ends at the drive's own.
    if (of_.mode == kTorqueMode) plant_.a.row(row::max_velocity, 300'000);
  }
  Answer target(std::int64_t value) { return plant_.a.row(of_.row, value); }
  /// A scanner's block from 40 on, three times.
  void scan(std::int64_t word, std::int64_t value) {
    const Rows rows{{row::controlword, word}, {row::mode, of_.mode}, {of_.row, value}};
    plant_.scan(plant_.a, block(row::controlword, of_.last, rows), 150ms);
  }
  bool follows(std::int64_t value) {
    if (value == 0) return plant_.comes_to_stand(5s);
    return of_.mode == kTorqueMode ? plant_.keeps_turning() : plant_.reaches(value);
  }
  const Followed of_ = std::get<Followed>(GetParam());
  Plant plant_{std::get<Subject>(GetParam())};
};

TEST_P(RawMode, FollowsItsTargetAndStandsAtZero) {
  ASSERT_EQ(plant_.a.row(row::mode, of_.mode), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 6), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 7), kOk);
  ASSERT_EQ(target(of_.value), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 15), kOk);
  ASSERT_TRUE(follows(of_.value)) << plant_.velocity();
  EXPECT_EQ(target(0), kOk);
  EXPECT_TRUE(follows(0)) << plant_.velocity();
  EXPECT_EQ(of_.last == of_.row ? plant_.a.word(of_.row) : plant_.a.wide(of_.row), 0);
  EXPECT_EQ(target(of_.other), kOk);
  EXPECT_TRUE(follows(of_.other)) << plant_.velocity();
}

TEST_P(RawMode, EnabledWithTargetZeroStartsWithTheNextTarget) {
  ASSERT_EQ(plant_.a.row(row::mode, of_.mode), kOk);
  ASSERT_EQ(target(0), kOk);
  for (const std::int64_t word : {6, 7, 15}) ASSERT_EQ(plant_.a.row(row::controlword, word), kOk) << word;
  plant_.run(500ms);
  ASSERT_TRUE(plant_.stands());
  EXPECT_EQ(target(of_.value), kOk);
  EXPECT_TRUE(follows(of_.value)) << plant_.velocity();
}

TEST_P(RawMode, ScannedInABlockDoesTheSame) {
  for (const std::int64_t word : {0, 6, 7}) scan(word, 0);
  for (const std::int64_t value : {of_.value, std::int64_t{0}, of_.other}) {
    scan(15, value);
    EXPECT_TRUE(follows(value)) << plant_.velocity() << " instead of " << value;
  }
  scan(6, of_.other);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
}

TEST_P(RawMode, ScannedWithTargetZeroStartsWithTheNextTarget) {
  for (const std::int64_t word : {0, 6, 7, 15}) scan(word, 0);
  ASSERT_TRUE(plant_.stands());
  scan(15, of_.value);
  EXPECT_TRUE(follows(of_.value)) << plant_.velocity();
}

TEST_P(RawMode, StartsAgainAndAgainWithABlockThatIsTheSameButForItsControlword) {
  scan(0, of_.value);
  for (int cycle = 0; cycle < 3; ++cycle) {
    SCOPED_TRACE(cycle);
    scan(6, of_.value);
    EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
    scan(7, of_.value);
    scan(15, of_.value);
    EXPECT_TRUE(follows(of_.value)) << plant_.velocity();
  }
}

class RawVelocity : public testing::TestWithParam<Subject> {
 protected:
  RawVelocity() { plant_.ready_but_disabled(); }
  void enable_raw() {
    for (const std::int64_t word : {6, 7, 15}) ASSERT_EQ(plant_.a.row(row::controlword, word), kOk) << word;
  }
  Plant plant_{GetParam()};
};

TEST_P(RawVelocity, IsEndedByCoil7ThatIsLetGoBeforeItHasBegun) {
  ASSERT_EQ(plant_.a.row(row::mode, kVelocityMode), kOk);
  const auto coil_7 = [&](std::uint16_t on) { return plant_.b.write(coil_block(coil::run_velocity - 1, {0, on})); };
  ASSERT_EQ(coil_7(1), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 6), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 7), kOk);
  ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  plant_.a.begin(one(row::controlword, 15));
  EXPECT_EQ(coil_7(0), kOk);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
  plant_.run(1s);
  EXPECT_EQ(plant_.velocity(), 0);
}

constexpr std::int64_t kContinuousMotion = 3;

class ShownRawVelocity : public RawVelocity {};  // a virtual axis runs raw from its enable on, and so from standing

// It showed "stopping" for as long as it ran.
TEST_P(ShownRawVelocity, IsARunAlsoBehindAHaltThatWasNeverSeenToEnd) {
  constexpr std::int64_t kFifteen = 0x4F;  // not the one that is remembered
  ASSERT_EQ(plant_.a.row(row::mode, kVelocityMode), kOk);
  enable_raw();
  ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_TRUE(plant_.reaches(kSpeed));
  ASSERT_EQ(plant_.a.word(shown::axis_state), kContinuousMotion);
  ASSERT_EQ(plant_.a.command(kHalt), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, kFifteen), kOk);
  ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  EXPECT_EQ(plant_.a.word(shown::axis_state), kContinuousMotion);
  ASSERT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
  plant_.run(1s);
  EXPECT_EQ(plant_.a.word(shown::axis_state), kContinuousMotion);
  EXPECT_EQ(plant_.a.command(kRelative), kNotNow);
}

// The drive's sampled velocity lags behind: it showed "standstill", and took a relative move.
TEST_P(ShownRawVelocity, IsARunBeforeTheSampledVelocitySaysSo) {
  ASSERT_EQ(plant_.a.row(row::mode, kVelocityMode), kOk);
  enable_raw();
  plant_.run(1s);
  ASSERT_EQ(plant_.a.word(shown::axis_state), kStandstill);
  ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  EXPECT_EQ(plant_.a.word(shown::axis_state), kContinuousMotion);
  EXPECT_EQ(plant_.a.command(kRelative), kNotNow);
  EXPECT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
}

/// Its motion was ended, and a target is there that nobody has asked a run for.
class RawVelocityEnded : public RawVelocity {
 protected:
  void run_and_halt(const std::function<void()>& halt) {
    ASSERT_EQ(plant_.a.command(0), kOk);  // on an empty memory a block only remembers its set-points
    ASSERT_EQ(plant_.a.row(row::mode, kVelocityMode), kOk);
    ASSERT_NO_FATAL_FAILURE(enable_raw());
    ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
    ASSERT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
    halt();
    ASSERT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
    plant_.run(2s);
  }
  void a_word_alone_moves_nothing() {
    EXPECT_EQ(plant_.b.row(row::controlword, 15), kOk);
    plant_.run(1s);
    EXPECT_TRUE(plant_.stands()) << plant_.velocity();
    EXPECT_EQ(plant_.b.row(row::controlword, kFifteen), kOk);
    plant_.run(1s);
    EXPECT_TRUE(plant_.stands()) << plant_.velocity() << " by the second word";
  }
  /// "Velocity, torque and start are needed anew": with both it runs.
  void a_target_and_a_word_run() {
    if (is_cia402(GetParam())) {
      EXPECT_EQ(plant_.a.row(row::target_velocity, kOtherSpeed), kOk);
      EXPECT_EQ(plant_.a.row(row::controlword, kFifteen), kOk);
    } else {  // a virtual axis runs raw from its enable on
      EXPECT_EQ(plant_.a.row(row::controlword, 6), kOk);
      EXPECT_EQ(plant_.a.row(row::controlword, 7), kOk);
      EXPECT_EQ(plant_.a.row(row::target_velocity, kOtherSpeed), kOk);
      EXPECT_EQ(plant_.a.row(row::controlword, 15), kOk);
    }
    EXPECT_TRUE(plant_.reaches(kOtherSpeed)) << plant_.velocity();
    plant_.run(2s);
    EXPECT_EQ(plant_.a.row(row::controlword, 15), kOk);
    EXPECT_TRUE(plant_.reaches(kOtherSpeed)) << "the word once more: " << plant_.velocity();
  }
  static constexpr std::int64_t kFifteen = 0x4F;  // the same for every drive, and not the one that is remembered
};

TEST_P(RawVelocityEnded, ByAHaltWithATargetBesideItNeedsATargetAnewBeforeAWordRunsIt) {
  ASSERT_NO_FATAL_FAILURE(run_and_halt([&] {
    Rows rows = plant_.profile_rows();
    rows[row::target_velocity] = kSpeed;
    rows[row::command] = kHalt;
    ASSERT_EQ(plant_.a.rows(row::target_velocity, row::command_id, rows), kOk);
  }));
  a_word_alone_moves_nothing();
  a_target_and_a_word_run();
}

TEST_P(RawVelocityEnded, ByADdsHaltWithATargetBesideItNeedsATargetAnewBeforeAWordRunsIt) {
  DdsWriters writer(plant_.stage, 1);
  ASSERT_NO_FATAL_FAILURE(run_and_halt([&] {
    const auto request =
        writer.begin({.function = fc::sample, .sample = {{row::command, kHalt}, {row::target_velocity, kOtherSpeed}}});
    ASSERT_TRUE(plant_.stage.run_until([&] { return writer.result_of(request).has_value(); }, 5s));
  }));
  a_word_alone_moves_nothing();
  a_target_and_a_word_run();
}

TEST_P(RawVelocityEnded, IsNotBegunAnewByAModeEither) {
  ASSERT_NO_FATAL_FAILURE(run_and_halt([&] {
    ASSERT_EQ(
        plant_.a.rows(row::target_velocity, row::command_id, {{row::target_velocity, kSpeed}, {row::command, kHalt}}),
        kOk);
  }));
  plant_.b.row(row::mode, kTorqueMode);  // not every drive has it
  plant_.b.row(row::mode, kVelocityMode);
  plant_.run(1s);
  EXPECT_TRUE(plant_.stands()) << plant_.velocity();
}

// Where command 8 starts it, the set-point accepted last counts (3.3 What asks), and a word beside that run ends
// nothing.
TEST_P(RawVelocityEnded, RunsByACommandAtTheTargetThatCameBesideTheHalt) {
  ASSERT_NO_FATAL_FAILURE(run_and_halt([&] {
    ASSERT_EQ(plant_.a.rows(row::target_velocity, row::command_id,
                            {{row::target_velocity, kOtherSpeed}, {row::command, kHalt}}),
              kOk);
  }));
  ASSERT_EQ(plant_.a.command(kRun), kOk);
  EXPECT_TRUE(plant_.reaches(kOtherSpeed)) << plant_.velocity();
  EXPECT_EQ(plant_.a.row(row::controlword, kFifteen), kOk);
  plant_.run(1s);
  EXPECT_TRUE(plant_.reaches(kOtherSpeed)) << plant_.velocity();
}

class RawVelocityOfAnother : public testing::TestWithParam<Subject> {};

// 3.5: whoever owns the axis now has not asked for it.
TEST_P(RawVelocityOfAnother, IsNotRunByAWordOfTheNextOwner) {
  Plant plant(GetParam(), with_leases());
  plant.ready_but_disabled();
  ASSERT_EQ(plant.a.row(row::mode, kVelocityMode), kOk);
  for (const std::int64_t word : {6, 7, 15}) ASSERT_EQ(plant.a.row(row::controlword, word), kOk) << word;
  ASSERT_EQ(plant.a.command(kHalt), kOk);
  ASSERT_EQ(plant.a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(plant.a.command(kRelease), kOk);
  EXPECT_EQ(plant.b.row(row::controlword, 15), kOk);
  EXPECT_EQ(plant.b.word(shown::owner), kMe);
  plant.run(1s);
  EXPECT_TRUE(plant.stands()) << plant.velocity();
}

INSTANTIATE_TEST_SUITE_P(Every, ShownRawVelocity, testing::ValuesIn(subjects(is_cia402)), named);
INSTANTIATE_TEST_SUITE_P(Every, RawVelocityEnded, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, RawVelocityOfAnother, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, RawVelocity, testing::ValuesIn(subjects(has_speeds)), named);
constexpr auto named_by_subject = [](const auto& tested) { return name(std::get<Subject>(tested.param)); };
INSTANTIATE_TEST_SUITE_P(Velocity, RawMode,
                         testing::Combine(testing::ValuesIn(subjects(has_speeds)), testing::Values(kByVelocity)),
                         named_by_subject);
INSTANTIATE_TEST_SUITE_P(Torque, RawMode,
                         testing::Combine(testing::ValuesIn(subjects(has_torque)), testing::Values(kByTorque)),
                         named_by_subject);

}  // namespace
}  // namespace axisgate::test::obey
