// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/watch/motion_watch.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::drive {
namespace {

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

std::optional<MotionWatch::Unexpected> MotionWatch::observe(const Seen& seen) {
  if (!seen.there) reset();
  if (!seen.there) return std::nullopt;
  const bool asked = seen.asked != asked_ || phase_ == Phase::unwatched;
  const bool stopped = (seen.stops != stops_ || phase_ == Phase::powerless) && !asked;
  if (!seen.torque) {
    if (phase_ != Phase::unwatched) phase_ = Phase::powerless;
    return std::nullopt;
  }
  asked_ = seen.asked;
  stops_ = seen.stops;
  if (seen.explained)
    phase_ = Phase::explained;
  else if (asked || stopped || phase_ == Phase::explained)
    begin_end(seen.at, stopped);
  std::optional<Unexpected> out;
  if (seen.velocity && seen.velocity->at > velocity_at_) {
    velocity_at_ = seen.velocity->at;
    out = take_velocity(*seen.velocity, seen.window);
  }
  if (rules_.by_position && seen.position && seen.position->at > position_at_) {
    position_at_ = seen.position->at;
    out = take_position(*seen.position, seen.velocity.has_value(), seen.window);
  }
  if (out) end_explanation(seen.at);
  return out;
}

void MotionWatch::begin_end(Instant at, bool by_stop) {
  phase_ = Phase::ends;
  ended_ = at;
  rest_.reset();
  beyond_.reset();
  derived_from_.reset();
  slowing_.reset();
  if (by_stop) slowing_.emplace(at + std::max(kStopGoesOut, rules_.lag));
}

// A stop that takes effect late, or a ramp that begins slowly, is one as soon as it makes the motor slower.
void MotionWatch::take_speed(double speed, Instant at, Duration window) {
  if (!slowing_ || phase_ == Phase::explained || at < ended_) return;
  if (slowing_->take(speed, at)) {
    phase_ = Phase::ends;
    beyond_.reset();
  } else if (phase_ == Phase::ends && slowing_->ended(at, window)) {
    end_explanation(at);
  }
}

std::optional<MotionWatch::Unexpected> MotionWatch::take_velocity(const TimedValue& velocity, Duration window) {
  const double speed = std::abs(velocity.value);
  take_speed(speed, velocity.at, window);
  if (rules_.by_position) return std::nullopt;
  if (phase_ == Phase::ends && speed <= rules_.standstill && velocity.at >= ended_ + rules_.lag) {
    slowing_.reset();
    end_explanation(velocity.at);
  }
  if (phase_ == Phase::settles && velocity.at >= settled_) phase_ = Phase::watches;
  if (phase_ != Phase::watches || !is_second(speed > model::kTimesStandstill * rules_.standstill, velocity.at))
    return std::nullopt;
  return Unexpected{.from = {}, .now = velocity.value};
}

std::optional<MotionWatch::Unexpected> MotionWatch::take_position(const TimedValue& position, bool tells_velocity,
                                                                  Duration window) {
  if (!tells_velocity) derive_speed(position, window);
  if (phase_ == Phase::ends && position.at >= ended_) look_for_rest(position);
  if (phase_ == Phase::settles && position.at >= settled_) {
    phase_ = Phase::watches;
    reference_ = position;
    beyond_.reset();
  }
  if (phase_ != Phase::watches) return std::nullopt;
  const double off = position.value - reference_->value;
  constexpr double kSecondsPerMinute = 60;
  const double creeps = rules_.travel * seconds(position.at - reference_->at) / kSecondsPerMinute;
  reference_ = TimedValue{reference_->value + std::clamp(off, -creeps, creeps), position.at};
  if (!is_second(std::abs(off) > rules_.travel, position.at)) return std::nullopt;
  return Unexpected{.from = reference_->value, .now = position.value};
}

// A velocity that shows 0 may be of before, or never anything else: that it stands its position shows.
void MotionWatch::look_for_rest(const TimedValue& position) {
  if (!rest_ || std::abs(position.value - rest_->value) > rules_.travel / kPartStanding) {
    rest_ = position;
  } else if (position.at - rest_->at >= rules_.settle) {
    slowing_.reset();
    end_explanation(position.at);
  }
}

void MotionWatch::derive_speed(const TimedValue& position, Duration window) {
  constexpr double kPerTurnEachSecond = 60'000;  // 0.001 rpm
  if (!derived_from_) derived_from_ = position;
  const Duration since = position.at - derived_from_->at;
  if (since < std::chrono::milliseconds(100)) return;
  const double speed = std::abs(position.value - derived_from_->value) / seconds(since) * kPerTurnEachSecond;
  derived_from_ = position;
  take_speed(speed, position.at, window);
}

bool MotionWatch::is_second(bool beyond, Instant at) {
  if (!beyond) {
    beyond_.reset();
    return false;
  }
  if (!beyond_) beyond_ = at;
  return at - *beyond_ >= rules_.settle;
}

}  // namespace axisgate::drive
