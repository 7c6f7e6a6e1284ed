// Every step of the commands that move an axis by hand, done and failing, against an axis written down here.
#include "gateway/app/hand_plan.hpp"

#include <gmock/gmock.h>

#include <deque>
#include <utility>

namespace axisgate::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using What = HandWrite::What;
using Exception = ModbusException;

constexpr Duration kMs = std::chrono::milliseconds(1);

HandWrite stop(Command command) { return {.what = What::stop, .command = command}; }
HandWrite command(Command command, std::uint16_t id) { return {.what = What::command, .command = command, .id = id}; }
HandWrite coil(std::uint16_t offset, bool on) { return {.what = What::coil, .coil = offset, .on = on}; }

class ByHand : public ::testing::Test {
 protected:
  void begin(HandTask task, bool enable = true) {
    order_.task = task;
    order_.axis = 4;
    order_.turns = Rational(5, 2);
    order_.enable = enable;
    plan_.emplace(order_, now_);
    box_.clear();
    unanswered_.clear();
    view_ = {};
    view_.link = LinkState::online;
    view_.state = AxisState::disabled;
    view_.command_id_seen = 40;
    view_.turns = 0.0;
    view_.inputs = bit(AxisInput::online);
  }
  void set(AxisInput input, bool on = true) {
    view_.inputs = static_cast<std::uint16_t>(on ? view_.inputs | bit(input) : view_.inputs & ~bit(input));
  }
  void look() {
    carry();
    plan_->on_view(view_, plan_->answered(), now_);
  }
  /// What the plan has written is on its way; signs of life are answered in their turn.
  void carry() {
    for (const HandWrite& write : plan_->take()) {
      const bool beat = write.what == What::heartbeat;
      unanswered_.push_back(beat);
      if (beat)
        ++beats_;
      else
        box_.push_back(write);
    }
    while (!unanswered_.empty() && unanswered_.front()) {
      unanswered_.pop_front();
      plan_->on_answer(Exception::none, now_);
    }
  }
  void answer(Exception exception = Exception::none) {
    carry();
    ASSERT_FALSE(unanswered_.empty());
    unanswered_.pop_front();
    plan_->on_answer(exception, now_);
    carry();
  }
  /// What is written now, signs of life left out.
  std::vector<HandWrite> written() {
    carry();
    return std::exchange(box_, {});
  }
  /// In steps, as a loop does it.
  void pass(Duration time) {
    for (const Instant until = now_ + time; now_ < until;) {
      now_ += 10 * kMs;
      if (plan_->due() <= now_) plan_->on_time(now_);
    }
  }
  void press(HandKey key) { plan_->on_keys({key}, now_); }
  /// Up to the answer that the axis is enabled.
  void enabled() {
    look();
    EXPECT_THAT(written(), ElementsAre(command(Command::none, 41)));
    answer();
    EXPECT_THAT(written(), ElementsAre(command(Command::enable, 42)));
    answer();
    set(AxisInput::enabled);
    view_.owner = 1;
    view_.lease_remaining_ms = 2000;
    look();
  }
  void moving() {
    begin(HandTask::move);
    enabled();
    EXPECT_THAT(written(), ElementsAre(HandWrite{.what = What::target_position, .number = Rational(5, 2)}));
    answer();
    EXPECT_THAT(written(), ElementsAre(command(Command::move_absolute, 43)));
    answer();
    set(AxisInput::moving);
    view_.motion_id = 43;
    view_.motion = MotionState::active;
    look();
    EXPECT_THAT(written(), IsEmpty());
  }
  void jogging() {
    begin(HandTask::jog);
    enabled();
    EXPECT_THAT(written(), ElementsAre(coil(8, false), coil(9, false)));
    answer();
    answer();
    look();
  }
  void stand() {
    set(AxisInput::moving, false);
    pass(HandPlan::kStill + 10 * kMs);
    look();
  }
  /// Its torque goes back, its lease goes back.
  void given_back(std::uint16_t id) {
    EXPECT_THAT(written(), ElementsAre(stop(Command::disable)));
    answer();
    EXPECT_THAT(written(), ElementsAre(command(Command::release, id)));
    EXPECT_FALSE(plan_->over());
    answer();
    EXPECT_TRUE(plan_->over());
  }
  void stopped_and_given_back(std::uint16_t id) {
    EXPECT_THAT(written(), ElementsAre(stop(Command::quick_stop)));
    answer();
    look();
    EXPECT_THAT(written(), IsEmpty()) << "torque that is taken from a motor that turns lets it coast";
    stand();
    given_back(id);
    EXPECT_EQ(plan_->exit_code(), 1);
  }

