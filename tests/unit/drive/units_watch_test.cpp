// SPDX-License-Identifier: Apache-2.0
// A velocity that does not fit the position, and what only looks so.
#include "gateway/drive/watch/units_watch.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "gateway/drive/watch/target_watch.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

constexpr Instant kBegin = Instant(1000s);

/// A motor whose drive shows its velocity `scale` times as large, `lag` late.
class UnitsScene {
 public:
  explicit UnitsScene(double scale, Duration poll = 20ms, Duration lag = 0ms)
      : poll_(poll), lag_(lag), scale_(scale), watch_({.standstill = 1, .lag = 300ms}) {
    seen.counts = true;
    seen.window = std::max<Duration>(1s, 4 * poll);
  }
  void changes(double from_rpm, double to_rpm, Duration time) {
    for (Duration at{}; at < time; at += 10ms) {
      const double part = std::chrono::duration<double>(at) / std::chrono::duration<double>(time);
      const double rpm = from_rpm + (to_rpm - from_rpm) * part;
      now_ += 10ms;
      position_ += rpm / 60 * 0.01;
      shown_.push_back(rpm);
      if (shown_.size() > static_cast<std::size_t>(lag_ / 10ms) + 1) shown_.pop_front();
      if ((now_ - kBegin) % poll_ != 0s) continue;
      seen.position = TimedValue{position_, now_};
      seen.velocity = TimedValue{shown_.front() * scale_, now_};
      if (const auto said = watch_.observe(seen)) newest = said, ++times;
    }
  }
  void runs(double rpm, Duration time) { changes(rpm, rpm, time); }
  void reset() { watch_.reset(); }
  void jumps(double turns) { position_ += turns; }

  UnitsWatch::Seen seen;
  int times = 0;
  std::optional<UnitsWatch::Disagreement> newest;

 private:
  Duration poll_, lag_;
  double scale_;
  UnitsWatch watch_;
  Instant now_ = kBegin;
  double position_ = 3;
  std::deque<double> shown_;
};

TEST(UnitsWatch, TellsBothNumbersAfterThreeWindows) {
  UnitsScene scene(10);
  scene.runs(60, 3500ms);
  EXPECT_EQ(scene.times, 0);
  scene.runs(60, 2s);
  ASSERT_EQ(scene.times, 1);
  EXPECT_NEAR(scene.newest->velocity, 600, 1);
  EXPECT_NEAR(scene.newest->position, 60, 3);
  scene.runs(60, 60s);
  EXPECT_EQ(scene.times, 1);
  scene.reset();
  scene.runs(60, 6s);
  EXPECT_EQ(scene.times, 2);
}

TEST(UnitsWatch, TellsADirectionAndAVelocityThatIsAlwaysZero) {
  for (const double scale : {-1.0, 0.0, 0.7, 1.4}) {
    UnitsScene scene(scale);
    scene.runs(-120, 6s);
    EXPECT_EQ(scene.times, 1) << scale;
  }
}

TEST(UnitsWatch, TellsItOfSlowPollsAndOfSeveralMotions) {
  UnitsScene slow(10, 1s);
  slow.runs(60, 20s);
  EXPECT_EQ(slow.times, 1);
  UnitsScene several(10);
  for (int motion = 0; motion < 4; ++motion) {
    ++several.seen.motion;
    several.changes(0, 60, 300ms);
    several.runs(60, 1700ms);
    several.changes(60, 0, 300ms);
  }
  EXPECT_EQ(several.times, 1);
}

TEST(UnitsWatch, SaysNothingWhereTheyFit) {
  for (const Duration poll : {20ms, 100ms, 700ms})
    for (const double scale : {0.85, 1.0, 1.2}) {
      UnitsScene scene(scale, poll, 300ms);
      for (int motion = 0; motion < 40; ++motion) {
        ++scene.seen.motion;
        const double rpm = motion % 2 == 0 ? 300 : -300;
        scene.changes(0, rpm, 200ms);
        scene.runs(rpm, motion * 113ms);
        scene.changes(rpm, 0, 200ms);
      }
      EXPECT_EQ(scene.times, 0) << poll / 1ms << ' ' << scale;
    }
}

