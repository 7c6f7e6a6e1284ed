// SPDX-License-Identifier: Apache-2.0
// A trial of a profile, by sequences: what is right, what is wrong with it, and who or what ends it.
#include "tests/unit/commands/try_rig.hpp"

namespace axisgate::commands {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

class TryPlanTest : public TrialRig {
 protected:
  /// To the consent of this step, and over it.
  void consent_to(TryStep step) {
    go_on(step);
    ASSERT_FALSE(plan_->over()) << plan_->report().ended;
    say("4 " + std::string(text(step)));
  }
  void expect_ended_safely() {
    until_over();
    EXPECT_TRUE(stands());
    EXPECT_EQ(plan_->exit_code(), 1);
    EXPECT_THAT(commands_.back(), Command::disable);
  }
};

TEST_F(TryPlanTest, ARightProfilePassesEveryStep) {
  begin({.home = std::nullopt});
  go_on(TryStep::home);
  until_over();
  EXPECT_EQ(plan_->report().ended, "");
  EXPECT_EQ(plan_->exit_code(), 0);
  for (const TryStep step :
       {TryStep::read, TryStep::setup, TryStep::torque, TryStep::moves, TryStep::stops, TryStep::loss})
    EXPECT_EQ(verdict(step), Verdict::right) << text(step) << ": " << saw(step);
  EXPECT_EQ(verdict(TryStep::turn), Verdict::not_tried);
  EXPECT_EQ(verdict(TryStep::home), Verdict::not_tried);
  EXPECT_THAT(saw(TryStep::moves), HasSubstr(" rpm by position, 10 rpm by velocity_actual, 10 asked"));
  EXPECT_TRUE(stands());
  EXPECT_LT(fastest_, 31);
}

TEST_F(TryPlanTest, DryReadsAlone) {
  begin({.dry = true});
  until_over();
  EXPECT_EQ(plan_->exit_code(), 0);
  EXPECT_EQ(plan_->asks(), 0);
  EXPECT_EQ(writes_, 0);
  EXPECT_THAT(orders_, Each(TryOrder::Kind::read));
  EXPECT_EQ(verdict(TryStep::read), Verdict::right);
  EXPECT_EQ(verdict(TryStep::moves), Verdict::not_tried);
  EXPECT_THAT(saw(TryStep::setup), HasSubstr("producer_heartbeat (1017.00) holds 1000"));
}

TEST_F(TryPlanTest, NothingIsWrittenBeforeTheFirstConsent) {
  begin();
  go_on(TryStep::torque);
  EXPECT_EQ(writes_, 0);
  EXPECT_FALSE(enabled_);
}

TEST_F(TryPlanTest, AnyAnswerButTheWordEndsIt) {
  for (const char* answer : {"", "torque", "yes", "4 moves", "4 torque ", "5 torque", "4 TORQUE"}) {
    begin();
    go_on(TryStep::torque);
    say(answer);
    until_over();
    EXPECT_EQ(writes_, 0) << answer;
    EXPECT_EQ(plan_->exit_code(), 1);
    EXPECT_EQ(verdict(TryStep::torque), Verdict::not_tried);
  }
}

TEST_F(TryPlanTest, TheEndOfTheInputAndSilenceEndIt) {
  begin();
  go_on(TryStep::torque);
  say(std::nullopt);
  until_over();
  EXPECT_THAT(plan_->report().ended, HasSubstr("input"));
  begin();
  go_on(TryStep::torque);
  until_over();
  EXPECT_THAT(plan_->report().ended, HasSubstr("nobody"));
  EXPECT_EQ(writes_, 0);
}

TEST_F(TryPlanTest, AnAnswerOfNoIsWrong) {
  begin();
  consent_to(TryStep::moves);
  until_asked();
  say("no");
  expect_ended_safely();
  EXPECT_EQ(verdict(TryStep::moves), Verdict::wrong);
}

TEST_F(TryPlanTest, ASpeedUnitSixtyTimesTooLargeIsStoppedWithinAPartOfATurn) {
  flaws_.speed = 60;
  begin();
  consent_to(TryStep::moves);
  while (!plan_->over()) {
    until_asked();
    if (!plan_->over()) say("yes");
  }
  expect_ended_safely();
  EXPECT_EQ(verdict(TryStep::moves), Verdict::wrong);
  EXPECT_THAT(saw(TryStep::moves), HasSubstr("unit"));
  EXPECT_LT(std::abs(turned_), 3) << "600 rpm are 0.2 turns a look";
}

TEST_F(TryPlanTest, ASpeedUnitSixtyTimesTooSmallIsFound) {
  flaws_.speed = 1.0 / 60;
  begin();
  consent_to(TryStep::moves);
  expect_ended_safely();
  EXPECT_EQ(verdict(TryStep::moves), Verdict::wrong);
}

TEST_F(TryPlanTest, CountsOfATurnThatAreTenTimesTooManyAreFound) {
  flaws_.counts = 0.1;  // it shows a tenth of what it turns, and turns ten times what it is asked
  begin();
  go_on(TryStep::home);
  expect_ended_safely();
  EXPECT_EQ(verdict(TryStep::moves), Verdict::wrong);
  EXPECT_LT(std::abs(turned_), 12);
}

TEST_F(TryPlanTest, AVelocityThatContradictsThePositionIsFound) {
  flaws_.shown_velocity = 0.5;
  begin();
  go_on(TryStep::home);
  EXPECT_EQ(verdict(TryStep::moves), Verdict::wrong);
  EXPECT_THAT(saw(TryStep::moves), HasSubstr("velocity_actual does not fit the position: 2 times too slow"));
}

TEST_F(TryPlanTest, AVelocityOfTheOtherSignIsFound) {
  flaws_.shown_velocity = -1;
  begin();
  go_on(TryStep::home);
  EXPECT_EQ(verdict(TryStep::moves), Verdict::wrong);
  EXPECT_THAT(saw(TryStep::moves), HasSubstr("the sign is another"));
}

TEST_F(TryPlanTest, APositionOfTheOtherSignIsStopped) {
  flaws_.shown_position = -1;
  begin();
  go_on(TryStep::home);
  EXPECT_EQ(verdict(TryStep::moves), Verdict::wrong);
  EXPECT_LT(std::abs(turned_), 2);
}

TEST_F(TryPlanTest, AStopThatStopsNothingIsWrongAndTheTorqueIsTakenAway) {
  flaws_.stops_nothing = true;
  begin();
  go_on(TryStep::home);
  EXPECT_EQ(verdict(TryStep::moves), Verdict::wrong);
  EXPECT_THAT(saw(TryStep::moves), HasSubstr("quick_stop: the motor did not stand within"));
  expect_ended_safely();
  EXPECT_EQ(verdict(TryStep::stops), Verdict::not_tried);
}

TEST_F(TryPlanTest, AShaftThatMovesWhileItIsHeldIsWrong) {
  flaws_.creeps = true;
  begin();
  go_on(TryStep::moves);
  EXPECT_EQ(verdict(TryStep::torque), Verdict::wrong);
  EXPECT_THAT(saw(TryStep::torque), HasSubstr("moved by"));
  expect_ended_safely();
}

TEST_F(TryPlanTest, ADriveThatFallsSilentInAMotionIsNeverSaidToStand) {
  begin();
  consent_to(TryStep::moves);
  while (turned_ < 0.01) step();
  answers_ = false;
  until_over();
  EXPECT_EQ(verdict(TryStep::moves), Verdict::wrong);
  EXPECT_THAT(saw(TryStep::moves), HasSubstr("silent"));
  EXPECT_THAT(plan_->report().ended, HasSubstr("is wrong"));
  EXPECT_THAT(words_, Contains(HasSubstr("THE DRIVE DOES NOT ANSWER")));
  EXPECT_THAT(words_, Not(Contains(HasSubstr("stands and has no torque"))));
}

TEST_F(TryPlanTest, ADriveThatComesBackWithinTheEndingIsStoppedAndDisabled) {
  begin();
  consent_to(TryStep::moves);
  while (turned_ < 0.01) step();
  answers_ = false;
  for (int i = 0; i < 100; ++i) step();
  answers_ = true;
  expect_ended_safely();
  EXPECT_THAT(words_, Contains(HasSubstr("stands and has no torque")));
}

TEST_F(TryPlanTest, CtrlCInAMotionStopsAtTheNextLookAndDisables) {
  begin();
  consent_to(TryStep::stops);
  const double from = turned_;
  while (std::abs(turned_ - from) < 0.1) step();
  const double at = turned_;
  plan_->end("Ctrl-C");
  step();
  EXPECT_EQ(commands_.back(), Command::quick_stop);
  expect_ended_safely();
  EXPECT_LT(std::abs(turned_ - at), 0.5);
  EXPECT_EQ(plan_->report().ended, "Ctrl-C");
}

TEST_F(TryPlanTest, ADriveThatIgnoresTheLossOfTheGatewayIsStopped) {
  flaws_.ignores_loss = true;
  begin();
  go_on(TryStep::home);
  expect_ended_safely();
  EXPECT_EQ(verdict(TryStep::loss), Verdict::wrong);
  EXPECT_THAT(orders_, Contains(TryOrder::Kind::resume));
  EXPECT_TRUE(sees_heartbeats_);
}

TEST_F(TryPlanTest, WithoutKnownUnitsNothingMoves) {
  flaws_.no_units = true;
  begin();
  go_on(TryStep::home);
  until_over();
  EXPECT_EQ(verdict(TryStep::moves), Verdict::not_tried);
  EXPECT_THAT(saw(TryStep::moves), HasSubstr("position_actual has no value"));
  EXPECT_EQ(turned_, 0);
}

TEST_F(TryPlanTest, AnOpenQuestionKeepsWhatItForbidsFromBeingTried) {
  begin({.open_before = {"velocity"}});
  go_on(TryStep::home);
  until_over();
  EXPECT_EQ(verdict(TryStep::torque), Verdict::right);
  EXPECT_EQ(verdict(TryStep::moves), Verdict::not_tried);
  EXPECT_THAT(saw(TryStep::moves), HasSubstr("open question of the profile forbids velocity"));
  EXPECT_EQ(turned_, 0);
  begin({.open_before = {"enable"}});
  go_on(TryStep::home);
  until_over();
  EXPECT_EQ(verdict(TryStep::torque), Verdict::not_tried);
}

TEST_F(TryPlanTest, ADriveWithoutAPositionIsJudgedByThePerson) {
  image_.supported &= ~bit(Quantity::position_actual);
  begin();
  consent_to(TryStep::torque);
  until_asked();
  EXPECT_THAT(words_.back(), HasSubstr("did the shaft stay where it was"));
  EXPECT_FALSE(enabled_) << "nobody is waited for with torque";
  say("no");
  until_over();
  EXPECT_EQ(verdict(TryStep::torque), Verdict::wrong);
}

TEST_F(TryPlanTest, ATurnedShaftGivesTheCountsOfATurn) {
  begin();
  until_asked();
  turned_ += 4;
  say("");
  until_over();
  EXPECT_EQ(verdict(TryStep::turn), Verdict::wrong);
  EXPECT_THAT(saw(TryStep::turn), HasSubstr("a turn has 40000 counts, the profile says 10000"));
}

TEST_F(TryPlanTest, ATurnedShaftShowsTheOtherWordOrder) {
  begin();
  raw_positions_ = {5U << 16};
  until_asked();
  raw_positions_ = {(10005U & 0xFFFFU) << 16};
  turned_ += 10000.0 * 65536 / kCounts;
  say("");
  until_over();
  EXPECT_THAT(saw(TryStep::turn), HasSubstr("other word order it is one turn"));
}

TEST_F(TryPlanTest, OneTurnOfTheShaftIsRight) {
  begin();
  until_asked();
  turned_ -= 1.05;
  say("");
  go_on(TryStep::torque);
  EXPECT_EQ(verdict(TryStep::turn), Verdict::right);
  EXPECT_THAT(saw(TryStep::turn), HasSubstr("clockwise counts down"));
}

}  // namespace
}  // namespace axisgate::commands
