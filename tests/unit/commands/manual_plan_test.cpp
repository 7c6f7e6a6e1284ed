// SPDX-License-Identifier: Apache-2.0
// Every step of the commands that move an axis by hand, done and failing, against an axis written down here.
#include "tests/unit/commands/manual_rig.hpp"

namespace axisgate::commands {
namespace {

using ::testing::HasSubstr;

TEST_F(ByHand, AMoveEnablesStartsWaitsAndGivesBack) {
  moving();
  view_.turns = 2.5;
  view_.motion = MotionState::completed;
  look();
  EXPECT_THAT(written(), IsEmpty()) << "no stop is needed at the target";
  stand();
  given_back(44);
  EXPECT_EQ(plan_->exit_code(), 0);
  EXPECT_THAT(plan_->words(), HasSubstr("reached: axis 4  2.5000 turns"));
}

TEST_F(ByHand, AMoveOfTheIdBeforeIsNotItsOwn) {
  begin(ManualTask::move);
  view_.motion_id = 17;
  view_.motion = MotionState::completed;
  enabled();
  answer_unseen();
  answer_unseen();
  look();
  pass(std::chrono::seconds(2));
  look();
  EXPECT_THAT(written(), IsEmpty());
}

TEST_F(ByHand, AMoveWhosePlaceAnotherMotionTookHasFailed) {
  const auto taken_by = [&](std::uint16_t id) {
    view_.motion_id = id;
    view_.motion = MotionState::active;
    look();
    stopped_and_given_back(44);
    EXPECT_EQ(plan_->exit_code(), 1);
    EXPECT_EQ(plan_->words(), "the move of axis 4 has ended: another motion took its place");
  };
  moving();
  taken_by(17);
  moving();
  taken_by(0);  // what it was before
  begin(ManualTask::move);
  enabled();
  answer_unseen();
  answer_unseen();
  taken_by(17);  // before a look has shown the own one
}

TEST_F(ByHand, ALookFromBeforeAnAnswerCountsForNothing) {
  moving();
  view_.motion = MotionState::completed;
  plan_->on_view(view_, plan_->answered() - 1, now_);
  EXPECT_THAT(written(), IsEmpty());
  pass(ManualPlan::kStill);
  EXPECT_EQ(plan_->doing(), "to 2.5 turns; Ctrl-C stops");
}

TEST_F(ByHand, AnEnabledAxisIsLeftEnabled) {
  begin(ManualTask::move, false);
  set(AxisInput::enabled);
  look();
  EXPECT_THAT(written(), ElementsAre(command(Command::none, 41)));
  answer();
  EXPECT_THAT(written(), ElementsAre(ManualWrite{.what = What::target_position, .number = Rational(5, 2)}));
  answer();
  EXPECT_THAT(written(), ElementsAre(command(Command::move_absolute, 42)));
  answer();
  view_.motion_id = 42;
  view_.motion = MotionState::completed;
  look();
  stand();
  EXPECT_THAT(written(), ElementsAre(command(Command::release, 43)));
  answer();
  EXPECT_EQ(plan_->exit_code(), 0);
}

TEST_F(ByHand, NothingIsWrittenToAnAxisThatIsNotReadyForIt) {
  const auto refused = [&](const char* words) {
    look();
    EXPECT_TRUE(plan_->over());
    EXPECT_EQ(plan_->exit_code(), 1);
    EXPECT_THAT(plan_->words(), HasSubstr(words));
    EXPECT_THAT(plan_->take(), IsEmpty());
    EXPECT_EQ(plan_->due(), kNever);
  };
  begin(ManualTask::move, false);
  refused("axis 4 is disabled: --enable enables it for this move");
  begin(ManualTask::jog, false);
  set(AxisInput::enabled), set(AxisInput::stop_latched);
  refused("stopped and latched: --enable");
  begin(ManualTask::enable);
  view_.owner = 2, view_.owner_address = 0x0A000007;
  refused("owned by 10.0.0.7");
  begin(ManualTask::enable);
  view_.link = LinkState::offline;
  refused("out of reach (link offline): nothing was sent");
  begin(ManualTask::enable);
  set(AxisInput::fault), view_.error_code = 0xFFFF, look();
  EXPECT_FALSE(plan_->over()) << "its cause is not known yet";
  view_.error_code = 0x3130, refused("error_code 0x3130: axisgate explain 0x3130");
}

TEST_F(ByHand, EachStepThatIsRefusedSaysWhichAndWhy) {
  begin(ManualTask::move);
  arguments_.rpm = Rational(60);
  plan_.emplace(arguments_, now_);
  look();
  EXPECT_THAT(written(), ElementsAre(command(Command::none, 41)));
  answer();
  EXPECT_THAT(written(), ElementsAre(ManualWrite{.what = What::profile_velocity, .number = Rational(60)}));
  answer(Exception::illegal_data_value);
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("profile_velocity was refused with exception 0x03"));
  EXPECT_THAT(plan_->words(), HasSubstr("beyond the limits of the axis"));
  EXPECT_THAT(written(), ElementsAre(command(Command::release, 42))) << "nothing was enabled, nothing moved";

