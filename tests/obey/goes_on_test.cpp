// SPDX-License-Identifier: Apache-2.0
// What goes on in the drive while nobody can see it: found running after a loss, an axis takes what its owner asks.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class GoesOn : public testing::TestWithParam<Subject> {
 protected:
  void ready(bool leases = false) {
    plant_.emplace(GetParam(), leases ? with_leases() : PlantOptions{});
    plant_->ready();
  }
  void run_at(std::int64_t speed) {
    ASSERT_EQ(plant_->a.row(row::target_velocity, speed), kOk);
    ASSERT_EQ(plant_->a.command(kRun), kOk);
    ASSERT_TRUE(plant_->reaches(speed)) << plant_->velocity();
  }
  void jog() {
    constexpr std::int64_t kButtonSpeed = 45'000;
    ASSERT_EQ(plant_->a.row(row::jog_velocity, kButtonSpeed), kOk);
    ASSERT_EQ(plant_->a.coil(coil::jog_forward, false), kOk);
    ASSERT_EQ(plant_->a.coil(coil::jog_forward, true), kOk);
    ASSERT_TRUE(plant_->reaches(kButtonSpeed, 400ms)) << plant_->velocity();
  }
  [[nodiscard]] bool comes_back(Client& client) {
    constexpr std::uint16_t kLinkState = 18, kOnline = 2;
    return plant_->stage.run_until([&] { return client.word(kLinkState) == kOnline; }, 10s);
  }
  /// Too short for any drive to mind.
  void lose_link() {
    plant_->unplug();
    plant_->run(100ms);
    plant_->plug();
    ASSERT_TRUE(comes_back(plant_->a));
    ASSERT_NE(plant_->velocity(), 0);
  }
  void lose_gateway() {
    plant_->crash_gateway();
    plant_->run(50ms);
    plant_->start_gateway();
    plant_->a.connect();
    plant_->b.connect();
    ASSERT_TRUE(comes_back(plant_->a));
    ASSERT_NE(plant_->velocity(), 0);
  }
  [[nodiscard]] bool shows_enabled() {
    constexpr std::uint16_t kEnabled = 0x27, kStateBits = 0x6F;
    return (plant_->b.word(shown::statusword) & kStateBits) == kEnabled;
  }
  std::optional<Plant> plant_;
};

class GoesOnAtASpeed : public GoesOn {};

// 3.4: "while it runs a write of target_velocity acts at once"; 3.4 Owed stops: "it goes on". It was kept for the next
// start, and answered as if it had acted.
TEST_P(GoesOnAtASpeed, ANewSpeedActsOnARunThatGoesOn) {
  for (const bool leases : {false, true}) {
    ready(leases);
    run_at(kSpeed);
    lose_link();
    EXPECT_EQ(plant_->a.row(row::target_velocity, kOtherSpeed), kOk);
    EXPECT_TRUE(plant_->reaches(kOtherSpeed)) << plant_->velocity();
    EXPECT_EQ(plant_->a.row(row::target_velocity, kSpeed), kOk);
    EXPECT_TRUE(plant_->reaches(kSpeed)) << plant_->velocity();
  }
}

TEST_P(GoesOnAtASpeed, ASpeedOfZeroStandsARunThatGoesOn) {
  for (const bool leases : {false, true}) {
    ready(leases);
    run_at(kSpeed);
    lose_link();
    EXPECT_EQ(plant_->a.row(row::target_velocity, 0), kOk);
    EXPECT_TRUE(plant_->comes_to_stand()) << plant_->velocity();
    // The run is the same one, at no speed.
    EXPECT_EQ(plant_->a.row(row::target_velocity, kOtherSpeed), kOk);
    EXPECT_TRUE(plant_->reaches(kOtherSpeed)) << plant_->velocity();
  }
}

// A scanner's block asks for its speed anew: the one of before is void.
TEST_P(GoesOnAtASpeed, AScannedZeroStandsARunThatGoesOn) {
  ready(true);
  run_at(kSpeed);
  lose_link();
  const auto block_of = [](std::int64_t speed) {
    return block(row::target_velocity, 45, {{row::target_velocity, speed}}, fc::read_write);
  };
  EXPECT_EQ(plant_->a.write(block_of(0)), kOk);
  EXPECT_TRUE(plant_->comes_to_stand(1s)) << plant_->velocity();
}

// Nobody knows of a jog any more: what turns in velocity mode is a run.
/// In which mode it turns no object tells.
constexpr bool hides_mode(Subject s) {
  return s == Subject::id286pro || s == Subject::keya_canopen_speed || s == Subject::keya_canopen_position;
}

