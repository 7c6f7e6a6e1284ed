// SPDX-License-Identifier: Apache-2.0
// What the watch says of a motor, and of what it says nothing: whatever a plant does all day is no unexpected motion.
#include "gateway/drive/watch/motion_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

constexpr Instant kStart = Instant(1000s);
constexpr Duration kLag = 300ms;

/// A motor, and the drive that tells of it. Its ways are in turns, its speeds in rpm.
class Scene {
 public:
  explicit Scene(MotionWatch::Rules rules = {.lag = kLag}) : watch_(rules) { stands(3s); }

  MotionWatch::Seen seen{.there = true, .torque = true, .window = kLag + 20ms, .position = {}, .velocity = {}};
  Duration poll = 20ms;
  bool tells_velocity = true;
  bool tells_position = true;
  bool answers = true;
  std::function<double(Duration)> noise = [](Duration) { return 0.0; };  ///< of the velocity, rpm
  double position = 7.25;

  /// So fast for so long.
  void runs(double rpm, Duration time) { changes(rpm, rpm, time); }
  void stands(Duration time) { runs(0, time); }
  void changes(double from_rpm, double to_rpm, Duration time) {
    const Instant begin = now_;
    while (now_ < begin + time) {
      const double part = std::chrono::duration<double>(now_ - begin) / std::chrono::duration<double>(time);
      const double rpm = from_rpm + (to_rpm - from_rpm) * part;
      now_ += 10ms;
      position += rpm / 60 * 0.01;
      speed_ = rpm;
      if (now_ - polled_ >= poll) look();
    }
  }
  void look() {
    polled_ = now_;
    seen.at = now_;
    if (answers && tells_position) seen.position = TimedValue{position, now_};
    if (answers && tells_velocity) seen.velocity = TimedValue{(speed_ + noise(now_ - kStart)) * 1000, now_};
    if (const auto said = watch_.observe(seen)) {
      newest = said;
      said_at_ = now_;
      ++times;
    }
  }
  /// A move of two turns.
  void moves() {
    ++seen.asked;
    seen.explained = true;
    changes(0, 300, 200ms);
    runs(300, 200ms);
    changes(300, 0, 200ms);
  }
  void ends() { seen.explained = false; }
  void stop() { ++seen.stops, ends(); }
  void reset() { watch_.reset(); }
  [[nodiscard]] Instant now() const { return now_; }
  [[nodiscard]] Instant said_at() const { return said_at_; }

  int times = 0;
  std::optional<MotionWatch::Unexpected> newest;

 private:
  MotionWatch watch_;
  Instant now_ = kStart;
  Instant polled_ = kLongAgo;
  Instant said_at_ = kLongAgo;
  double speed_ = 0;
};

// --- What is unexpected ----------------------------------------------------------------------------------------------

TEST(MotionWatch, TellsWhatMovesByItselfAfterAStop) {
  Scene scene;
  scene.moves();
  scene.runs(300, 500ms);
  scene.stop();
  scene.changes(300, 0, 500ms);
  scene.stands(5s);
  const double stood = scene.position;
  ASSERT_EQ(scene.times, 0);
  const Instant moves_at = scene.now();
  scene.runs(20, 3s);
  ASSERT_EQ(scene.times, 1) << "what goes on is told again, but not each moment";
  EXPECT_NEAR(*scene.newest->from, stood, 0.02);
  EXPECT_GT(scene.newest->now - stood, 0.1);
  EXPECT_LE(scene.said_at() - moves_at, 1500ms);
}

TEST(MotionWatch, TellsWhatMovesAfterAMotionHasEnded) {
  Scene scene;
  scene.moves();
  scene.ends();
  scene.stands(5s);
  ASSERT_EQ(scene.times, 0);
  scene.runs(-300, 100ms);  // half a turn
  scene.stands(2s);
  ASSERT_EQ(scene.times, 1) << "it need not turn on: it is not where it should be";
  EXPECT_LT(scene.newest->now, *scene.newest->from);
}

TEST(MotionWatch, TellsWhatTurnsOnThroughAStop) {
  Scene scene;
  scene.moves();
  scene.runs(100, 1s);
  scene.stop();
  scene.runs(100, 2s);
  EXPECT_EQ(scene.times, 0) << "it may take its time";
  scene.runs(100, 2s);
  ASSERT_EQ(scene.times, 1);
  scene.runs(100, 3s);
  EXPECT_GE(scene.times, 2) << "it turns on all the same";
  scene.stop();
  scene.changes(100, 0, 1s);
  const int until_then = scene.times;
  scene.stands(10s);
  EXPECT_EQ(scene.times, until_then);
}