  arguments_.rpm.reset();
  begin(ManualTask::enable);
  look();
  answer_unseen();
  static_cast<void>(written());
  answer(Exception::server_device_failure);
  view_.result = CommandResult::state_unsuitable;
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("enable was refused with exception 0x04"));
  EXPECT_THAT(plan_->words(), HasSubstr("result 9"));
  given_back(43);
}

/// Key "writes": "posted": answered before it is done.
TEST_F(ByHand, AnEnableThatIsOnItsWayIsAwaited) {
  begin(ManualTask::move);
  look();
  answer_unseen();
  EXPECT_THAT(written(), ElementsAre(command(Command::enable, 42)));
  answer();
  view_.command_id_seen = 42;
  view_.result = CommandResult::pending;
  for (int i = 0; i < 3; ++i) {
    look();
    EXPECT_THAT(written(), IsEmpty());
  }
  view_.result = CommandResult::done;
  set(AxisInput::enabled);
  look();
  EXPECT_THAT(written(), ElementsAre(ManualWrite{.what = What::target_position, .number = Rational(5, 2)}));
}

TEST_F(ByHand, ASetPointThatIsOnItsWayIsAwaitedBeforeTheNextStep) {
  looks_at_set_points_ = false;
  arguments_.rpm = Rational(60);
  begin(ManualTask::move);
  set(AxisInput::enabled);
  look();
  answer_unseen();
  EXPECT_THAT(written(), ElementsAre(ManualWrite{.what = What::profile_velocity, .number = Rational(60)}));
  for (const auto& next :
       {ManualWrite{.what = What::target_position, .number = Rational(5, 2)}, command(Command::move_absolute, 42)}) {
    answer();
    EXPECT_THAT(written(), IsEmpty()) << "no look has shown its result";
    view_.result = CommandResult::pending;
    look();
    EXPECT_THAT(written(), IsEmpty());
    view_.result = CommandResult::done;
    look();
    EXPECT_THAT(written(), ElementsAre(next));
  }
}

TEST_F(ByHand, ASetPointThatFailsLaterStartsNothing) {
  begin(ManualTask::move);
  set(AxisInput::enabled);
  look();
  answer_unseen();
  view_.result = CommandResult::refused_by_drive;
  answer_unseen();
  EXPECT_THAT(plan_->words(), HasSubstr("axis 4: target_position was not carried out, result 3"));
  EXPECT_EQ(plan_->exit_code(), 1);
}

TEST_F(ByHand, AnEnableOrAStartThatFailsLaterSaysWhy) {
  begin(ManualTask::jog);
  look();
  answer_unseen();
  answer_unseen();
  view_.command_id_seen = 42;
  view_.result = CommandResult::state_unsuitable;
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("axis 4: enable was not carried out, result 9"));
  EXPECT_EQ(plan_->exit_code(), 1);
  given_back(43);

  begin(ManualTask::move);
  enabled();
  answer_unseen();
  answer_unseen();
  view_.command_id_seen = 43;
  view_.result = CommandResult::refused_by_drive;
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("axis 4: move_absolute was not carried out, result 3"));
  stopped_and_given_back(44);
}

