// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/plan/motion_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace axisgate::commands {
namespace {

using std::chrono::milliseconds;

/// A rate over less is one sample's jitter.
constexpr Duration kRateOver = milliseconds(150);
/// Ramps, and filters of a drive's speed, are over by then.
constexpr Duration kRampIsOver = milliseconds(1000);
/// So much of it is judged while it goes on.
constexpr Duration kLongSteady = milliseconds(1000);
/// What is said to be reached may still be sampled.
constexpr Duration kSettles = milliseconds(400);
/// A way so short says nothing of a rate.
constexpr double kShort = 0.5;  // turns
constexpr double kBack = 0.02;  // turns: the shaft has some play

bool fits(double one, double other) {
  return std::abs(one - other) <= MotionCheck::kWithin * std::max(std::abs(one), std::abs(other));
}

/// "60 times as fast", "backwards".
std::string ratio_text(double seen, double asked) {
  if (seen * asked < 0) return "the sign is another";
  const double ratio = std::abs(seen / asked);
  if (ratio < 1) return fmt::format("{:.3g} times too slow", 1 / ratio);
  return fmt::format("{:.3g} times as fast", ratio);
}

}  // namespace

MotionCheck::Says MotionCheck::stop(std::string why) {
  why_ = std::move(why);
  return Says::stop;
}

MotionCheck::Says MotionCheck::look(const AxisImage& image, Instant now) {
  take(image, now);
  if (std::string why = broken_bound(image, now); !why.empty()) return stop(std::move(why));
  if (std::string why = position_bound(); !why.empty()) return stop(std::move(why));
  if (asked_.judged && long_steady()) judge_rates();
  if (!why_.empty()) return Says::stop;
  if (!over(image, now)) return Says::goes_on;
  if (asked_.judged) judge();
  return Says::done;
}

void MotionCheck::take(const AxisImage& image, Instant now) {
  has_position_ = image.supports(Quantity::position_actual);
  has_velocity_ = image.supports(Quantity::velocity_actual);
  const auto turns = turns_of(image);
  if (turns || !has_position_) good_at_ = now;
  const auto add = [](std::vector<Point>& points, std::optional<double> value, Instant at) {
    if (value && (points.empty() || at > points.back().at)) points.push_back({*value, at});
  };
  add(positions_, turns, image[Quantity::position_actual].at);
  add(velocities_, rpm_of(image), image[Quantity::velocity_actual].at);
}

std::string MotionCheck::broken_bound(const AxisImage& image, Instant now) const {
  if (!image.reachable()) return fmt::format("the drive fell silent ({})", text(image.link_state));
  if (image.has(AxisInput::fault))
    return fmt::format("the drive shows a fault, error_code {:#06x}", image[Quantity::error_code].value);
  if (!image.has(AxisInput::enabled)) return "the axis lost its torque";
  if (now - good_at_ >= kBlind) return "position_actual has no value any more";
  if ((image.alarms & bit(AxisAlarm::units_disagree)) != 0) return "velocity_actual and position_actual disagree";
  const bool ours = image.motion_id == asked_.id;
  if (ours && (image.motion_state == MotionState::aborted || image.motion_state == MotionState::failed))
    return "the motion was aborted or failed";
  if (asked_.kind != MotionAsked::Kind::run && now - begun_ >= asked_.time)
    return fmt::format("it was not reported done within {:.3g} s", in_seconds(asked_.time));
  const auto rpm = rpm_of(image);
  if (rpm && std::abs(*rpm) > kTooFast * std::abs(asked_.rpm) + kNoise)
    return fmt::format("velocity_actual shows {:.4g} rpm, asked were {:.4g}", *rpm, asked_.rpm);
  return {};
}

std::string MotionCheck::position_bound() const {
  if (positions_.size() < 2) return {};
  if (std::abs(way()) > asked_.most)
    return fmt::format("it turned by {:.4g} turns, {:.4g} were the bound", way(), asked_.most);
  if (asked_.kind != MotionAsked::Kind::home && way() * asked_.rpm < 0 && std::abs(way()) > kBack)
    return fmt::format("it turns the other way: position_actual goes {}", way() > 0 ? "up" : "down");
  const Point& newest = positions_.back();
  const auto before = std::find_if(positions_.rbegin(), positions_.rend(),
                                   [&](const Point& point) { return newest.at - point.at >= kRateOver; });
  if (before == positions_.rend()) return {};
  const double rpm = (newest.value - before->value) / in_seconds(newest.at - before->at) * kSecondsPerMinute;
  if (std::abs(rpm) <= kTooFast * std::abs(asked_.rpm) + kNoise) return {};
  const std::string row =
      velocities_.empty() ? "" : fmt::format(", velocity_actual says {:.4g}", velocities_.back().value);
  return fmt::format("it turns at {:.4g} rpm by its position, asked were {:.4g}{}: a unit or word order is wrong", rpm,
                     asked_.rpm, row);
}

