// SPDX-License-Identifier: Apache-2.0
// 3.3 Not reached: the drive has acknowledged everything, and the state asked for does not come: the answer says so,
// and what might still happen is withdrawn before it. Nothing that was told to have failed happens later.
#include <gtest/gtest.h>

#include "tests/obey/dds_writers.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kNotReached = 11, kDisabled = 0;
constexpr Duration kReplyDeadline = 900ms;

class NotReached : public testing::TestWithParam<Subject> {
 protected:
  /// Failed, in time, and said how.
  void fails(const Answer& answer, Instant asked_at) {
    EXPECT_EQ(answer, kFailed);
    EXPECT_LE(plant_.stage.runtime().now() - asked_at, kReplyDeadline);
    EXPECT_EQ(a_.result(), kNotReached);
    const bool sent = !plant_.logged("was not reached: nothing was sent");
    EXPECT_EQ(a_.wide(shown::detail) > 0, sent) << a_.wide(shown::detail);
    EXPECT_TRUE(plant_.logged("was not reached: "));
  }
  void fails(std::int64_t command) {
    const Instant asked_at = plant_.stage.runtime().now();
    const Answer answer = a_.command(command);
    fails(answer, asked_at);
  }
  [[nodiscard]] bool enabled() {
    return plant_.motor().enabled.value_or(false) || a_.word(shown::axis_state) != kDisabled;
  }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
};

TEST_P(NotReached, AnEnableAgainstAHardwareLockNeverComesLate) {
  plant_.ready_but_disabled();
  lock(plant_.stage, GetParam(), true);
  fails(kEnable);
  EXPECT_TRUE(plant_.logged(", read "));
  EXPECT_TRUE(plant_.logged(": awaited "));
  plant_.run(1s);
  lock(plant_.stage, GetParam(), false);
  plant_.run(3s);
  EXPECT_FALSE(enabled());
  // The cause is gone, and it can be asked for again at once.
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_TRUE(plant_.motor().enabled.value_or(true));
}

TEST_P(NotReached, AnEnableThatIsPressedAgainIsToldAgain) {
  plant_.ready_but_disabled();
  lock(plant_.stage, GetParam(), true);
  fails(kEnable);
  fails(kEnable);
  lock(plant_.stage, GetParam(), false);
  plant_.run(3s);
  EXPECT_FALSE(enabled());
}

TEST_P(NotReached, ADdsWriterIsToldByTheSameNumber) {
  plant_.ready_but_disabled();
  lock(plant_.stage, GetParam(), true);
  DdsWriters writer(plant_.stage, 1);
  const std::uint64_t request = writer.begin({.function = fc::sample, .sample = {{row::command, kEnable}}});
  ASSERT_TRUE(plant_.stage.run_until([&] { return writer.result_of(request).has_value(); }));
  EXPECT_EQ(*writer.result_of(request), kNotReached);
  lock(plant_.stage, GetParam(), false);
  plant_.run(3s);
  EXPECT_FALSE(enabled());
}

class Withdrawn : public NotReached {};

// The withdrawal itself is lost: it is owed, and sent again as soon as the drive shows torque.
TEST_P(Withdrawn, AnEnableIsAlsoWhereTheWithdrawalIsLost) {
  plant_.ready_but_disabled();
  lock(plant_.stage, GetParam(), true);
  const RequestNumber enable = a_.begin(one(row::command, kEnable));
  ASSERT_TRUE(plant_.stage.run_until([&] { return plant_.logged("is withdrawn"); }));
  plant_.cut_wire();
  ASSERT_TRUE(plant_.stage.run_until([&] { return a_.answer_of(enable).has_value(); }));
  EXPECT_EQ(*a_.answer_of(enable), kFailed);
  plant_.run(200ms);
  lock(plant_.stage, GetParam(), false);
  plant_.run(200ms);
  plant_.mend_wire();
  plant_.run(10s);
  EXPECT_FALSE(*plant_.motor().enabled);
}