TEST_F(ByHand, AStartThatIsRefusedBeforeItBeganStopsNothing) {
  begin(ManualTask::move);
  enabled();
  answer_unseen();
  static_cast<void>(written());
  answer(Exception::server_device_busy);
  look();
  given_back(44);
}

TEST_F(ByHand, AStartOfWhichNobodyKnowsWhetherItBeganIsStopped) {
  begin(ManualTask::move);
  enabled();
  answer_unseen();
  static_cast<void>(written());
  answer(Exception::gateway_target_failed);
  look();
  stopped_and_given_back(44);
}

TEST_F(ByHand, HoweverAMoveEndsTheAxisIsStoppedBeforeItsTorqueGoes) {
  moving();
  plan_->end("Ctrl-C", now_);
  stopped_and_given_back(44);
  EXPECT_EQ(plan_->words(), "Ctrl-C: axis 4 is stopped");
  moving();
  view_.motion = MotionState::aborted;
  look();
  stopped_and_given_back(44);
  moving();
  set(AxisInput::fault), view_.error_code = 0xFFFF, look();
  view_.error_code = 0x3130, stopped_and_given_back(44);
  EXPECT_EQ(plan_->words(), "axis 4 has a fault, error_code 0x3130: axisgate explain 0x3130");
  moving();
  set(AxisInput::stop_latched);
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("was stopped by another client, its lease or its drive"));
  stopped_and_given_back(44);
}

TEST_F(ByHand, AMotorThatHasJustBegunToTurnIsNotTakenForOneThatStands) {
  moving();
  set(AxisInput::moving, false);  // a drive's speed is old
  plan_->end("Ctrl-C", now_);
  EXPECT_THAT(written(), ElementsAre(stop(Command::quick_stop)));
  answer();
  for (int i = 0; i < 20; ++i) {
    *view_.turns += 0.05;
    pass(50 * kMs);
    look();
    EXPECT_THAT(written(), IsEmpty()) << i;
  }
  stand();
  given_back(44);
}

TEST_F(ByHand, AMotorThatNeverStandsKeepsItsTorqueAndIsTold) {
  moving();
  plan_->end("Ctrl-C", now_);
  answer_unseen();
  pass(ManualPlan::kStandLimit + 20 * kMs);
  EXPECT_THAT(written(), ElementsAre(command(Command::release, 44)));
  EXPECT_THAT(plan_->words(), HasSubstr("was not seen to stand within 20 s"));
}

TEST_F(ByHand, AnEndWhileAnAnswerIsWaitedForIsNotTakenForward) {
  begin(ManualTask::move);
  enabled();
  answer_unseen();
  EXPECT_THAT(written(), ElementsAre(command(Command::move_absolute, 43)));
  plan_->end("Ctrl-C", now_);
  EXPECT_THAT(written(), ElementsAre(stop(Command::quick_stop)));
  answer(Exception::server_device_busy);  // the start's
  stand();
  EXPECT_THAT(written(), IsEmpty()) << "the stop was not answered yet";
  answer();
  stand();
  given_back(44);
}

TEST_F(ByHand, ANewOwnerKeepsTheTorqueAndIsSentAStopAlone) {
  moving();
  view_.owner = 2;
  look();
  EXPECT_THAT(written(), ElementsAre(stop(Command::quick_stop)));
  answer();
  stand();
  EXPECT_TRUE(plan_->over());
  EXPECT_THAT(plan_->words(), HasSubstr("was taken over by another client"));
}

TEST_F(ByHand, AStopThatIsRefusedIsToldLoudly) {
  begin(ManualTask::stop);
  EXPECT_THAT(written(), ElementsAre(stop(Command::quick_stop)));
  answer(Exception::gateway_path_unavailable);
  view_.link = LinkState::offline;
  look();
  EXPECT_TRUE(plan_->over());
  EXPECT_EQ(plan_->exit_code(), 1);
  EXPECT_THAT(plan_->words(),
              HasSubstr("it is owed, and carried out as soon as the drive is back; stop it by its wired stop"));
}

