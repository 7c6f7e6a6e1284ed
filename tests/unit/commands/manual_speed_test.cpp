// SPDX-License-Identifier: Apache-2.0
// The speed of a command by hand: told before anything moves, 60 rpm unless asked otherwise, and set back. And the
// words of what is refused by a limit or an alarm.
#include "tests/unit/commands/manual_rig.hpp"

namespace axisgate::commands {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

ManualWrite speed(std::int64_t rpm) { return {.what = What::profile_velocity, .number = Rational(rpm)}; }

class Speed : public ByHand {
 protected:
  /// Up to the write of the speed.
  void asks(const ManualWrite& expected) {
    begin(ManualTask::move);
    view_.can.supported = bit(Quantity::profile_velocity);
    view_.profile_rpm = Rational(2344);
    look();
    answer_unseen();
    EXPECT_THAT(written(), ElementsAre(expected));
  }
};

TEST_F(Speed, Is60UnlessAskedOtherwiseIsToldBeforeTheEnableAndIsSetBack) {
  asks(speed(60));
  view_.profile_rpm = Rational(60);
  view_.loss_stop_ms = kGoesOn;
  EXPECT_THAT(plan_->take_notes(), IsEmpty());
  answer();
  EXPECT_THAT(plan_->take_notes(), ElementsAre("axis 4 turns at 60 rpm; --velocity sets another speed",
                                               "if the gateway dies it GOES ON: keep its wired stop in reach"));
  EXPECT_THAT(written(), ElementsAre(command(Command::enable, 42))) << "nothing was enabled before";
  plan_->end("Ctrl-C", now_);
  answer();
  EXPECT_THAT(written(), ElementsAre(stop(Command::disable)));
  answer();
  EXPECT_THAT(written(), ElementsAre(speed(2344))) << "as it was";
  answer();
  EXPECT_THAT(written(), ElementsAre(command(Command::release, 43)));
}

TEST_F(Speed, IsTheAxisLimitWhereThatIsLess) {
  asks(speed(60));
  answer(Exception::illegal_data_value);
  view_.detail = 3000;  // 0.001 rpm
  look();
  EXPECT_THAT(written(), ElementsAre(speed(3)));
  view_.detail = 0;
  view_.profile_rpm = Rational(3);
  answer();
  EXPECT_THAT(plan_->take_notes().front(), StartsWith("axis 4 turns at 3 rpm, its limit"));
  EXPECT_THAT(written(), ElementsAre(command(Command::enable, 42)));
}

TEST_F(Speed, BeyondALimitNamesTheLimitAndMovesNothing) {
  arguments_.rpm = Rational(400);
  asks(speed(400));
  answer(Exception::illegal_data_value);
  view_.detail = 300'000;
  look();
  EXPECT_THAT(plan_->words(),
              HasSubstr("profile_velocity was refused with exception 0x03 illegal data value: 400 rpm is "
                        "beyond the limit of 300 rpm"));
  EXPECT_THAT(written(), ElementsAre(command(Command::release, 42)));
}

TEST_F(Speed, ThatIsUsualIsNeverRaisedToALimitAboveIt) {
  asks(speed(60));
  answer(Exception::illegal_data_value);
  view_.detail = 100'000;
  look();
  EXPECT_THAT(written(), ElementsAre(command(Command::release, 42)));
}

TEST_F(Speed, AboveTheRatedSpeedOfTheMotorIsNotEvenSent) {
  arguments_.rpm = Rational(99999);
  begin(ManualTask::move);
  view_.rated_rpm = Rational(3000);
  look();
  EXPECT_TRUE(plan_->over());
  EXPECT_EQ(plan_->words(), "99999 rpm is above the rated speed of the motor of axis 4, 3000 rpm: nothing was sent");
  EXPECT_THAT(plan_->take(), IsEmpty());
}

TEST_F(Speed, ADriveWithoutOneMovesAtItsOwnAndThatIsSaid) {
  begin(ManualTask::move);
  look();
  answer_unseen();
  EXPECT_THAT(written(), ElementsAre(command(Command::enable, 42)));
  EXPECT_THAT(plan_->take_notes().front(), HasSubstr("axis 4 turns at the drive's own speed"));
}

TEST_F(Speed, ATargetBeyondALimitNamesItInTurns) {
  begin(ManualTask::move);
  enabled();
  answer_unseen();
  static_cast<void>(written());
  begin(ManualTask::move, false);
  set(AxisInput::enabled);
  look();
  answer_unseen();
  static_cast<void>(written());
  answer(Exception::illegal_data_value);
  view_.detail = 10'000;
  look();
  EXPECT_THAT(plan_->words(), HasSubstr("2.5 turns is beyond the limit of 1 turns"));
}

TEST_F(Speed, ARefusedEnableNamesTheAlarmAndTheCommandThatHelps) {
  begin(ManualTask::enable);
  view_.alarms = bit(AxisAlarm::local_control) | bit(AxisAlarm::not_homed);
  look();
  answer_unseen();
  static_cast<void>(written());
  answer(Exception::server_device_failure);
  view_.result = CommandResult::state_unsuitable;
  look();
  EXPECT_THAT(plan_->words(),
              HasSubstr("result 9 state unsuitable: alarm local_control: the drive obeys its own inputs or keypad and "
                        "ignores the bus; axisgate commission CONFIG 4 shows and changes it"));
}

}  // namespace
}  // namespace axisgate::commands