// What is lost beside it is no acknowledgement of its own.
TEST_P(Withdrawn, AnEnableIsAlsoWhereThePollBeforeItIsLost) {
  for (Duration lost_at = 650ms; lost_at < 800ms; lost_at += 10ms) {
    SCOPED_TRACE(lost_at / 1ms);
    Plant plant(GetParam());
    plant.ready_but_disabled();
    lock(plant.stage, GetParam(), true);
    const RequestNumber enable = plant.a.begin(one(row::command, kEnable));
    plant.run(lost_at);
    ASSERT_FALSE(plant.a.answer_of(enable).has_value());
    plant.strike(Strike::lose_request, 2);
    ASSERT_TRUE(plant.stage.run_until([&] { return plant.a.answer_of(enable).has_value(); }));
    EXPECT_EQ(*plant.a.answer_of(enable), kFailed);
    lock(plant.stage, GetParam(), false);
    plant.run(3s);
    EXPECT_FALSE(*plant.motor().enabled);
  }
}

TEST_P(NotReached, AFaultResetWhoseCauseIsThereSaysSo) {
  plant_.ready_but_disabled();
  break_down(plant_.stage, GetParam());
  plant_.run(500ms);
  fails(5);
  EXPECT_TRUE(plant_.motor().faulted);
}

class Disobeyed : public NotReached {
 protected:
  void says_so_and_is_owed_on(std::int64_t stop) {
    plant_.ready();
    ASSERT_TRUE(plant_.start_endless(a_));
    numb(plant_.stage, GetParam(), true);
    fails(stop);
    plant_.run(8s);
    EXPECT_NE(plant_.velocity(), 0);
    numb(plant_.stage, GetParam(), false);
    EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
    EXPECT_FALSE(*plant_.motor().enabled);
  }
};

TEST_P(Disobeyed, AQuickStopSaysSoAndIsOwedOn) { says_so_and_is_owed_on(kQuickStop); }
TEST_P(Disobeyed, ADisableSaysSoAndIsOwedOn) { says_so_and_is_owed_on(kDisable); }

class LateStart : public NotReached {};

TEST_P(LateStart, OfAMoveThatWasToldToHaveFailedNeverComes) {
  plant_.ready();
  ASSERT_EQ(a_.row(row::target_position, kFar), kOk);
  numb(plant_.stage, GetParam(), true);
  fails(kMove);
  EXPECT_TRUE(plant_.logged("is withdrawn"));
  plant_.run(1s);
  numb(plant_.stage, GetParam(), false);
  plant_.run(3s);
  EXPECT_EQ(plant_.velocity(), 0);
  EXPECT_LE(std::abs(plant_.position()), kClose);
}

class LateMode : public NotReached {};

TEST_P(LateMode, DoesNotBeginAHomingThatWasToldToHaveFailedNeverComes) {
  plant_.ready();
  ASSERT_EQ(a_.row(row::homing_method, 18), kOk);
  numb(plant_.stage, GetParam(), true);
  fails(kHome);
  plant_.run(1s);
  numb(plant_.stage, GetParam(), false);
  plant_.run(3s);
  EXPECT_EQ(plant_.velocity(), 0);
  EXPECT_LE(std::abs(plant_.position()), kClose);
}

TEST_P(LateMode, DoesNotLetTheMotorFollowASpeedOfBefore) {
  plant_.ready();
  ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
  numb(plant_.stage, GetParam(), true);
  const Instant asked_at = plant_.stage.runtime().now();
  const Answer answer = a_.row(row::mode, kVelocityMode);
  fails(answer, asked_at);
  plant_.run(1s);
  numb(plant_.stage, GetParam(), false);
  plant_.run(3s);
  EXPECT_EQ(plant_.velocity(), 0);
  EXPECT_LE(std::abs(plant_.position()), kClose);
}

// --- What no state tells, the motor does ---------------------------------------------------------------------------

class Ignored : public NotReached {
 protected:
  void runs() {
    plant_.ready();
    ASSERT_TRUE(plant_.start_endless(a_));
  }
  /// Told 11, and owed on until the drive obeys.
  void says_so_and_is_owed_on(const Write& stop) {
    const Instant asked_at = plant_.stage.runtime().now();
    const Answer answer = a_.write(stop);
    fails(answer, asked_at);
    EXPECT_EQ(a_.word(shown::axis_state), kStopping);
    // Not so long that the watch asks for more than the halt (WATCH-4).
    plant_.run(3s);
    EXPECT_NE(plant_.velocity(), 0);
    EXPECT_TRUE(plant_.logged("a stop is owed: halt"));
    numb(plant_.stage, GetParam(), false);
    // A Keya in position mode turns past the target that it is given, and comes back.
    EXPECT_TRUE(plant_.comes_to_stand(10s)) << plant_.velocity();
    // Until a stop is seen nothing but a 0 keeps its watchdog fed.
    const bool is_fed = !minds_silence(GetParam()) || has_speeds(GetParam());
    EXPECT_TRUE(!is_fed || plant_.motor().enabled.value_or(true)) << "a halt leaves the torque on";
  }
  static constexpr std::int64_t kStopping = 5;
};

