// SPDX-License-Identifier: Apache-2.0
// The buttons of `axisgate jog`: what presses them, what lets them go, and nothing else.
#include "tests/unit/commands/manual_rig.hpp"

namespace axisgate::commands {
namespace {

using ::testing::HasSubstr;

TEST_F(ByHand, AKeyPressesAndEachRepeatPressesAgainAndNothingElseDoes) {
  jogging();
  pass(std::chrono::seconds(2));
  EXPECT_THAT(written(), IsEmpty()) << "no key, no button";
  for (int i = 0; i < 5; ++i) {
    press(ManualKey::forward);
    EXPECT_THAT(written(), ElementsAre(coil(8, true)));
    answer();
    pass(30 * kMs);
    EXPECT_THAT(written(), IsEmpty()) << "time alone presses nothing";
  }
}

TEST_F(ByHand, ThreeHundredMillisecondsWithoutAKeyLetGo) {
  jogging();
  press(ManualKey::reverse);
  EXPECT_THAT(written(), ElementsAre(coil(9, true)));
  pass(ManualPlan::kKeyLapse - 10 * kMs);
  EXPECT_THAT(written(), IsEmpty());
  pass(10 * kMs);
  EXPECT_THAT(written(), ElementsAre(coil(9, false)));
  pass(std::chrono::seconds(2));
  EXPECT_THAT(written(), IsEmpty()) << "once";
}

TEST_F(ByHand, APressThatIsNotAnsweredYetIsNotPressedAgain) {
  jogging();
  press(ManualKey::forward);
  EXPECT_THAT(written(), ElementsAre(coil(8, true)));
  for (int i = 0; i < 20; ++i) {
    pass(30 * kMs);
    press(ManualKey::forward);
  }
  EXPECT_THAT(written(), IsEmpty()) << "what waited in a slow network would be pressed late";
}

TEST_F(ByHand, AnotherKeyLetsGoAtOnceAndTheOtherArrowFirstLetsGo) {
  jogging();
  press(ManualKey::forward);
  press(ManualKey::other);
  EXPECT_THAT(written(), ElementsAre(coil(8, true), coil(8, false)));
  answer();
  answer();
  press(ManualKey::forward);
  EXPECT_THAT(written(), ElementsAre(coil(8, true)));
  answer();
  press(ManualKey::reverse);
  EXPECT_THAT(written(), ElementsAre(coil(8, false)));
  answer();
  press(ManualKey::reverse);
  EXPECT_THAT(written(), ElementsAre(coil(9, true)));
}

TEST_F(ByHand, AProcessThatStoodStillLetsGo) {
  jogging();
  press(ManualKey::forward);
  static_cast<void>(written());
  plan_->on_stall(now_);
  EXPECT_THAT(written(), ElementsAre(coil(8, false)));
}

TEST_F(ByHand, WhatWasTypedDuringAStallAndIsDeliveredLatePressesNothing) {
  jogging();
  plan_->on_stall(now_);
  for (int key = 0; key < 5; ++key) press(ManualKey::forward);
  EXPECT_THAT(written(), IsEmpty());
  pass(ManualPlan::kKeyLapse);
  press(ManualKey::forward);
  EXPECT_THAT(written(), ElementsAre(coil(8, true)));
}

TEST_F(ByHand, QThatWasTypedDuringAStallEndsIt) {
  jogging();
  plan_->on_stall(now_);
  press(ManualKey::quit);
  given_back(43);
  EXPECT_EQ(plan_->exit_code(), 0);
}

TEST_F(ByHand, QLetsGoWaitsAndGivesBack) {
  jogging();
  press(ManualKey::forward);
  static_cast<void>(written());
  answer();
  press(ManualKey::quit);
  EXPECT_THAT(written(), ElementsAre(coil(8, false), stop(Command::quick_stop)));
  answer();
  answer();
  stand();
  given_back(43);
  EXPECT_EQ(plan_->exit_code(), 0);
}

TEST_F(ByHand, QOnAnAxisThatStandsNeedsNoStop) {
  jogging();
  press(ManualKey::quit);
  given_back(43);
  EXPECT_EQ(plan_->exit_code(), 0);
}

TEST_F(ByHand, APressThatTheGatewayHasEndedNeedsTheKeyAnew) {
  jogging();
  press(ManualKey::forward);
  static_cast<void>(written());
  answer(Exception::server_device_busy);
  EXPECT_THAT(written(), ElementsAre(coil(8, false)));
  answer();
  EXPECT_FALSE(plan_->over());
  press(ManualKey::forward);
  EXPECT_THAT(written(), ElementsAre(coil(8, true)));
}

TEST_F(ByHand, APressThatIsRefusedForGoodEndsIt) {
  jogging();
  press(ManualKey::forward);
  static_cast<void>(written());
  answer(Exception::illegal_data_value);
  EXPECT_THAT(written(), ElementsAre(coil(8, false)));
  answer();
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("jog was refused with exception 0x03"));
  stopped_and_given_back(43);
}

}  // namespace
}  // namespace axisgate::commands
