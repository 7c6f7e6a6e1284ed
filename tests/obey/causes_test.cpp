// SPDX-License-Identifier: Apache-2.0
// A fault is shown with the statusword that tells it, its cause as soon as that is known, and each cause is told once,
// on every drive and protocol.
#include "tests/obey/causes.hpp"

#include <gtest/gtest.h>

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

TEST_P(Causes, AFaultIsShownAtOnceAndItsCauseNextAndToldOnce) {
  ready();
  const auto causes = causes_of(GetParam());
  for (int i = 0; i < 8; ++i) {
    SCOPED_TRACE(i);
    plant_->run(i * 7ms);  // another place in the beat of the polls
    const std::uint64_t from = told_until_now();
    trip(causes.at(static_cast<std::size_t>(i % 2)));
    EXPECT_EQ(wrong_until_known(), "");
    expect_shown(causes.at(static_cast<std::size_t>(i % 2)), from);
    reset();
  }
}

// "Never with the cause of the fault before", how soon ever the next one comes.
TEST_P(Causes, TheNextFaultHasItsOwnCause) {
  ready();
  const auto causes = causes_of(GetParam());
  for (int i = 0; i < 8; ++i) {
    SCOPED_TRACE(i);
    trip(causes[0]);
    ASSERT_TRUE(until_faulted());
    ASSERT_EQ(plant_->a.command(0), kOk);
    ASSERT_EQ(plant_->a.command(kReset), kOk);
    plant_->run(i * 3ms);
    const std::uint64_t from = told_until_now();
    trip(causes[1]);
    ASSERT_TRUE(until_faulted());
    expect_shown(causes[1], from);
    reset();
  }
}

TEST_P(Causes, AFaultOfTheTimeWithoutALinkIsShownWithItsCause) {
  ready();
  const auto causes = causes_of(GetParam());
  for (const Duration away : {100ms, 4000ms}) {
    plant_->unplug();
    plant_->run(away);
    trip(causes[1]);
    plant_->run(20ms);
    const std::uint64_t from = told_until_now();
    plant_->plug();
    if (is_keya(GetParam()) || (away > 1s && minds_silence(GetParam()))) {
      // The drive's own watchdog has its say as well.
      ASSERT_TRUE(plant_->stage.run_until([this] { return axis().reachable() && axis().has(AxisInput::fault); }));
      plant_->run(1500ms);
      ASSERT_EQ(faults_told(from).size(), 1U) << texts(faults_told(from));
      EXPECT_NE(axis()[Quantity::error_code].value, 0);
    } else {
      EXPECT_EQ(wrong_until_known(20s), "");
      expect_shown(causes[1], from);
    }
    if (away < 1s) reset();
  }
}

TEST_P(Causes, AFaultThatIsThereAtTheStartIsShownWithItsCause) {
  ready();
  const auto causes = causes_of(GetParam());
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    plant_->crash_gateway();
    plant_->run(i % 2 == 0 ? 300ms : 1ms);
    if (i < 2) trip(causes[0]);
    plant_->start_gateway();
    plant_->a.connect();
    plant_->run(i * 2ms);
    if (i >= 2) trip(causes[0]);
    EXPECT_EQ(wrong_until_known(20s), "");
    expect_shown(causes[0], 0);
    reset();
  }
}

// A lost answer delays either, and what is known late is told all the same.
TEST_P(Causes, ALostAnswerTakesNoFaultItsCause) {
  const auto causes = causes_of(GetParam());
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    ready();
    plant_->run(i * 11ms);
    const std::uint64_t from = told_until_now();
    trip(causes[0]);
    plant_->run(i % 4 * 2ms);
    ASSERT_TRUE(plant_->strike(i % 2 == 0 ? Strike::lose_reply : Strike::lose_request));
    EXPECT_EQ(wrong_until_known(), "");
    plant_->run(1500ms);
    const auto told = faults_told(from);
    ASSERT_EQ(told.size(), 1U) << texts(told);
    EXPECT_NE(told.front().text.find(causes[0].text), std::string::npos) << told.front().text;
    EXPECT_EQ(axis()[Quantity::error_code].value, causes[0].code);
  }
}

// The first one stays, or is written over by the second, as the drive has it: log and registers tell the same.
TEST_P(Causes, ASecondOneBehindTheFirstIsToldOnceWhereItIsTheCauseNow) {
  ready();
  const auto causes = causes_of(GetParam());
  for (const std::size_t first : {0U, 1U}) {
    SCOPED_TRACE(first);
    const std::uint64_t from = told_until_now();
    trip(causes.at(first));
    EXPECT_EQ(wrong_until_known(), "");
    trip(causes.at(1 - first));
    plant_->run(4s);
    EXPECT_EQ(wrong_now(), "");
    const auto told = faults_told(from);
    ASSERT_EQ(told.size(), shown(Quantity::error_code) == causes.at(first).code ? 1U : 2U) << texts(told);
    EXPECT_EQ(told.front().code, causes.at(first).code);
    EXPECT_EQ(told.back().code, shown(Quantity::error_code));
    reset();
  }
}

INSTANTIATE_TEST_SUITE_P(Every, Causes, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test::obey
