// SPDX-License-Identifier: Apache-2.0
// Coils (3.3 Edges, 3.3 Not new): a level that moves the axis acts only after this client wrote 0 to it; a single 0
// always acts.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class Coils : public testing::TestWithParam<Subject> {
 protected:
  Coils() { plant_.ready(); }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
};

TEST_P(Coils, EnableOnAnEmptyMemoryDoesSoWhereNothingIsLatched) {
  ASSERT_EQ(b_.coil(coil::enable, false), kOk);
  ASSERT_FALSE(plant_.enabled());
  EXPECT_EQ(a_.coil(coil::enable, true), kOk);
  EXPECT_TRUE(plant_.enabled());
}

TEST_P(Coils, EnableOnAnEmptyMemoryDoesNotClearAStopLatch) {
  ASSERT_EQ(b_.command(kQuickStop), kOk);
  plant_.run(1s);
  EXPECT_EQ(a_.coil(coil::enable, true), kNotNow);
  EXPECT_EQ(a_.result(), kNotNew);
  EXPECT_EQ(a_.word(shown::axis_state), kStopLatched);
  EXPECT_EQ(a_.coil(coil::enable, false), kOk);
  EXPECT_EQ(a_.coil(coil::enable, true), kOk);
  EXPECT_TRUE(plant_.enabled());
}

TEST_P(Coils, EnableHeldOverAStopAsksForNothing) {
  ASSERT_EQ(a_.coil(coil::enable, false), kOk);
  ASSERT_EQ(a_.coil(coil::enable, true), kOk);
  ASSERT_EQ(b_.coil(coil::enable, false), kOk);
  ASSERT_FALSE(plant_.enabled());
  plant_.run(1500ms);  // rearm_ms never applies to levels
  EXPECT_EQ(a_.coil(coil::enable, true), kNotNow);
  EXPECT_EQ(a_.result(), kNotNew);
  EXPECT_FALSE(plant_.enabled());
}

TEST_P(Coils, EnableInABlockOnAnEmptyMemoryIsOnlyRemembered) {
  ASSERT_EQ(b_.coil(coil::enable, false), kOk);
  EXPECT_EQ(a_.write(coil_block(coil::enable, {1, 0})), kOk);
  EXPECT_FALSE(plant_.enabled());
  EXPECT_EQ(a_.result(), kNotNew);
}

TEST_P(Coils, EnableZeroAloneAlwaysDisables) {
  ASSERT_TRUE(plant_.enabled());
  EXPECT_EQ(b_.coil(coil::enable, false), kOk);
  EXPECT_FALSE(plant_.enabled());
  ASSERT_EQ(a_.command(kEnable), kOk);
  EXPECT_EQ(b_.coil(coil::enable, false), kOk);
  EXPECT_FALSE(plant_.enabled());
}

TEST_P(Coils, EnableZeroInABlockOnAnEmptyMemoryIsOnlyRemembered) {
  EXPECT_EQ(b_.write(coil_block(coil::enable, {0, 0})), kOk);
  EXPECT_TRUE(plant_.enabled());
}

class Levels : public testing::TestWithParam<Subject> {
 protected:
  Levels() {
    plant_.ready();
    b_.row(row::target_velocity, kSpeed);
    b_.row(row::jog_velocity, kSpeed);
  }
  void nothing_moves() {
    plant_.run(300ms);
    EXPECT_EQ(plant_.velocity(), 0);
  }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
};

TEST_P(Levels, ThatMoveTheAxisActOnlyAfterZero) {
  for (const std::uint16_t number : {coil::run_velocity, coil::jog_forward, coil::jog_reverse}) {
    SCOPED_TRACE(number);
    EXPECT_EQ(a_.coil(number, true), kNotNow);
    EXPECT_EQ(a_.result(), kNotNew);
    nothing_moves();
    EXPECT_EQ(a_.coil(number, true), kNotNow);
    plant_.run(1500ms);
    EXPECT_EQ(a_.coil(number, true), kNotNow);
    nothing_moves();
    EXPECT_EQ(a_.coil(number, false), kOk);
    ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
    EXPECT_EQ(a_.coil(number, true), kOk);
    EXPECT_TRUE(plant_.turns_within(400ms));
    EXPECT_EQ(a_.coil(number, false), kOk);
    EXPECT_TRUE(plant_.comes_to_stand());
  }
}

TEST_P(Levels, InARowOfCoilsOnAnEmptyMemoryAreOnlyRemembered) {
  EXPECT_EQ(a_.write(coil_block(coil::run_velocity, {1, 0, 0})), kOk);
  nothing_moves();
  EXPECT_EQ(a_.result(), kNotNew);
  EXPECT_EQ(a_.write(coil_block(coil::run_velocity, {1, 0, 0})), kOk);
  nothing_moves();
  EXPECT_EQ(a_.write(coil_block(coil::run_velocity, {0, 0, 0})), kOk);
  ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
  EXPECT_EQ(a_.write(coil_block(coil::run_velocity, {1, 0, 0})), kOk);
  EXPECT_TRUE(plant_.turns_within(1s));
}