TEST(UnitsWatch, SaysNothingOfStandstillAndOfSpeedsThatChange) {
  UnitsScene scene(10);
  scene.runs(0, 10s);
  scene.runs(0.9, 60s);
  EXPECT_EQ(scene.times, 0) << "both below ten times standstill";
  for (int wave = 0; wave < 20; ++wave) {
    scene.changes(60, 120, 500ms);
    scene.changes(120, 60, 500ms);
  }
  EXPECT_EQ(scene.times, 0);
}

// Each poll falls between two moves: it sees the way and no speed.
TEST(UnitsWatch, SaysNothingOfShortMovesThatASlowPollMisses) {
  UnitsScene scene(1, 1s);
  for (int move = 0; move < 60; ++move) {
    ++scene.seen.motion;
    scene.runs(300, 400ms);
    scene.runs(0, 600ms);
  }
  EXPECT_EQ(scene.times, 0);
}

TEST(UnitsWatch, SaysNothingOfAPositionThatIsSet) {
  UnitsScene scene(1);
  for (int time = 0; time < 20; ++time) {
    scene.runs(30, 400ms);
    scene.seen.counts = false;
    scene.jumps(5);
    scene.runs(30, 100ms);
    scene.seen.counts = true;
  }
  EXPECT_EQ(scene.times, 0);
}

using End = TargetWatch::End;
using Finding = TargetWatch::Finding;
constexpr double kTravel = 0.1;

TargetWatch::Seen standing(Duration after, double position, End end = End::none, std::uint64_t move = 1) {
  return {.at = kBegin + after, .move = move, .end = end, .position = position, .target = 2};
}

TEST(TargetWatch, TellsOfAMoveThatStandsAtItsTargetUnreachedOnce) {
  TargetWatch watch;
  EXPECT_FALSE(watch.observe(standing(0s, 2), kTravel));
  EXPECT_FALSE(watch.observe(standing(4900ms, 2), kTravel));
  EXPECT_FALSE(watch.observe({}, kTravel)) << "it turns";
  EXPECT_FALSE(watch.observe(standing(5s, 2), kTravel));
  EXPECT_EQ(watch.observe(standing(10s, 2), kTravel), Finding::not_reached);
  EXPECT_FALSE(watch.observe(standing(20s, 2), kTravel)) << "once";
  EXPECT_FALSE(watch.observe(standing(22s, 2, End::none, 2), kTravel));
  EXPECT_EQ(watch.observe(standing(27s, 2, End::none, 2), kTravel), Finding::not_reached) << "another move";
}

TEST(TargetWatch, TellsOfAMoveThatIsHeldElsewhereAndOfNoneThatCreeps) {
  TargetWatch watch;
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(watch.observe(standing(i * 1s, 1 + i * 0.01), kTravel)) << i;
  EXPECT_FALSE(watch.observe(standing(23s, 1.19), kTravel));
  EXPECT_EQ(watch.observe(standing(25s, 1.19), kTravel), Finding::held);
}

TEST(TargetWatch, LooksWhereAMoveThatHasEndedStandsOnceItHasSettled) {
  TargetWatch watch;
  EXPECT_FALSE(watch.observe(standing(0s, 1.5, End::reached), kTravel));
  EXPECT_FALSE(watch.observe(standing(900ms, 1.96, End::reached), kTravel)) << "it settles";
  EXPECT_FALSE(watch.observe(standing(3s, 1.96, End::reached), kTravel)) << "near enough";
  EXPECT_FALSE(watch.observe(standing(4s, 0, End::reached, 2), kTravel));
  EXPECT_EQ(watch.observe(standing(5s, 0, End::reached, 2), kTravel), Finding::elsewhere);
  EXPECT_FALSE(watch.observe(standing(6s, 1.99, End::failed, 3), kTravel));
  EXPECT_EQ(watch.observe(standing(7s, 1.99, End::failed, 3), kTravel), Finding::short_of_it) << "it says why";
}

}  // namespace
}  // namespace axisgate::drive