TEST_P(GoesOnAtASpeed, ANewSpeedActsOnWhatANewGatewayFindsRunning) {
  ready();
  run_at(kSpeed);
  lose_gateway();
  if (hides_mode(GetParam())) return;
  EXPECT_EQ(plant_->a.row(row::target_velocity, kOtherSpeed), kOk);
  EXPECT_TRUE(plant_->reaches(kOtherSpeed)) << plant_->velocity();
}

// "Setpoints are not starts": what stands after a loss needs a start, as does what a halt has ended.
TEST_P(GoesOnAtASpeed, ASpeedStartsNothingThatStands) {
  ready();
  if (is_cia402(GetParam())) {
    ASSERT_EQ(plant_->a.row(row::mode, kVelocityMode), kOk);
  }
  plant_->unplug();
  plant_->run(100ms);
  plant_->plug();
  ASSERT_TRUE(comes_back(plant_->a));
  EXPECT_EQ(plant_->a.row(row::target_velocity, kSpeed), kOk);
  EXPECT_FALSE(plant_->turns_within(1s)) << plant_->velocity();
  ready();
  run_at(kSpeed);
  lose_link();
  ASSERT_EQ(plant_->a.command(kHalt), kOk);
  EXPECT_EQ(plant_->a.row(row::target_velocity, kOtherSpeed), kOk);
  EXPECT_TRUE(plant_->comes_to_stand()) << plant_->velocity();
  plant_->run(500ms);
  EXPECT_EQ(plant_->a.row(row::target_velocity, kSpeed), kOk);
  EXPECT_FALSE(plant_->turns_within(1s)) << plant_->velocity();
}

// A jog's holder is gone with its gateway. Without leases only the drive's own watchdog stops the motor then; the new
// gateway knows of no jog, says what it finds, and obeys the button's end.
TEST_P(GoesOnAtASpeed, AJogOutlivesItsGatewayWhereNeitherLeaseNorDriveEndsIt) {
  constexpr std::uint16_t kAlarms = 35;
  constexpr unsigned kNoCommWatchdog = 1U << 0, kAdoptedRunning = 1U << 1;
  for (const bool leases : {false, true}) {
    SCOPED_TRACE(leases ? "leases" : "no leases");
    ready(leases);
    jog();
    plant_->crash_gateway();
    plant_->run(3s);
    EXPECT_EQ(plant_->velocity() != 0, !minds_silence(GetParam()));
    plant_->start_gateway();
    plant_->a.connect();
    plant_->b.connect();
    ASSERT_TRUE(comes_back(plant_->b));
    if (leases) {
      EXPECT_TRUE(plant_->comes_to_stand(4s)) << plant_->velocity();
    } else if (!minds_silence(GetParam())) {
      EXPECT_TRUE(plant_->keeps_turning()) << "nobody knows of a jog any more";
      EXPECT_EQ(plant_->b.word(kAlarms) & (kNoCommWatchdog | kAdoptedRunning), kNoCommWatchdog | kAdoptedRunning);
      EXPECT_EQ(plant_->a.coil(coil::jog_forward, true), kNotNow) << "held since before";
      EXPECT_EQ(plant_->a.coil(coil::jog_forward, false), kOk);
      EXPECT_TRUE(plant_->comes_to_stand(1500ms)) << plant_->velocity();
    }
  }
}

// A button that is written 0 ends a jog, and no run that this gateway knows.
TEST_P(GoesOnAtASpeed, AButtonsZeroEndsNoRunThatIsKnown) {
  ready();
  run_at(kSpeed);
  lose_link();
  EXPECT_EQ(plant_->b.coil(coil::jog_forward, false), kOk);
  plant_->run(300ms);
  EXPECT_TRUE(plant_->reaches(kSpeed, 1ms)) << plant_->velocity();
  ready();
  run_at(kSpeed);
  lose_gateway();
  ASSERT_EQ(plant_->a.row(row::target_velocity, kOtherSpeed), kOk);
  if (hides_mode(GetParam())) return;
  ASSERT_TRUE(plant_->reaches(kOtherSpeed));
  EXPECT_EQ(plant_->b.coil(coil::jog_forward, false), kOk);
  plant_->run(300ms);
  EXPECT_TRUE(plant_->reaches(kOtherSpeed, 1ms)) << plant_->velocity();
}