TEST_P(Levels, HeldOverAnothersStopAskForNothingUntilZero) {
  ASSERT_EQ(a_.coil(coil::run_velocity, false), kOk);
  ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(a_.coil(coil::run_velocity, true), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  ASSERT_EQ(b_.command(kQuickStop), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  ASSERT_EQ(b_.command(kEnable), kOk);
  EXPECT_EQ(a_.coil(coil::run_velocity, true), kNotNow);
  EXPECT_EQ(a_.result(), kNotNew);
  plant_.run(1500ms);
  EXPECT_EQ(a_.coil(coil::run_velocity, true), kNotNow);
  nothing_moves();
  EXPECT_EQ(a_.coil(coil::run_velocity, false), kOk);
  ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
  EXPECT_EQ(a_.coil(coil::run_velocity, true), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(Levels, ZeroAloneFromAnyoneEndsARun) {
  ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(a_.command(8), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  EXPECT_EQ(b_.coil(coil::run_velocity, false), kOk);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
}

TEST_P(Levels, ZeroInARowOfCoilsOnAnEmptyMemoryIsOnlyRemembered) {
  ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(a_.command(8), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  EXPECT_EQ(b_.write(coil_block(coil::run_velocity, {0, 0, 0})), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(Levels, ZeroAloneFromAnyoneEndsAJog) {
  ASSERT_EQ(a_.coil(coil::jog_forward, false), kOk);
  ASSERT_EQ(a_.coil(coil::jog_forward, true), kOk);
  ASSERT_TRUE(plant_.turns_within(400ms));
  EXPECT_EQ(b_.coil(coil::jog_forward, false), kOk);
  EXPECT_TRUE(plant_.comes_to_stand(300ms)) << plant_.velocity();
}

TEST_P(Levels, JogHeldAfterItsTimeAsksForNothingUntilZero) {
  ASSERT_EQ(a_.coil(coil::jog_forward, false), kOk);
  ASSERT_EQ(a_.coil(coil::jog_forward, true), kOk);
  ASSERT_TRUE(plant_.turns_within(400ms));
  plant_.run(700ms);  // jog_timeout_ms is 500
  ASSERT_TRUE(plant_.comes_to_stand());
  EXPECT_EQ(a_.coil(coil::jog_forward, true), kNotNow);
  EXPECT_EQ(a_.result(), kNotNew);
  nothing_moves();
}

// 3.4 Jog: "Both 1: halt", whatever runs. Held on, they let the next run be.
TEST_P(Levels, BothJogCoilsAtOneHaltARun) {
  const auto run = [&] {
    ASSERT_EQ(b_.row(row::target_velocity, kSpeed), kOk);
    ASSERT_EQ(b_.command(0), kOk);
    ASSERT_EQ(b_.command(8), kOk);
    ASSERT_TRUE(plant_.keeps_turning());
  };
  const auto both = coil_block(coil::jog_forward, {1, 1});
  ASSERT_EQ(a_.write(coil_block(coil::jog_forward, {0, 0})), kOk);
  run();
  EXPECT_EQ(a_.write(both), kOk);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
  run();
  EXPECT_EQ(a_.write(both), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
  ASSERT_EQ(a_.coil(coil::jog_reverse, false), kOk);
  EXPECT_TRUE(plant_.keeps_turning()) << "no jog of its own";
  EXPECT_EQ(a_.coil(coil::jog_reverse, true), kOk);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
}

// The homing took the jog's mode, was refused by the drive, and nobody watched the button any more.
TEST_P(Levels, AStartThatFailsLeavesNoJogWithoutItsButton) {
  constexpr std::int64_t kHomeSwitch = 19;
  ASSERT_TRUE(!has_homing(GetParam()) || a_.row(row::homing_method, kHomeSwitch).ok());
  ASSERT_EQ(a_.coil(coil::jog_forward, false), kOk);
  ASSERT_EQ(a_.coil(coil::jog_forward, true), kOk);
  ASSERT_TRUE(plant_.turns_within(400ms));
  if (a_.command(kHome).ok()) return;  // it homes
  plant_.run(700ms);                   // jog_timeout_ms is 500
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
}

class EdgeCoils : public testing::TestWithParam<Subject> {};

TEST_P(EdgeCoils, StartAMoveAsACommandWithoutIdDoes) {
  Plant plant(GetParam());
  plant.ready();
  ASSERT_EQ(plant.a.row(row::target_position, kNear), kOk);
  EXPECT_EQ(plant.a.coil(coil::start_absolute, true), kOk);  // alone on an empty memory
  std::int64_t at = plant.comes_to_rest_at();
  EXPECT_LE(std::abs(at - kNear), kClose) << at;
  ASSERT_EQ(plant.b.row(row::target_position, kAway), kOk);
  EXPECT_EQ(plant.b.write(coil_block(coil::start_absolute, {1, 0})), kOk);  // in a row: only remembered
  plant.run(300ms);
  EXPECT_EQ(plant.b.result(), kNotNew);
  at = plant.comes_to_rest_at();
  EXPECT_LE(std::abs(at - kNear), kClose) << at;
  EXPECT_EQ(plant.b.write(coil_block(coil::start_absolute, {0, 0})), kOk);
  EXPECT_EQ(plant.b.write(coil_block(coil::start_absolute, {1, 0})), kOk);
  at = plant.comes_to_rest_at();
  EXPECT_LE(std::abs(at - kAway), kClose) << at;
}

INSTANTIATE_TEST_SUITE_P(Every, Coils, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, Levels, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, EdgeCoils, testing::ValuesIn(subjects(has_positions)), named);

}  // namespace
}  // namespace axisgate::test::obey