  HandOrder order_;
  std::optional<HandPlan> plan_;
  HandView view_;
  Instant now_ = Instant(std::chrono::hours(1));
  int beats_ = 0;
  std::vector<HandWrite> box_;
  std::deque<bool> unanswered_;  ///< true: a sign of life
};

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
  moving();
  view_.motion_id = 17;
  view_.motion = MotionState::completed;
  look();
  pass(std::chrono::seconds(2));
  look();
  EXPECT_THAT(written(), IsEmpty());
}

TEST_F(ByHand, ALookFromBeforeAnAnswerCountsForNothing) {
  moving();
  view_.motion = MotionState::completed;
  plan_->on_view(view_, plan_->answered() - 1, now_);
  EXPECT_THAT(written(), IsEmpty());
  pass(HandPlan::kStill);
  EXPECT_EQ(plan_->doing(), "to 2.5 turns; Ctrl-C stops");
}

TEST_F(ByHand, AnEnabledAxisIsLeftEnabled) {
  begin(HandTask::move, false);
  set(AxisInput::enabled);
  look();
  EXPECT_THAT(written(), ElementsAre(command(Command::none, 41)));
  answer();
  EXPECT_THAT(written(), ElementsAre(HandWrite{.what = What::target_position, .number = Rational(5, 2)}));
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
  begin(HandTask::move, false);
  refused("axis 4 is disabled: --enable enables it for this move");
  begin(HandTask::jog, false);
  set(AxisInput::enabled), set(AxisInput::stop_latched);
  refused("stopped and latched: --enable");
  begin(HandTask::enable);
  view_.owner = 2, view_.owner_address = 0x0A000007;
  refused("owned by 10.0.0.7");
  begin(HandTask::enable);
  view_.link = LinkState::offline;
  refused("out of reach (link offline): nothing was sent");
  begin(HandTask::enable);
  set(AxisInput::fault), view_.error_code = 0x3130;
  refused("error_code 0x3130: axisgate explain 0x3130");
}

TEST_F(ByHand, EachStepThatIsRefusedSaysWhichAndWhy) {
  begin(HandTask::move);
  order_.rpm = Rational(60);
  plan_.emplace(order_, now_);
  look();
  EXPECT_THAT(written(), ElementsAre(command(Command::none, 41)));
  answer();
  EXPECT_THAT(written(), ElementsAre(HandWrite{.what = What::profile_velocity, .number = Rational(60)}));
  answer(Exception::illegal_data_value);
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("profile_velocity was refused with exception 0x03"));
  EXPECT_THAT(plan_->words(), HasSubstr("beyond the limits"));
  EXPECT_THAT(written(), ElementsAre(command(Command::release, 42))) << "nothing was enabled, nothing moved";

  order_.rpm.reset();
  begin(HandTask::enable);
  look();
  static_cast<void>(written());
  answer();
  static_cast<void>(written());
  answer(Exception::server_device_failure);
  view_.result = CommandResult::state_unsuitable;
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("enable was refused with exception 0x04"));
  EXPECT_THAT(plan_->words(), HasSubstr("result 9"));
  given_back(43);
}

TEST_F(ByHand, AStartThatIsRefusedBeforeItBeganStopsNothing) {
  begin(HandTask::move);
  enabled();
  static_cast<void>(written());
  answer();
  static_cast<void>(written());
  answer(Exception::server_device_busy);
  look();
  given_back(44);
}

TEST_F(ByHand, AStartOfWhichNobodyKnowsWhetherItBeganIsStopped) {
  begin(HandTask::move);
  enabled();
  static_cast<void>(written());
  answer();
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
  set(AxisInput::fault);
  look();
  stopped_and_given_back(44);
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
  static_cast<void>(written());
  answer();
  pass(HandPlan::kStandLimit + 20 * kMs);
  EXPECT_THAT(written(), ElementsAre(command(Command::release, 44)));
  EXPECT_THAT(plan_->words(), HasSubstr("was not seen to stand within 20 s"));
}