TEST_P(Ignored, AHaltSaysSoAndIsOwedOn) {
  runs();
  numb(plant_.stage, GetParam(), true);
  says_so_and_is_owed_on(one(row::command, kHalt));
}

TEST_P(Ignored, AHaltByItsCoilSaysSoAndIsOwedOn) {
  runs();
  numb(plant_.stage, GetParam(), true);
  says_so_and_is_owed_on(one_coil(coil::halt, true));
}

// What was sampled before it began to move tells nothing of the halt.
TEST_P(Ignored, AHaltOfWhatHasJustBegunSaysSo) {
  plant_.ready();
  ASSERT_EQ(plant_.set_endless(a_), kOk);
  ASSERT_EQ(a_.command(plant_.endless_command()), kOk);
  numb(plant_.stage, GetParam(), true);
  fails(kHalt);
  EXPECT_NE(plant_.velocity(), 0);
}

class IgnoredRun : public Ignored {};

TEST_P(IgnoredRun, ItsHaltIsTakenBackByALaterStart) {
  runs();
  numb(plant_.stage, GetParam(), true);
  fails(kHalt);
  // While the halt is being sent the start is refused: it would wait for longer than a start may.
  const auto starts = [&] { return plant_.set_endless(a_) == kOk && a_.command(kRun) == kOk; };
  bool started = starts();
  for (int tries = 0; tries < 100 && !started; ++tries) {
    plant_.run(50ms);
    started = starts();
  }
  ASSERT_TRUE(started);
  plant_.run(1s);
  numb(plant_.stage, GetParam(), false);
  plant_.run(5s);
  EXPECT_TRUE(plant_.keeps_turning());
}

class IgnoredDisable : public Ignored {};

// The gate is the gateway's: that the motor obeys, only the motor shows.
TEST_P(IgnoredDisable, OfADriveThatKeepsItsTorqueSaysSoAndIsOwedOn) {
  runs();
  numb(plant_.stage, GetParam(), true);
  fails(kDisable);
  plant_.run(8s);
  EXPECT_NE(plant_.velocity(), 0);
  numb(plant_.stage, GetParam(), false);
  EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
  EXPECT_EQ(a_.word(shown::axis_state), kDisabled);
}

class LongRamp : public Ignored {};

TEST_P(LongRamp, AHaltIsDoneAsSoonAsTheMotorSlowsDown) {
  // 150 rpm in 20 s; of an iD286pro, which counts in 60 rpm/s, 1500 rpm in 5 s.
  const bool stepper = GetParam() == Subject::id286pro;
  const std::int64_t ramp = stepper ? 3000 : 75, speed = stepper ? 10 * kSpeed : kSpeed;
  plant_.ready();
  ASSERT_EQ(a_.row(row::profile_deceleration, ramp), kOk);
  ASSERT_EQ(a_.row(row::target_velocity, speed), kOk);
  ASSERT_EQ(a_.command(kRun), kOk);
  ASSERT_TRUE(plant_.reaches(speed));
  plant_.run(1s);
  EXPECT_EQ(a_.command(kHalt), kOk);
  EXPECT_NE(plant_.velocity(), 0);
  EXPECT_EQ(a_.word(shown::axis_state), kStopping);
  EXPECT_TRUE(plant_.comes_to_stand(30s));
  plant_.run(1s);
  EXPECT_EQ(a_.word(shown::axis_state), kStandstill);
  EXPECT_FALSE(plant_.logged("was not reached"));
  EXPECT_FALSE(plant_.logged("a stop is owed"));
}

