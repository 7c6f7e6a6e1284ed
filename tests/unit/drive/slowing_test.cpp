// SPDX-License-Identifier: Apache-2.0
// What counts as a motor that gets slower after its stop, and what as one that turns on.
#include "gateway/drive/watch/slowing.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kRpm = 1000, kStandstill = kRpm;
constexpr Duration kLook = 20ms, kAnswer = 900ms;

/// A speed in 0.001 rpm, so long after the stop.
using Curve = std::function<double(Duration)>;

double part(Duration of, Duration whole) {
  return std::chrono::duration<double>(of) / std::chrono::duration<double>(whole);
}
Curve ramp(double rpm, Duration takes) {
  return [=](Duration at) { return rpm * kRpm * std::max(0.0, 1 - part(at, takes)); };
}
Curve steady(double rpm) {
  return [=](Duration) { return rpm * kRpm; };
}
/// Up to so much to either side, each look otherwise.
Curve noisy(Curve curve, double rpm) {
  return [=](Duration at) {
    const auto look = static_cast<std::uint32_t>(at / kLook);
    return curve(at) + rpm * kRpm * (static_cast<double>(look * 2654435761U >> 8 & 1023U) / 511.5 - 1);
  };
}
Curve late(Curve curve, Duration by) {
  return [=](Duration at) { return curve(std::max<Duration>(Duration{}, at - by)); };
}

/// It is measured each so long, and held.
Curve held(Curve curve, Duration each) {
  return [=](Duration at) { return curve(at / each * each); };
}

/// When it was seen to fall; none: not within the time of an answer.
std::optional<Duration> falls_after(const Curve& curve, Duration look = kLook) {
  FirstFall fall;
  for (Duration at = look; at < kAnswer; at += look)
    if (fall.falls(std::llround(curve(at)), Instant{} + at, kStandstill)) return at;
  return std::nullopt;
}

TEST(FirstFall, IsSeenAtOnceInAShortRamp) {
  EXPECT_LE(falls_after(ramp(300, 500ms)), 40ms);
  EXPECT_LE(falls_after(ramp(-3000, 500ms)), 40ms) << "either way";
  EXPECT_LE(falls_after(noisy(ramp(100, 500ms), 3)), 100ms);
}

TEST(FirstFall, IsSeenInARampOfFortySecondsAlsoByAVelocityThatIsLate) {
  for (const double rpm : {300.0, 1500.0, -3000.0}) {
    EXPECT_TRUE(falls_after(ramp(rpm, 40s))) << rpm;
    EXPECT_TRUE(falls_after(late(ramp(rpm, 40s), 300ms))) << rpm;
    EXPECT_TRUE(falls_after(ramp(rpm, 40s), 90ms)) << rpm << ": a slow line";
    EXPECT_TRUE(falls_after(held(ramp(rpm, 40s), 200ms))) << rpm;
  }
}

TEST(FirstFall, IsNoneWhereTheMotorTurnsOn) {
  for (const double rpm : {5.0, 30.0, 150.0, -1500.0}) {
    EXPECT_FALSE(falls_after(steady(rpm))) << rpm;
    EXPECT_FALSE(falls_after(noisy(steady(rpm), 0.5))) << rpm << ": it flickers";
    EXPECT_FALSE(falls_after(noisy(steady(rpm), 3))) << rpm;
    EXPECT_FALSE(falls_after(held(noisy(steady(rpm), 3), 200ms))) << rpm;
  }
}

TEST(FirstFall, IsNoneAsLongAsTheMotorStillStarts) {
  EXPECT_FALSE(falls_after([](Duration at) { return part(at, 1s) * 300 * kRpm; }));
  const Curve turns_back = [](Duration at) {
    return (at < 300ms ? part(at, 300ms) : part(600ms - at, 300ms)) * 90'000;
  };
  EXPECT_GT(falls_after(turns_back), 300ms) << "and then it obeys";
}