TEST_F(ByHand, AnEndWhileAnAnswerIsWaitedForIsNotTakenForward) {
  begin(HandTask::move);
  enabled();
  static_cast<void>(written());
  answer();
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
  begin(HandTask::stop);
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
  begin(HandTask::stop);
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
  begin(HandTask::enable);
  enabled();
  for (int i = 0; i < 10; ++i) {
    pass(HandPlan::kHeartbeat);
    EXPECT_THAT(written(), IsEmpty());
    look();
  }
  EXPECT_GE(beats_, 9);
  plan_->end("Ctrl-C", now_);
  given_back(43);
  EXPECT_EQ(plan_->exit_code(), 0);
  EXPECT_EQ(plan_->words(), "Ctrl-C: axis 4 is disabled");
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

TEST_F(ByHand, ALostNetworkIsToldWithWhatStopsTheAxisThen) {
  moving();
  plan_->lost("no answer in time");
  EXPECT_TRUE(plan_->over());
  EXPECT_THAT(plan_->words(), HasSubstr("it stops axis 4 when its lease runs out, within 2000 ms"));
  begin(HandTask::move);
  look();
  static_cast<void>(written());
  answer();
  plan_->lost("no answer in time");
  EXPECT_THAT(plan_->words(), HasSubstr("axis 4 has no lease"));
}

TEST_F(ByHand, ANumberThatDoesNotFitMovesNothing) {
  begin(HandTask::move);
  enabled();
  static_cast<void>(written());
  plan_->refuse_number(now_);
  given_back(43);
  EXPECT_THAT(plan_->words(), HasSubstr("2.5 turns does not fit its register"));
}

// Jog.

TEST_F(ByHand, AKeyPressesAndEachRepeatPressesAgainAndNothingElseDoes) {
  jogging();
  pass(std::chrono::seconds(2));
  EXPECT_THAT(written(), IsEmpty()) << "no key, no button";
  for (int i = 0; i < 5; ++i) {
    press(HandKey::forward);
    EXPECT_THAT(written(), ElementsAre(coil(8, true)));
    answer();
    pass(30 * kMs);
    EXPECT_THAT(written(), IsEmpty()) << "time alone presses nothing";
  }
}

TEST_F(ByHand, ThreeHundredMillisecondsWithoutAKeyLetGo) {
  jogging();
  press(HandKey::reverse);
  EXPECT_THAT(written(), ElementsAre(coil(9, true)));
  pass(HandPlan::kKeyLapse - 10 * kMs);
  EXPECT_THAT(written(), IsEmpty());
  pass(10 * kMs);
  EXPECT_THAT(written(), ElementsAre(coil(9, false)));
  pass(std::chrono::seconds(2));
  EXPECT_THAT(written(), IsEmpty()) << "once";
}

TEST_F(ByHand, APressThatIsNotAnsweredYetIsNotPressedAgain) {
  jogging();
  press(HandKey::forward);
  EXPECT_THAT(written(), ElementsAre(coil(8, true)));
  for (int i = 0; i < 20; ++i) {
    pass(30 * kMs);
    press(HandKey::forward);
  }
  EXPECT_THAT(written(), IsEmpty()) << "what waited in a slow network would be pressed late";
}

TEST_F(ByHand, AnotherKeyLetsGoAtOnceAndTheOtherArrowFirstLetsGo) {
  jogging();
  press(HandKey::forward);
  press(HandKey::other);
  EXPECT_THAT(written(), ElementsAre(coil(8, true), coil(8, false)));
  answer();
  answer();
  press(HandKey::forward);
  EXPECT_THAT(written(), ElementsAre(coil(8, true)));
  answer();
  press(HandKey::reverse);
  EXPECT_THAT(written(), ElementsAre(coil(8, false)));
  answer();
  press(HandKey::reverse);
  EXPECT_THAT(written(), ElementsAre(coil(9, true)));
}

TEST_F(ByHand, AProcessThatStoodStillLetsGo) {
  jogging();
  press(HandKey::forward);
  static_cast<void>(written());
  plan_->on_stall();
  EXPECT_THAT(written(), ElementsAre(coil(8, false)));
}

TEST_F(ByHand, QLetsGoWaitsAndGivesBack) {
  jogging();
  press(HandKey::forward);
  static_cast<void>(written());
  answer();
  press(HandKey::quit);
  EXPECT_THAT(written(), ElementsAre(coil(8, false), stop(Command::quick_stop)));
  answer();
  answer();
  stand();
  given_back(43);
  EXPECT_EQ(plan_->exit_code(), 0);
}

TEST_F(ByHand, QOnAnAxisThatStandsNeedsNoStop) {
  jogging();
  press(HandKey::quit);
  given_back(43);
  EXPECT_EQ(plan_->exit_code(), 0);
}

TEST_F(ByHand, APressThatTheGatewayHasEndedNeedsTheKeyAnew) {
  jogging();
  press(HandKey::forward);
  static_cast<void>(written());
  answer(Exception::server_device_busy);
  EXPECT_THAT(written(), ElementsAre(coil(8, false)));
  answer();
  EXPECT_FALSE(plan_->over());
  press(HandKey::forward);
  EXPECT_THAT(written(), ElementsAre(coil(8, true)));
}

TEST_F(ByHand, APressThatIsRefusedForGoodEndsIt) {
  jogging();
  press(HandKey::forward);
  static_cast<void>(written());
  answer(Exception::illegal_data_value);
  EXPECT_THAT(written(), ElementsAre(coil(8, false)));
  answer();
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("jog was refused with exception 0x03"));
  stopped_and_given_back(43);
}

}  // namespace
}  // namespace axisgate::app