class IgnoredHoming : public NotReached {
 protected:
  static constexpr std::int64_t kHere = 35, kIndex = 33, kOrigin = 19, kNegativeLimit = 17;
  static constexpr std::int64_t kHomingMode = 6, kNone = 0, kAborted = 3;  // motion_state
  [[nodiscard]] bool stepper() const { return GetParam() == Subject::id286pro; }
  /// In mode 6 already: what is not carried out is the start alone.
  void is_ready_to_home(std::int64_t method) {
    plant_.ready();
    ASSERT_EQ(a_.row(row::homing_method, method), kOk);
    ASSERT_EQ(a_.row(row::mode, kHomingMode), kOk);
    plant_.run(200ms);
  }
  void never_homes() {
    numb(plant_.stage, GetParam(), true);
    fails(kHome);
    EXPECT_TRUE(plant_.logged("is withdrawn: halt"));
    EXPECT_NE(a_.word(shown::axis_state), kHoming);
    plant_.run(1s);
    numb(plant_.stage, GetParam(), false);
    plant_.run(3s);
    EXPECT_EQ(plant_.velocity(), 0);
    EXPECT_LE(std::abs(plant_.position()), kClose);
    const std::int64_t motion = a_.word(shown::motion_state);
    EXPECT_TRUE(motion == kNone || motion == kAborted) << motion;
  }
  static constexpr std::int64_t kHoming = 4;
};

TEST_P(IgnoredHoming, NeverComesLate) {
  is_ready_to_home(stepper() ? kOrigin : kIndex);
  never_homes();
}

class IgnoredReference : public IgnoredHoming {};

// The bit of the homing before stands as if it were this one's.
TEST_P(IgnoredReference, OfBeforeIsNotTakenForTheNewOne) {
  is_ready_to_home(kHere);
  ASSERT_EQ(a_.command(kHome), kOk);
  plant_.run(2s);
  constexpr std::int64_t kCompleted = 2;
  ASSERT_EQ(a_.word(shown::motion_state), kCompleted);
  ASSERT_EQ(a_.row(row::homing_method, kNegativeLimit), kOk);
  ASSERT_EQ(a_.command(0), kOk);
  numb(plant_.stage, GetParam(), true);
  fails(kHome);
  plant_.run(3s);
  EXPECT_EQ(plant_.velocity(), 0);
}

// A drive that has found its reference where it stands shows nothing of finding it once more.
TEST_P(IgnoredReference, ThatIsFoundWhereItStandsIsNotTakenForIgnored) {
  is_ready_to_home(kHere);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(a_.command(0), kOk);
    EXPECT_EQ(a_.command(kHome), kOk) << i;
    plant_.run(2s);
  }
  EXPECT_FALSE(plant_.logged("was not reached"));
}

TEST_P(IgnoredHoming, IsNotSaidOfOneThatBegins) {
  is_ready_to_home(stepper() ? kOrigin : kIndex);
  EXPECT_EQ(a_.command(kHome), kOk);
  EXPECT_TRUE(plant_.turns_within(1s));
  EXPECT_EQ(a_.word(shown::axis_state), kHoming);
  EXPECT_FALSE(plant_.logged("was not reached"));
}

// The others have no mode display, or their sheets print none: the mode that was written is all that can be read back.
constexpr auto shows_mode = [](Subject s) {
  return s == Subject::jd_serial || s == Subject::jd_can || s == Subject::leadshine;
};
constexpr auto can_be_disabled = [](Subject s) { return s != Subject::id286pro; };
INSTANTIATE_TEST_SUITE_P(Every, NotReached, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, Withdrawn, testing::ValuesIn(subjects(can_be_disabled)), named);
INSTANTIATE_TEST_SUITE_P(Every, Disobeyed, testing::ValuesIn(subjects(can_be_disabled)), named);
INSTANTIATE_TEST_SUITE_P(Every, LateStart, testing::ValuesIn(subjects(is_kinco)), named);
INSTANTIATE_TEST_SUITE_P(Every, Ignored, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, IgnoredRun, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, IgnoredDisable, testing::Values(Subject::id286pro), named);
INSTANTIATE_TEST_SUITE_P(Every, LongRamp, testing::ValuesIn(subjects(has_homing)), named);
INSTANTIATE_TEST_SUITE_P(Every, IgnoredHoming, testing::ValuesIn(subjects(has_homing)), named);
INSTANTIATE_TEST_SUITE_P(Every, IgnoredReference, testing::ValuesIn(subjects(is_cia402)), named);
INSTANTIATE_TEST_SUITE_P(Every, LateMode, testing::ValuesIn(subjects(shows_mode)), named);

}  // namespace
}  // namespace axisgate::test::obey