TEST_F(ByHand, AStopAsksNobodyAndWaitsUntilTheMotorStands) {
  begin(ManualTask::stop);
  view_.owner = 2;
  set(AxisInput::moving);
  EXPECT_THAT(written(), ElementsAre(stop(Command::quick_stop))) << "before any look";
  answer();
  look();
  EXPECT_FALSE(plan_->over());
  stand();
  EXPECT_TRUE(plan_->over());
  EXPECT_EQ(plan_->exit_code(), 0);
  EXPECT_EQ(beats_, 0) << "it owns nothing";
}

TEST_F(ByHand, EnableHoldsWithSignsOfLifeAndGivesBackWithoutAStop) {
  begin(ManualTask::enable);
  enabled();
  for (int i = 0; i < 10; ++i) {
    pass(ManualPlan::kHeartbeat);
    EXPECT_THAT(written(), IsEmpty());
    look();
  }
  EXPECT_GE(beats_, 9);
  plan_->end("Ctrl-C", now_);
  given_back(43);
  EXPECT_EQ(plan_->exit_code(), 0);
  EXPECT_EQ(plan_->words(), "Ctrl-C: axis 4 is disabled");
}

TEST_F(ByHand, ASignOfLifeThatIsNotAnsweredIsFollowedByNoOther) {
  begin(ManualTask::enable);
  enabled();
  for (int i = 0; i < 3; ++i) plan_->on_time(now_ += ManualPlan::kHeartbeat);
  EXPECT_THAT(plan_->take(), ::testing::SizeIs(1));
}

TEST_F(ByHand, TheIdBehindTheLastOneIsNotTheOneThatIsNone) {
  begin(ManualTask::enable);
  view_.command_id_seen = 65535;
  look();
  EXPECT_THAT(written(), ElementsAre(command(Command::none, 1)));
}

TEST_F(ByHand, ASecondEndDoesNotWait) {
  moving();
  plan_->end("Ctrl-C", now_);
  plan_->end("the terminal is gone", now_);
  EXPECT_THAT(written(), ElementsAre(stop(Command::quick_stop))) << "told again, it is nothing new";
  plan_->end_at_once();
  EXPECT_TRUE(plan_->over());
  EXPECT_EQ(plan_->exit_code(), 1);
}

/// Which of the two has failed, gateway or network, nobody here knows.
TEST_F(ByHand, AGatewayOutOfReachIsToldWithWhatStopsTheAxisThenAndWhatDoesNot) {
  const auto said = [&](std::uint16_t loss_stop_ms) {
    view_.loss_stop_ms = loss_stop_ms;
    look();
    plan_->lost("no answer in time");
    EXPECT_TRUE(plan_->over());
    EXPECT_EQ(plan_->exit_code(), 1);
    return plan_->words();
  };
  moving();
  EXPECT_EQ(said(kGoesOn),
            "the gateway is out of reach (no answer in time)\n"
            "  if the gateway has died: axis 4 GOES ON: use its wired stop\n"
            "  if only the network has failed: axis 4 is stopped as its lease says, within 2000 ms");
  moving();
  EXPECT_THAT(said(1500), HasSubstr("has died: the drive begins to stop by itself within 1500 ms\n"));
  moving();
  EXPECT_THAT(said(kLossNotKnown), HasSubstr("has died: nobody knows whether axis 4 stops: use its wired stop\n"));
  begin(ManualTask::move);
  look();
  answer_unseen();
  EXPECT_THAT(said(kGoesOn), HasSubstr("failed: axis 4 goes on, for it has no lease: only a stop ends that"));
}

TEST_F(ByHand, ANumberThatDoesNotFitMovesNothing) {
  begin(ManualTask::move);
  enabled();
  static_cast<void>(written());
  plan_->refuse_number(now_);
  given_back(43);
  EXPECT_THAT(plan_->words(), HasSubstr("2.5 turns does not fit its register"));
}

}  // namespace
}  // namespace axisgate::commands