TEST(MotionWatch, TellsWhatTurnsOnThroughAStopWhereNoVelocityIsTold) {
  Scene scene;
  scene.tells_velocity = false;
  scene.seen.velocity.reset();
  scene.moves();
  scene.runs(100, 1s);
  scene.stop();
  scene.runs(100, 5s);
  EXPECT_GE(scene.times, 1);
}

TEST(MotionWatch, TellsWhatTurnsWithATorqueThatNobodyAskedFor) {
  Scene scene;
  scene.stop();
  scene.seen.torque = false;
  scene.runs(30, 5s);
  ASSERT_EQ(scene.times, 0) << "it has none";
  scene.seen.torque = true;
  scene.stands(5s);
  ASSERT_EQ(scene.times, 0) << "it stands";
  scene.seen.torque = false;
  scene.stands(1s);
  scene.seen.torque = true;
  scene.runs(30, 5s);
  EXPECT_GE(scene.times, 1);
}

TEST(MotionWatch, TellsWhatStopsToGetSlowerHalfWay) {
  Scene scene;
  scene.moves();
  scene.runs(1000, 1s);
  scene.stop();
  scene.changes(1000, 600, 1s);
  scene.runs(600, 4s);
  EXPECT_GE(scene.times, 1);
}

TEST(MotionWatch, GoesByTenTimesStandstillWhereNoPositionIsTold) {
  Scene scene({.lag = kLag, .by_position = false});
  scene.tells_position = false;
  scene.seen.position.reset();
  scene.moves();
  scene.stop();
  scene.stands(3s);
  scene.runs(9, 10s);
  EXPECT_EQ(scene.times, 0) << "below ten times standstill";
  scene.runs(11, 500ms);
  scene.stands(1s);
  EXPECT_EQ(scene.times, 0) << "a moment";
  scene.runs(-11, 1500ms);
  ASSERT_EQ(scene.times, 1);
  EXPECT_EQ(scene.newest->from, std::nullopt);
  EXPECT_EQ(scene.newest->now, -11'000);
}

TEST(MotionWatch, TellsAWayThatIsTooFastForACreep) {
  Scene scene;
  scene.runs(0.4, 60s);  // four times what it may creep
  EXPECT_GE(scene.times, 1);
}

// --- What is not -----------------------------------------------------------------------------------------------------

TEST(NoFalseAlarm, ByOvershootAndSettling) {
  Scene scene;
  for (int move = 0; move < 5; ++move) {
    scene.moves();
    scene.ends();
    for (double swing = 60; swing > 1; swing *= 0.7) {  // 0.5 turns at first
      scene.runs(swing, 250ms);
      scene.runs(-swing, 250ms);
    }
    scene.stands(4s);
  }
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, BySlowPollsOfASerialLine) {
  for (const Duration poll : {300ms, 700ms, 1500ms, 4000ms}) {
    Scene scene;
    scene.poll = poll;
    for (int move = 0; move < 20; ++move) {
      scene.moves();
      if (move % 2 == 0)
        scene.ends();
      else
        scene.stop();
      scene.stands(move * 377ms);
    }
    EXPECT_EQ(scene.times, 0) << poll / 1ms;
  }
}

TEST(NoFalseAlarm, ByAMotorThatIsTurnedByHandWhileDisabled) {
  Scene scene;
  scene.stop();
  scene.seen.torque = false;
  scene.runs(60, 3s);
  scene.stands(200ms);
  ++scene.seen.asked;  // enable
  scene.seen.torque = true;
  scene.runs(-30, 100ms);  // what its controller takes back as torque comes on
  scene.stands(20s);
  EXPECT_EQ(scene.times, 0);
}

// Local control, modes that follow something, a homing under way: whoever looks says that it is explained.
TEST(NoFalseAlarm, ByWhatIsExplained) {
  Scene scene;
  scene.seen.explained = true;
  scene.stands(5s);
  scene.runs(40, 60s);
  scene.runs(-1, 60s);
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, ByAHomingThatSetsThePositionAtItsEnd) {
  Scene scene;
  scene.moves();
  scene.changes(0, -30, 500ms);
  scene.stands(300ms);
  scene.ends();
  scene.position = 0;  // before its end is seen, or after
  scene.stands(500ms);
  scene.position = 0.2;
  scene.stands(20s);
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, ByAnAxisThatWasFoundMoving) {
  Scene scene;
  scene.seen.there = false;
  scene.look();
  scene.seen.there = true;
  scene.runs(150, 60s);
  scene.runs(1, 60s);
  scene.changes(150, 0, 3s);
  scene.stands(10s);
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, ByThreeRpmOfNoiseAtStandstill) {
  Scene scene;
  scene.noise = [](Duration at) { return (at / 10ms) % 3 == 0 ? 3.0 : -3.0; };
  scene.moves();
  scene.stop();
  scene.stands(30s);
  scene.stop();
  scene.stands(30s);
  EXPECT_EQ(scene.times, 0);
  Scene blind({.lag = kLag, .by_position = false});
  blind.noise = scene.noise;
  blind.stop();
  blind.stands(30s);
  EXPECT_EQ(blind.times, 0);
}

TEST(NoFalseAlarm, ByAGapOfTheWire) {
  Scene scene;
  scene.moves();
  scene.runs(300, 300ms);
  scene.stop();
  scene.answers = false;
  scene.changes(300, 0, 800ms);
  scene.stands(5s);
  scene.answers = true;
  scene.stands(5s);
  EXPECT_EQ(scene.times, 0) << "nothing was heard while it slowed down";
  // The drive is away, is turned, and is back.
  scene.seen.there = scene.answers = false;
  scene.runs(100, 2s);
  scene.seen.there = scene.answers = true;
  scene.runs(100, 20s);
  scene.stands(20s);
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, WhereNoVelocityIsTold) {
  Scene scene;
  scene.tells_velocity = false;
  scene.seen.velocity.reset();
  for (int move = 0; move < 5; ++move) {
    scene.moves();
    scene.runs(300, 1s);
    scene.stop();
    scene.changes(300, 0, 8s);
    scene.stands(5s);
  }
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, ByLongRampsAndByRampsThatBeginSlowly) {
  Scene scene;
  for (const Duration ramp : {2s, 12s, 20s}) {
    scene.moves();
    scene.runs(1500, 1s);
    scene.stop();
    scene.runs(1500, 700ms);  // its bus was busy
    scene.changes(1500, 1450, ramp / 8);
    scene.changes(1450, 50, ramp);
    scene.changes(50, 0, ramp / 8);
    scene.stands(5s);
    EXPECT_EQ(scene.times, 0) << ramp / 1s;
  }
  scene.moves();
  scene.runs(1500, 1s);
  scene.stop();
  scene.changes(1500, 0, 60s);
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, ByAVelocityThatIsToldLate) {
  Scene scene;
  double shown = 0;
  for (int move = 0; move < 10; ++move) {
    scene.moves();
    scene.stop();
    scene.noise = [&](Duration) { return shown; };  // of before, while it stands
    shown = 280;
    scene.stands(kLag);
    shown = 0;
    scene.stands(4s);
  }
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, ByACreep) {
  Scene scene;
  scene.runs(0.09, 600s);
  scene.runs(-0.09, 600s);
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, ByOneSampleThatIsElsewhere) {
  Scene scene;
  for (int glitch = 0; glitch < 10; ++glitch) {
    scene.position += 3;
    scene.look();
    scene.position -= 3;
    scene.stands(500ms);
  }
  scene.runs(30, 300ms);  // somebody leans on it, and its controller takes it back
  scene.runs(-30, 300ms);
  scene.stands(5s);
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, ByADriveThatCountsFromElsewhere) {
  Scene scene;
  scene.position = 0;
  scene.reset();
  scene.stands(10s);
  EXPECT_EQ(scene.times, 0);
}

TEST(NoFalseAlarm, ByMotionsThatFollowOneAnother) {
  Scene scene;
  for (int move = 0; move < 100; ++move) {
    scene.moves();
    scene.ends();
    scene.stands(move * 23ms);
    if (move % 3 == 0) scene.stop();
  }
  EXPECT_EQ(scene.times, 0);
}

}  // namespace
}  // namespace axisgate::drive
