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

class RawVelocity : public testing::TestWithParam<Subject> {
 protected:
  RawVelocity() { plant_.ready_but_disabled(); }
  void enable_raw() {
    for (const std::int64_t word : {6, 7, 15}) ASSERT_EQ(plant_.a.row(row::controlword, word), kOk) << word;
  }
  /// A scanner's block 40..45, three times.
  void scan(std::int64_t word, std::int64_t velocity) {
    const Write request = block(
        row::controlword, 45, {{row::controlword, word}, {row::mode, kVelocityMode}, {row::target_velocity, velocity}});
    plant_.scan(plant_.a, request, 150ms);
  }
  Plant plant_{GetParam()};
};

TEST_P(RawVelocity, RunsAtTheVelocityAndStandsAtZero) {
  ASSERT_EQ(plant_.a.row(row::mode, kVelocityMode), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 6), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 7), kOk);
  ASSERT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 15), kOk);
  ASSERT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
  EXPECT_EQ(plant_.a.row(row::target_velocity, 0), kOk);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
  EXPECT_EQ(plant_.a.wide(row::target_velocity), 0);
  EXPECT_EQ(plant_.a.row(row::target_velocity, kOtherSpeed), kOk);
  EXPECT_TRUE(plant_.reaches(kOtherSpeed)) << plant_.velocity();
}

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

TEST_P(RawVelocity, EnabledWithTargetZeroStartsWithTheNextVelocity) {
  ASSERT_EQ(plant_.a.row(row::mode, kVelocityMode), kOk);
  ASSERT_EQ(plant_.a.row(row::target_velocity, 0), kOk);
  enable_raw();
  ASSERT_TRUE(plant_.stands());
  plant_.run(500ms);
  EXPECT_EQ(plant_.a.row(row::target_velocity, kSpeed), kOk);
  EXPECT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
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

TEST_P(RawVelocity, ScannedInABlockDoesTheSame) {
  scan(0, 0);
  scan(6, 0);
  scan(7, 0);
  scan(15, kSpeed);
  EXPECT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
  scan(15, 0);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
  scan(15, kOtherSpeed);
  EXPECT_TRUE(plant_.reaches(kOtherSpeed)) << plant_.velocity();
  scan(6, kOtherSpeed);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
}

TEST_P(RawVelocity, ScannedWithTargetZeroStartsWithTheNextVelocity) {
  for (const std::int64_t word : {0, 6, 7, 15}) scan(word, 0);
  ASSERT_TRUE(plant_.stands());
  scan(15, kSpeed);
  EXPECT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
}

TEST_P(RawVelocity, StartsAgainAndAgainWithABlockThatIsTheSameButForItsControlword) {
  scan(0, kSpeed);
  for (int cycle = 0; cycle < 3; ++cycle) {
    SCOPED_TRACE(cycle);
    scan(6, kSpeed);
    EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
    scan(7, kSpeed);
    scan(15, kSpeed);
    EXPECT_TRUE(plant_.reaches(kSpeed)) << plant_.velocity();
  }
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

class RawTorque : public testing::TestWithParam<Subject> {
 protected:
  RawTorque() {
    plant_.ready_but_disabled();
    plant_.a.row(row::max_velocity,
                 300'000);  // not every drive has it, and without it a torque ends at the drive's own
  }
  Plant plant_{GetParam()};
};

TEST_P(RawTorque, TurnsTheMotorAndLetsItGoAtZero) {
  ASSERT_EQ(plant_.a.row(row::mode, kTorqueMode), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 6), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 7), kOk);
  ASSERT_EQ(plant_.a.row(row::target_torque, kSomeTorque), kOk);
  ASSERT_EQ(plant_.a.row(row::controlword, 15), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  EXPECT_EQ(plant_.a.row(row::target_torque, 0), kOk);
  EXPECT_TRUE(plant_.comes_to_stand(5s)) << plant_.velocity();
  EXPECT_EQ(plant_.a.word(row::target_torque), 0);
  EXPECT_EQ(plant_.a.row(row::target_torque, kSomeTorque), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(RawTorque, EnabledWithTargetZeroStartsWithTheNextTorque) {
  ASSERT_EQ(plant_.a.row(row::mode, kTorqueMode), kOk);
  for (const std::int64_t word : {6, 7, 15}) ASSERT_EQ(plant_.a.row(row::controlword, word), kOk) << word;
  plant_.run(500ms);
  ASSERT_TRUE(plant_.stands());
  EXPECT_EQ(plant_.a.row(row::target_torque, kSomeTorque), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(RawTorque, ScannedInABlockDoesTheSame) {
  const auto scan = [&](std::int64_t word, std::int64_t torque) {
    plant_.scan(plant_.a,
                block(row::controlword, row::target_torque,
                      {{row::controlword, word}, {row::mode, kTorqueMode}, {row::target_torque, torque}}),
                150ms);
  };
  for (const std::int64_t word : {0, 6, 7}) scan(word, 0);
  scan(15, kSomeTorque);
  EXPECT_TRUE(plant_.keeps_turning());
  scan(15, 0);
  EXPECT_TRUE(plant_.comes_to_stand(5s)) << plant_.velocity();
  scan(15, kSomeTorque);
  EXPECT_TRUE(plant_.keeps_turning());
}

INSTANTIATE_TEST_SUITE_P(Every, ShownRawVelocity, testing::ValuesIn(subjects(is_cia402)), named);
INSTANTIATE_TEST_SUITE_P(Every, RawVelocityEnded, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, RawVelocityOfAnother, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, RawVelocity, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, RawTorque, testing::ValuesIn(subjects(has_torque)), named);

}  // namespace
}  // namespace axisgate::test::obey
