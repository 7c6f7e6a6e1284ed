// SPDX-License-Identifier: Apache-2.0
// A stop is done when the drive shows it, and what was read before it went out shows neither it nor what came after it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class AfterAGap : public testing::TestWithParam<Subject> {};

// On a line that was silent for a moment the owed stop of some drives takes the torque as well. An enable that comes
// right behind it must not be told by what the drive showed before.
TEST_P(AfterAGap, AnEnableBehindTheOwedStopIsDoneWhenTheMotorHasTorque) {
  for (Duration behind{}; behind < 40ms; behind += 3ms) {
    SCOPED_TRACE(behind / 1ms);
    Plant plant(GetParam());
    plant.ready();
    ASSERT_EQ(plant.set_endless(plant.a), kOk);
    ASSERT_EQ(plant.a.command(plant.endless_command()), kOk);
    plant.run(300ms);
    plant.cut_wire();
    plant.run(50ms);
    plant.a.begin(one(row::command, kHalt));
    plant.run(100ms);
    plant.mend_wire();
    plant.run(behind);
    const Answer answer = plant.b.command(kEnable);
    plant.run(60ms);
    if (answer.ok()) {
      EXPECT_TRUE(plant.motor().enabled.value_or(true));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, AfterAGap, testing::ValuesIn(kSubjects), named);

// --- A quick stop that stops nothing -------------------------------------------------------------------------------

constexpr std::int64_t kNoiseRpm = 3, kSlowRamp = 300;
constexpr std::int64_t kTwentySeconds = 75;  ///< a ramp, for 150 rpm
constexpr std::int64_t kDone = 2, kNotReached = 11, kEnabledNow = 0x27, kStateBits = 0x6F;

class Unheeded : public testing::TestWithParam<Subject> {
 protected:
  void runs() {
    plant_.ready();
    ASSERT_TRUE(plant_.start_endless(a_));
  }
  void is_owed_until_it_is_heeded() {
    plant_.run(5s);
    EXPECT_NE(plant_.velocity(), 0);
    EXPECT_EQ(a_.result(), kNotReached);
    EXPECT_TRUE(plant_.logged("a stop is owed: quick_stop"));
    ignore_quick_stop(plant_.stage, GetParam(), false);
    EXPECT_TRUE(plant_.comes_to_stand());
    plant_.run(2s);
    const std::size_t told = plant_.stage.log().size();
    plant_.run(5s);
    EXPECT_EQ(plant_.stage.log().size(), told) << "it is owed no more";
    EXPECT_EQ(a_.command(kEnable), kOk);
    EXPECT_TRUE(plant_.motor().enabled.value_or(true));
  }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
};

TEST_P(Unheeded, AQuickStopThatTheStateAloneShowsIsNotDone) {
  runs();
  ignore_quick_stop(plant_.stage, GetParam(), true);
  const Instant asked_at = plant_.stage.runtime().now();
  EXPECT_EQ(a_.command(kQuickStop), kFailed);
  EXPECT_LE(plant_.stage.runtime().now() - asked_at, 1s);
  EXPECT_NE(a_.word(shown::statusword) & kStateBits, kEnabledNow);
  is_owed_until_it_is_heeded();
}

TEST_P(Unheeded, AQuickStopByControlwordIsNotDoneEither) {
  runs();
  ignore_quick_stop(plant_.stage, GetParam(), true);
  EXPECT_EQ(a_.row(row::controlword, 2), kFailed);
  is_owed_until_it_is_heeded();
}

// It has begun to slow down, was told done, and then it gets no slower.
TEST_P(Unheeded, WhatWasToldDoneIsTakenBackWhereTheMotorTurnsOn) {
  plant_.ready();
  ASSERT_EQ(a_.row(row::profile_deceleration, kTwentySeconds), kOk);
  static_cast<void>(a_.row(row::quick_stop_deceleration, kTwentySeconds));  // not every drive has its own
  ASSERT_EQ(plant_.set_endless(a_), kOk);
  ASSERT_EQ(a_.command(plant_.endless_command()), kOk);
  ASSERT_TRUE(plant_.reaches(kSpeed));
  EXPECT_EQ(a_.command(kQuickStop), kOk);
  plant_.run(500ms);
  EXPECT_EQ(a_.result(), kDone);
  ignore_quick_stop(plant_.stage, GetParam(), true);
  ASSERT_TRUE(plant_.stage.run_until([&] { return a_.result() == kNotReached; }, 3s));
  EXPECT_TRUE(plant_.logged("the motor turns on after its quick_stop"));
}

TEST_P(Unheeded, AHaltBehindAQuickStopThatStopsNothingIsNotDoneEither) {
  runs();
  ignore_quick_stop(plant_.stage, GetParam(), true);
  EXPECT_EQ(a_.command(kQuickStop), kFailed);
  EXPECT_EQ(a_.command(kHalt), kFailed);
}

// Noise about its speed is no fall.
TEST_P(Unheeded, AQuickStopIsNotDoneByNoiseOfTheVelocity) {
  runs();
  blur_speed(plant_.stage, GetParam(), kNoiseRpm, {});
  ignore_quick_stop(plant_.stage, GetParam(), true);
  EXPECT_EQ(a_.command(kQuickStop), kFailed);
  plant_.run(5s);
  EXPECT_EQ(a_.result(), kNotReached);
}

// It is accepted while the motor still gets faster.
TEST_P(Unheeded, AQuickStopOfWhatJustStartsIsNotDone) {
  plant_.ready();
  ASSERT_EQ(a_.row(row::profile_acceleration, kSlowRamp), kOk);
  ASSERT_TRUE(plant_.start_endless(a_));
  ignore_quick_stop(plant_.stage, GetParam(), true);
  EXPECT_EQ(a_.command(kQuickStop), kFailed);
  EXPECT_EQ(a_.result(), kNotReached);
}

INSTANTIATE_TEST_SUITE_P(All, Unheeded, testing::ValuesIn(subjects(is_cia402)), named);

// A drive that obeys is not told to have failed, however long it takes and whatever it tells of its velocity.
class Slow : public testing::TestWithParam<Subject> {
 protected:
  void SetUp() override { plant_.ready(); }
  void runs_at(std::int64_t speed) {
    ASSERT_EQ(a_.row(row::target_velocity, speed), kOk);
    ASSERT_EQ(a_.command(kRun), kOk);
    ASSERT_TRUE(plant_.reaches(speed, 20s));
    plant_.run(1s);
  }
  /// To its end, and for a while after it.
  void is_done_and_stays_so(std::int64_t stop, Duration time = 5s) {
    ASSERT_EQ(a_.command(stop), kOk) << stop;
    EXPECT_TRUE(plant_.comes_to_stand(time));
    plant_.run(5s);
    EXPECT_EQ(a_.result(), kDone);
    EXPECT_FALSE(plant_.logged("turns on after"));
    EXPECT_FALSE(plant_.logged("was not reached"));
    EXPECT_FALSE(plant_.logged("a stop is owed"));
    EXPECT_FALSE(plant_.logged("unexpected_motion"));
  }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
};

TEST_P(Slow, ARampOfFortySecondsIsDone) {
  constexpr std::int64_t kSixHundredRpm = 600'000, kFortySeconds = 150;
  ASSERT_EQ(a_.row(row::profile_deceleration, kFortySeconds), kOk);
  static_cast<void>(a_.row(row::quick_stop_deceleration, kFortySeconds));
  for (const std::int64_t stop : {kHalt, kQuickStop}) {
    ASSERT_EQ(a_.command(kEnable), kOk);
    runs_at(kSixHundredRpm);
    is_done_and_stays_so(stop, 50s);
  }
}

// Its velocity still shows that it stands.
TEST_P(Slow, AStopOfWhatHasJustStartedIsDone) {
  ASSERT_EQ(a_.row(row::profile_deceleration, kTwentySeconds), kOk);
  static_cast<void>(a_.row(row::quick_stop_deceleration, kTwentySeconds));
  for (const std::int64_t stop : {kQuickStop, kHalt}) {
    ASSERT_EQ(a_.command(kEnable), kOk);
    ASSERT_EQ(a_.row(row::target_velocity, kSpeed), kOk);
    ASSERT_EQ(a_.command(kRun), kOk);
    ASSERT_TRUE(plant_.reaches(kSpeed));
    is_done_and_stays_so(stop, 30s);
  }
}

TEST_P(Slow, AVelocityWithNoiseThatIsToldLateFailsNoStop) {
  for (const Duration late : {0ms, 250ms}) {
    blur_speed(plant_.stage, GetParam(), kNoiseRpm, late);
    for (const std::int64_t stop : {kHalt, kQuickStop}) {
      ASSERT_EQ(a_.command(kEnable), kOk);
      runs_at(kSpeed);
      is_done_and_stays_so(stop);
      is_done_and_stays_so(stop);  // of what stands
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Slow, testing::ValuesIn(subjects(is_cia402)), named);

// Without torque a motor coasts as it may, and what stands has nothing to show.
class Heeded : public testing::TestWithParam<Subject> {};

TEST_P(Heeded, AQuickStopOfWhatStandsIsDoneAtOnce) {
  Plant plant(GetParam());
  plant.ready();
  plant.run(2s);
  const Instant asked_at = plant.stage.runtime().now();
  EXPECT_EQ(plant.a.command(kQuickStop), kOk);
  EXPECT_LE(plant.stage.runtime().now() - asked_at, 150ms);
}

INSTANTIATE_TEST_SUITE_P(All, Heeded, testing::ValuesIn(kSubjects), named);

// The gate of such an axis is the gateway's: that a quick stop stops, the motor alone shows.
TEST(UnheededQuickStop, OfAProfileThatAwaitsNothingIsNotDone) {
  GatewayStage::Line line = rtu_line_of({simulated::Id286proOptions{}}, 1);
  line.rtu_drives.front().profile = "tests/stage/unheeded-quick-stop.json";
  GatewayStage stage({line});
  ASSERT_TRUE(stage.come_online());
  ASSERT_EQ(stage.command(1, Command::enable).outcome.code, Errc::ok);
  WriteBatch run;
  run.command = Command::run_velocity;
  run.setpoints = {{Quantity::target_velocity, 60'000}};
  ASSERT_EQ(stage.ask(1, run).outcome.code, Errc::ok);
  stage.run(2s);
  EXPECT_EQ(stage.command(1, Command::quick_stop).outcome.code, Errc::not_reached);
  stage.run(5s);
  EXPECT_NE(truth(stage, Subject::id286pro).velocity, 0);
  EXPECT_TRUE(stage.axis(1).has(AxisInput::enabled)) << "it is not shown to be stopped";
  const auto owed = [](const std::string& told) {
    return told.find("a stop is owed: quick_stop") != std::string::npos;
  };
  EXPECT_TRUE(std::ranges::any_of(stage.log(), owed));
  // A halt is heeded, but it asks for less than what is owed; a disable for more.
  EXPECT_EQ(stage.command(1, Command::disable).outcome.code, Errc::ok);
  stage.run(2s);
  EXPECT_EQ(truth(stage, Subject::id286pro).velocity, 0);
}

// So slowly that its velocity could be noise: its position tells. What the gateway does against it changes no result.
TEST(UnheededQuickStop, OfAMotorThatCreepsOnIsTakenBack) {
  Plant plant(Subject::jd_can);
  plant.ready();
  ASSERT_EQ(plant.a.row(row::profile_deceleration, kTwentySeconds), kOk);
  ASSERT_TRUE(plant.start_endless(plant.a));
  ASSERT_TRUE(plant.reaches(kSpeed));
  EXPECT_EQ(plant.a.command(kQuickStop), kOk);
  simulated::KincoDrive& drive = plant.stage.drive(0);
  static_cast<void>(drive.poke({0x60FF, 0}, simulated::speed_dec(6, drive.model().encoder_counts)));
  ignore_quick_stop(plant.stage, plant.subject, true);
  plant.run(17s);
  EXPECT_EQ(plant.a.result(), kDone) << "it gets slower";
  EXPECT_TRUE(plant.stage.run_until([&] { return plant.a.result() == kNotReached; }, 20s));
  plant.run(10s);
  EXPECT_EQ(plant.a.result(), kNotReached);
}

// --- A restart that nobody has heard -------------------------------------------------------------------------------

class UnheardRestart : public testing::TestWithParam<Subject> {};

// The cable was off while the drive started anew: its boot-up is lost, and what it was told before it holds no more.
TEST_P(UnheardRestart, OfADriveNoMoveIsFasterThanTheLimit) {
  constexpr std::int64_t kLimit = 50'000;
  int moved = 0;
  for (Duration off = 100ms; off < 2s; off += 100ms) {
    SCOPED_TRACE(off / 1ms);
    PlantOptions options;
    options.velocity_limit = kLimit;
    Plant plant(GetParam(), options);
    plant.ready();
    ASSERT_EQ(plant.a.row(row::target_position, kNear), kOk);
    ASSERT_EQ(plant.a.command(kMove), kOk);
    plant.comes_to_rest_at();
    ASSERT_EQ(plant.a.command(kDisable), kOk);
    plant.run(100ms);
    plant.cut_wire();
    plant.restart_drive();
    plant.run(off);
    plant.mend_wire();
    const auto enabled = [&] { return plant.a.command(kEnable).ok(); };
    for (int tries = 0; tries < 100 && !enabled(); ++tries) plant.run(50ms);
    // Where the gateway has noticed it meanwhile, it is set up anew.
    if (!plant.a.row(row::target_position, kFar).ok() || !plant.a.command(kMove).ok()) continue;
    ++moved;
    std::int64_t fastest = 0;
    for (int look = 0; look < 100; ++look) {
      plant.run(10ms);
      fastest = std::max(fastest, std::abs(plant.velocity()));
    }
    EXPECT_LE(fastest, kLimit + kLimit / 10);
  }
  EXPECT_GT(moved, 0);
}

INSTANTIATE_TEST_SUITE_P(All, UnheardRestart,
                         testing::ValuesIn(subjects([](Subject s) { return is_cia402(s) && minds_silence(s); })),
                         named);

// Whatever the drive holds, nobody can say that it is within the limit.
TEST(UnknownSpeed, UnderALimitStartsNoMove) {
  PlantOptions options;
  options.velocity_limit = 50'000;
  Plant plant(Subject::md_can, options);
  auto& faults = *plant.stage.at_link(0, [](auto& link) { return &link.line().faults(0); });
  const simulated::DriveFaults::Place speed{0x6081, 0};
  faults.spoil(speed, {});
  plant.ready();
  ASSERT_EQ(plant.a.row(row::target_position, kNear), kOk);
  EXPECT_EQ(plant.a.command(kMove), kFailed);
  EXPECT_TRUE(plant.logged("profile_velocity has a limit: no motion by it starts"));
  plant.run(500ms);
  EXPECT_TRUE(plant.stands());
  faults.mend(speed);
  EXPECT_TRUE(plant.stage.run_until([&] { return plant.a.command(kMove).ok(); }, 62s));
  EXPECT_LE(std::abs(plant.comes_to_rest_at() - kNear), kClose);
}

// A target is held against the limit when it is accepted, whatever the drive answers of it.
TEST(UnknownTarget, UnderALimitHoldsUpNoMotionAndIsNotSaidTo) {
  PlantOptions options;
  options.velocity_limit = 50'000;
  Plant plant(Subject::md_can, options);
  plant.stage.at_link(0, [](auto& link) { return &link.line().faults(0); })->spoil({0x60FF, 0}, {});
  plant.ready();
  ASSERT_TRUE(plant.logged("0x60FF"));
  EXPECT_FALSE(plant.logged("has a limit: no motion by it starts"));
}

// --- A counter that runs over ---------------------------------------------------------------------------------------

TEST(WrappedCounter, EndsTheReferenceOfADriveThatSaysHomedAllTheSame) {
  simulated::LeadshineOptions drive;
  drive.encoder_counts = 131'072;
  GatewayStage stage({can_line_of({drive}, 1)});
  static_cast<void>(stage.leadshine(0).poke({0x6092, 1}, 131'072));  // 32768 turns in all
  ASSERT_TRUE(stage.come_online());
  ASSERT_EQ(stage.write(1, Quantity::homing_method, 35).outcome.code, Errc::ok);
  ASSERT_EQ(stage.command(1, Command::enable).outcome.code, Errc::ok);
  ASSERT_EQ(stage.command(1, Command::home).outcome.code, Errc::ok);
  const auto homed = [&] { return stage.axis(1).has(AxisInput::homed); };
  ASSERT_TRUE(stage.run_until(homed));
  stage.run(1s);
  WriteBatch run;
  run.command = Command::run_velocity;
  run.setpoints = {{Quantity::target_velocity, 3'000'000},
                   {Quantity::profile_acceleration, 10'000},
                   {Quantity::profile_deceleration, 10'000}};
  ASSERT_EQ(stage.ask(1, run).outcome.code, Errc::ok);
  const auto wrapped = [&] { return stage.axis(1)[Quantity::position_actual].value < -1'000'000; };
  ASSERT_TRUE(stage.run_until(wrapped, 600s));
  EXPECT_FALSE(homed());
  const auto told = [](const std::string& line) { return line.find("counter has run over") != std::string::npos; };
  EXPECT_TRUE(std::ranges::any_of(stage.log(), told));
  ASSERT_EQ(stage.command(1, Command::halt).outcome.code, Errc::ok);
  stage.run(3s);
  EXPECT_FALSE(homed()) << "its bit tells of before";
  ASSERT_EQ(stage.command(1, Command::home).outcome.code, Errc::ok);
  EXPECT_TRUE(stage.run_until(homed));
}

}  // namespace
}  // namespace axisgate::test::obey