TEST(FirstFall, GoesByWhatItWasBeforeItsStop) {
  FirstFall fall;
  fall.before(-100 * kRpm);
  EXPECT_TRUE(fall.falls(-80 * kRpm, Instant{}, kStandstill));
}

TEST(FirstFall, TellsNoiseAboutStandstillByItsSign) {
  FirstFall fall;
  EXPECT_FALSE(fall.falls(3 * kRpm, Instant{}, kStandstill));
  EXPECT_FALSE(fall.turned_round());
  EXPECT_FALSE(fall.falls(2 * kRpm, Instant{} + kLook, kStandstill));
  EXPECT_FALSE(fall.turned_round()) << "it creeps";
  EXPECT_FALSE(fall.falls(-3 * kRpm, Instant{} + 2 * kLook, kStandstill));
  EXPECT_TRUE(fall.turned_round());
}

constexpr Duration kWindow = 320ms;

/// When it was told to turn on; none: not within a minute.
std::optional<Duration> turns_on_after(const Curve& curve, Duration poll = 20ms) {
  Slowing slowing(Instant{});
  for (Duration at = poll; at < 60s; at += poll) {
    const double speed = std::abs(curve(at));
    if (speed < 1) return std::nullopt;  // it stands
    slowing.take(speed, Instant{} + at);
    if (slowing.ended(Instant{} + at, std::max<Duration>(300ms + poll, Slowing::kPatience))) return at;
  }
  return std::nullopt;
}

TEST(Slowing, ARampOfFortySecondsIsOne) {
  for (const Duration poll : {20ms, 500ms, 700ms}) {
    EXPECT_FALSE(turns_on_after(ramp(1500, 40s), poll)) << poll / 1ms;
    EXPECT_FALSE(turns_on_after(ramp(150, 40s), poll)) << poll / 1ms;
  }
}

TEST(Slowing, AMotorThatGetsNoSlowerOrFasterTurnsOn) {
  const auto at_once = [](std::optional<Duration> told) { return told && *told <= Slowing::kPatience + 40ms; };
  EXPECT_TRUE(at_once(turns_on_after(steady(150))));
  EXPECT_TRUE(turns_on_after(noisy(steady(150), 3)));
  EXPECT_TRUE(at_once(turns_on_after([](Duration at) { return 100'000 + part(at, 1s) * 10'000; })));
  const Curve half_way = [](Duration at) { return at < 1s ? 100'000 - 20'000 * part(at, 1s) : 80'000; };
  EXPECT_TRUE(turns_on_after(half_way));
  EXPECT_TRUE(turns_on_after(steady(150), 500ms));
}

TEST(Slowing, CountsFromTheSpeedThatIsShownLateOfWhatHadJustStarted) {
  const Curve shown = [](Duration at) { return at < 300ms ? 1.0 : ramp(150, 20s)(at); };
  EXPECT_FALSE(turns_on_after(shown));
  const Curve of_before = [](Duration at) { return at < 300ms ? 90'000 * (1 - part(at, 301ms)) : ramp(150, 20s)(at); };
  Slowing slowing(Instant{} + 1s);
  for (Duration at{}; at < 15s; at += 20ms) {
    slowing.take(of_before(at), Instant{} + at);
    EXPECT_FALSE(slowing.ended(Instant{} + at, 1s)) << at / 1ms;
  }
}

TEST(Slowing, NeedNotBeginBeforeItsTimeNorWhileNothingIsHeard) {
  Slowing slowing(Instant{} + 1s);
  slowing.take(100, Instant{});
  EXPECT_FALSE(slowing.ended(Instant{} + 1s, kWindow));
  EXPECT_TRUE(slowing.ended(Instant{} + 1s + kWindow, kWindow));
  Slowing unheard(Instant{});
  unheard.take(100, Instant{} + 10s);
  EXPECT_FALSE(unheard.ended(Instant{} + 10s, kWindow)) << "the first look";
}

}  // namespace
}  // namespace axisgate::drive
