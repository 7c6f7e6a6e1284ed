// SPDX-License-Identifier: Apache-2.0
// A Keya on CANopen does not tell which mode a client has chosen: a gateway that is new must write nothing that moves,
// or a speed would be a position, and a position a speed (keya-kydas4860-2e, 6.2 and 8.1).
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class ChosenMode : public testing::TestWithParam<Subject> {
 protected:
  /// Enabled in the mode that the maker's tool has not set.
  void choose_the_other() {
    plant_.ready_but_disabled();
    ASSERT_EQ(a_.row(row::mode, positions_ ? kVelocityMode : 1), kOk);
    ASSERT_EQ(a_.command(kEnable), kOk);
  }
  /// Sooner than the drive misses it.
  void another_gateway() {
    plant_.crash_gateway();
    plant_.run(50ms);
    plant_.start_gateway();
    a_.connect();
    ASSERT_TRUE(plant_.stage.run_until([&] { return a_.word(kLinkState) == kOnline; }, 700ms));
    ASSERT_TRUE(*plant_.motor().enabled) << "too late to be of interest";
  }
  static constexpr std::uint16_t kLinkState = 18, kOnline = 2;
  bool positions_ = has_positions(GetParam());
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
};

TEST_P(ChosenMode, IsNotTakenForTheConfiguredOneByANewGateway) {
  choose_the_other();
  const std::int64_t at = plant_.position();
  another_gateway();
  if (positions_) {
    ASSERT_EQ(a_.row(row::target_position, 4'000), kOk);
    EXPECT_EQ(a_.command(kMove), kFailed);
  } else {
    ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
    EXPECT_EQ(a_.command(kRun), kFailed);
  }
  plant_.run(3s);
  EXPECT_EQ(plant_.velocity(), 0);
  EXPECT_LE(std::abs(plant_.position() - at), kClose);
  // Once it was disabled the mode is what the next enable says.
  EXPECT_EQ(a_.command(kDisable), kOk);
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_EQ(a_.command(0), kOk);
  ASSERT_EQ(plant_.set_endless(a_), kOk);
  EXPECT_EQ(a_.command(plant_.endless_command()), kOk);
  EXPECT_TRUE(plant_.turns_within(1s));
}

class ChosenModeThatRuns : public ChosenMode {
 protected:
  void stops_by(std::int64_t stop) {
    choose_the_other();
    if (positions_) {
      ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
      ASSERT_EQ(a_.command(kRun), kOk);
    } else {
      ASSERT_EQ(a_.row(row::target_position, kEndless), kOk);
      ASSERT_EQ(a_.command(kMove), kOk);
    }
    ASSERT_TRUE(plant_.keeps_turning());
    another_gateway();
    EXPECT_EQ(a_.command(stop), kOk);
    EXPECT_FALSE(*plant_.motor().enabled) << "a value of 0 would be a move, a position a speed";
    EXPECT_TRUE(plant_.comes_to_stand(10s)) << plant_.velocity();
  }
};

TEST_P(ChosenModeThatRuns, IsHaltedByWhatStopsInEachMode) { stops_by(kHalt); }
TEST_P(ChosenModeThatRuns, IsStoppedByWhatStopsInEachMode) { stops_by(kQuickStop); }

constexpr auto can_choose = [](Subject s) {
  return s == Subject::keya_canopen_speed || s == Subject::keya_canopen_position;
};
INSTANTIATE_TEST_SUITE_P(Every, ChosenModeThatRuns, testing::ValuesIn(subjects(can_choose)), named);
INSTANTIATE_TEST_SUITE_P(Every, ChosenMode, testing::ValuesIn(subjects(can_choose)), named);

}  // namespace
}  // namespace axisgate::test::obey