bool MotionCheck::over(const AxisImage& image, Instant now) {
  if (asked_.kind == MotionAsked::Kind::run) return now - begun_ >= asked_.time;
  if (!completed_ && image.motion_id == asked_.id && image.motion_state == MotionState::completed) completed_ = now;
  return completed_ && now - *completed_ >= kSettles;
}

Duration MotionCheck::nominal() const {
  if (asked_.kind != MotionAsked::Kind::move) return asked_.time;
  return std::chrono::duration_cast<Duration>(
      std::chrono::duration<double>(std::abs(asked_.turns / asked_.rpm) * kSecondsPerMinute));
}

bool MotionCheck::is_steady(Instant at) const {
  return at >= begun_ + kRampIsOver && at <= begun_ + nominal() - kSettles;
}

bool MotionCheck::long_steady() const {
  if (asked_.kind == MotionAsked::Kind::home || positions_.empty()) return false;
  const Instant newest = positions_.back().at;
  return is_steady(newest) && newest >= begun_ + kRampIsOver + kLongSteady;
}

std::optional<double> MotionCheck::rate() const {
  const auto first = std::ranges::find_if(positions_, [&](const Point& p) { return is_steady(p.at); });
  const auto last =
      std::find_if(positions_.rbegin(), positions_.rend(), [&](const Point& p) { return is_steady(p.at); });
  if (first == positions_.end() || last == positions_.rend() || last->at - first->at < kRateOver) return std::nullopt;
  return (last->value - first->value) / in_seconds(last->at - first->at) * kSecondsPerMinute;
}

std::optional<double> MotionCheck::velocity() const {
  double sum = 0;
  int count = 0;
  for (const Point& point : velocities_) {
    if (!is_steady(point.at)) continue;
    sum += point.value;
    ++count;
  }
  return count == 0 ? std::nullopt : std::optional(sum / count);
}

std::string MotionCheck::seen() const {
  if (positions_.empty()) return "the drive tells no position";
  const std::string turned = fmt::format("it turned by {:.4g} turns", way());
  if (asked_.kind == MotionAsked::Kind::home ||
      (asked_.kind == MotionAsked::Kind::move && std::abs(asked_.turns) < kShort))
    return turned;
  const auto shown = [](const std::optional<double>& rpm) {
    return rpm ? fmt::format("{:.4g} rpm", *rpm) : "not known";
  };
  return fmt::format("{}: {} by position, {} by velocity_actual, {:.4g} asked", turned, shown(rate()),
                     shown(velocity()), asked_.rpm);
}

void MotionCheck::judge() {
  if (!has_position_ || asked_.kind == MotionAsked::Kind::home) return;
  if (positions_.size() < 2) {
    why_ = "no position was sampled while it turned";
    return;
  }
  if (asked_.kind == MotionAsked::Kind::run) return judge_rates();
  constexpr double kLeast = 0.01;  // turns
  if (std::abs(way() - asked_.turns) > std::max(kLeast, kWithin * std::abs(asked_.turns))) {
    why_ = fmt::format("{:.4g} turns were asked, and it turned by {:.4g}", asked_.turns, way());
    return;
  }
  const Duration took = *completed_ - begun_;
  if (took < std::chrono::duration_cast<Duration>(nominal() * (1 - kWithin))) {
    why_ = fmt::format("at {:.4g} rpm it should take {:.3g} s, and it took {:.2g}: the unit of speed is wrong",
                       asked_.rpm, in_seconds(nominal()), in_seconds(took));
    return;
  }
  if (std::abs(asked_.turns) >= kShort) judge_rates();
}

void MotionCheck::judge_rates() {
  const auto turned = rate();
  const auto shown = velocity();
  if (!turned) {
    why_ = "too few positions were sampled to tell how fast it turned";
  } else if (!fits(*turned, asked_.rpm)) {
    why_ = fmt::format("by its position, of what was asked, {}", ratio_text(*turned, asked_.rpm));
    if (*turned * asked_.rpm >= 0) why_ += ": the unit of speed or the counts of a turn are wrong";
  } else if (has_velocity_ && !shown) {
    why_ = "velocity_actual had no value while it turned";
  } else if (shown && !fits(*turned, *shown)) {
    why_ = fmt::format("velocity_actual does not fit the position: {}", ratio_text(*shown, *turned));
  }
}

}  // namespace axisgate::commands