// 3.4: "they need an axis that is enabled": what is shown and what is admitted were two things.
TEST_P(GoesOn, StartsAreAcceptedOfWhatShowsEnabled) {
  for (const bool gateway_too : {false, true}) {
    SCOPED_TRACE(gateway_too ? "a new gateway" : "the link");
    ready();
    ASSERT_TRUE(plant_->start_endless(plant_->a));
    gateway_too ? lose_gateway() : lose_link();
    ASSERT_TRUE(shows_enabled());
    EXPECT_EQ(plant_->set_endless(plant_->a), kOk);
    // A start would be a speed, or a position, by a mode that a new gateway does not know (chosen_mode_test.cpp).
    const bool hides = gateway_too && hides_mode(GetParam()) && is_keya(GetParam());
    EXPECT_EQ(plant_->b.command(plant_->endless_command()), hides ? kFailed : kOk);
    if (hides) continue;
    EXPECT_TRUE(plant_->turns_within(1s));
  }
}

TEST_P(GoesOn, AHaltMakesNoStartAcceptable) {
  ready();
  ASSERT_TRUE(plant_->start_endless(plant_->a));
  lose_link();
  static_cast<void>(plant_->set_endless(plant_->b));
  const bool before = plant_->b.command(plant_->endless_command()).ok();
  ASSERT_EQ(plant_->a.command(kHalt), kOk);
  ASSERT_TRUE(plant_->comes_to_stand());
  if (!shows_enabled()) return;  // its halt is a quick stop
  EXPECT_EQ(plant_->set_endless(plant_->a), kOk);
  EXPECT_EQ(plant_->a.command(plant_->endless_command()).ok(), before);
}

/// What an axis shows, and what it lets a client do then.
class Standstill : public GoesOn {
 protected:
  /// A relative move is accepted as soon as the axis shows that it stands.
  void takes_a_distance_when_it_shows(const std::string& after) {
    Client& a = plant_->a;
    ASSERT_EQ(a.row(row::target_position, 1000), kOk) << after;
    ASSERT_TRUE(plant_->stage.run_until([&] { return plant_->b.word(shown::axis_state) == kStandstill; }, 5s)) << after;
    EXPECT_EQ(plant_->b.command(kRelative), kOk) << "after " << after;
    plant_->run(2s);
    ASSERT_EQ(plant_->b.command(0), kOk);
  }
  /// What was started is halted at once, and once more after a while.
  void halts(std::uint16_t offset, std::int64_t target, std::int64_t start) {
    Client& a = plant_->a;
    for (const bool soon : {true, false}) {
      ASSERT_EQ(a.row(offset, target), kOk);
      ASSERT_EQ(a.command(0), kOk);
      ASSERT_EQ(a.command(start), kOk);
      if (!soon) plant_->run(500ms);
      ASSERT_EQ(a.command(kHalt), kOk);
      if (plant_->b.word(shown::axis_state) == kStopLatched) {
        ASSERT_TRUE(plant_->comes_to_stand());
        ASSERT_EQ(a.command(kEnable), kOk);
      }
      takes_a_distance_when_it_shows("a halt of command " + std::to_string(start) + (soon ? ", just begun" : ""));
    }
  }
};

// 3.4, command 7: "at standstill; while moving 0x06". It was refused for a while after axis_state had shown standstill.
TEST_P(Standstill, IsShownWhereARelativeMoveIsAccepted) {
  ready();
  Client& a = plant_->a;
  ASSERT_EQ(a.row(row::target_position, 5000), kOk);
  ASSERT_EQ(a.command(kMove), kOk);
  takes_a_distance_when_it_shows("a move");
  ASSERT_EQ(a.command(kDisable), kOk);
  ASSERT_EQ(a.command(kEnable), kOk);
  takes_a_distance_when_it_shows("an enable");
  halts(row::target_position, kFar, kMove);
  if (!has_speeds(GetParam())) return;
  halts(row::target_velocity, kSpeed, kRun);
  ASSERT_EQ(a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(a.command(0), kOk);
  ASSERT_EQ(a.command(kRun), kOk);
  plant_->run(500ms);
  ASSERT_EQ(a.row(row::target_velocity, 0), kOk);
  ASSERT_TRUE(plant_->comes_to_stand());
  EXPECT_NE(plant_->b.word(shown::axis_state), kStandstill) << "the run goes on, at no speed";
  ASSERT_EQ(a.command(kHalt), kOk);
  takes_a_distance_when_it_shows("a halt of a run at no speed");
}

INSTANTIATE_TEST_SUITE_P(Every, Standstill, testing::ValuesIn(subjects(has_positions)), named);
INSTANTIATE_TEST_SUITE_P(Every, GoesOn, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, GoesOnAtASpeed, testing::ValuesIn(subjects(has_speeds)), named);

}  // namespace
}  // namespace axisgate::test::obey
