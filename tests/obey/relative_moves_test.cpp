// SPDX-License-Identifier: Apache-2.0
// Where a relative move begins (3.4): at the set-point position, at standstill. On a drive whose relative move is
// carried out as an absolute one the gateway itself must know that place.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class RelativeMoves : public testing::TestWithParam<Subject> {
 protected:
  RelativeMoves() { plant_.ready(); }
  void press(std::int64_t command) {
    ASSERT_EQ(a_.command(0), kOk);
    ASSERT_EQ(a_.command(command), kOk);
  }
  /// The motion started last has ended as `how` (row 32).
  bool ended(std::int64_t how) {
    return plant_.stage.run_until([&] { return a_.word(shown::motion_state) == how; }, 10s);
  }
  simulated::KeyaMotor& motor_of_keya() { return plant_.stage.keya(0).at(simulated::KeyaMotorName::a); }
  void expect_at(std::int64_t place) {
    const std::int64_t at = plant_.comes_to_rest_at();
    EXPECT_LE(std::abs(at - place), kClose) << "at " << at << " instead of " << place;
  }
  static constexpr std::int64_t kCompleted = 2, kDistance = 1200;
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
};

TEST_P(RelativeMoves, EndAtTheirSumWhateverTheMotorFallsShortBy) {
  // Within the window of a target that is reached, and above what is close.
  constexpr std::int64_t kShortBy = 4, kMoves = 50;
  motor_of_keya().fall_short(kShortBy);
  press(kMove);  // to where the targets begin
  ASSERT_TRUE(ended(kCompleted));
  const std::int64_t from = a_.wide(row::target_position);
  ASSERT_EQ(a_.row(row::target_position, kDistance), kOk);
  for (int i = 0; i < kMoves; ++i) {
    press(kRelative);
    ASSERT_TRUE(ended(kCompleted)) << "move " << i;
  }
  motor_of_keya().fall_short(0);
  expect_at(from + kMoves * kDistance);
}

TEST_P(RelativeMoves, AfterAHaltBeginWhereTheMotorStands) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(a_.row(row::target_position, kFar), kOk);
    press(kMove);
    ASSERT_TRUE(plant_.turns_within(1s));
    plant_.run(200ms);
    ASSERT_EQ(a_.command(kHalt), kOk);
    ASSERT_EQ(a_.row(row::target_position, -kDistance), kOk);
    // The first instant in which it is accepted.
    for (Answer answer{kNotNow}; !answer.ok(); plant_.run(1ms)) {
      ASSERT_EQ(answer, kNotNow);
      const std::int64_t stood_at = plant_.position();
      ASSERT_EQ(a_.command(0), kOk);
      answer = a_.command(kRelative);
      if (answer.ok()) expect_at(stood_at - kDistance);
    }
  }
}

TEST_P(RelativeMoves, BeginWhereTheMotorIsAfterItWasMovedByHand) {
  press(kMove);
  ASSERT_TRUE(ended(kCompleted));
  ASSERT_EQ(a_.command(kDisable), kOk);
  constexpr std::int32_t kElsewhere = 7000;  // counts
  motor_of_keya().set_count(motor_of_keya().count() + kElsewhere);
  press(kEnable);
  plant_.run(200ms);
  const std::int64_t from = plant_.position();
  ASSERT_EQ(a_.row(row::target_position, kDistance), kOk);
  press(kRelative);
  ASSERT_TRUE(ended(kCompleted));
  expect_at(from + kDistance);
}

INSTANTIATE_TEST_SUITE_P(Every, RelativeMoves,
                         testing::ValuesIn(subjects([](Subject s) { return is_keya(s) && has_positions(s); })), named);

}  // namespace
}  // namespace axisgate::test::obey
