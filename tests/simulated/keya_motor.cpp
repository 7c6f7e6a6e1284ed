// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/keya_motor.hpp"

#include <algorithm>
#include <cstdlib>

#include "tests/simulated/trapezoid.hpp"

namespace axisgate::simulated {
namespace {

constexpr Time tenth = std::chrono::milliseconds(100);
constexpr std::int64_t edges_per_line = 4;
constexpr std::uint16_t accelerating_amperes = 3, running_amperes = 1;

}  // namespace

KeyaMotor::KeyaMotor(const KeyaParameters& parameters, KeyaMotorName name, const Mechanics& mechanics)
    : mechanics_(mechanics),
      configured_(static_cast<KeyaMode>(parameters.of(name, 20))),
      mode_(configured_),
      turn_(edges_per_line * parameters.of(name, 4)),
      most_current_(parameters.of(name, 3)),
      pole_pairs_(parameters.of(name, 1) / 2),
      rated_(speed_dec(parameters.of(name, 2), turn_)),
      acceleration_(rated_ * one_millisecond / (parameters.of(name, 13) * tenth)),
      deceleration_(rated_ * one_millisecond / (parameters.of(name, 30) * tenth)),
      brake_delay_(parameters.of(name, 27) * tenth),
      direction_(parameters.reversed(name) ? -1 : 1),
      axis_(mechanics_, turn_) {}

void KeyaMotor::enable(KeyaMode mode) {
  if (enabled_ && mode == mode_) return;
  enabled_ = true;
  mode_ = mode;
  value_ = 0;
  axis_.forget_demand();
  target_ = axis_.demand();
}

void KeyaMotor::disable(KeyaStop how, Time now) {
  if (!enabled_) return;
  enabled_ = false;
  value_ = 0;
  mode_ = configured_;
  stop_ = how;
  brake_at_ = now + brake_delay_;
}

bool KeyaMotor::move_to(std::int32_t target) {
  const FinePosition before = target_;
  // The counter wraps at 32 bits, the motor does not.
  target_ = (counts_of(axis_.actual()) + target - count()) * fine_per_count;
  return target_ != before;
}

bool KeyaMotor::move_by(std::int64_t distance) {
  target_ += distance * fine_per_count;
  return distance != 0;
}

Dec KeyaMotor::wanted_speed(Time at) const {
  const Dec now = axis_.speed();
  const Dec full = acceleration_dec(mechanics_.rps_per_s_at_full_current, turn_);
  if (!enabled_) {
    if (at >= brake_at_) return ramp(now, 0, full, full);
    const Dec friction = acceleration_dec(mechanics_.coasting_rps_per_s, turn_);
    const Dec slower = stop_ == KeyaStop::ramp ? deceleration_ : friction;
    return ramp(now, 0, slower, slower);
  }
  if (mode_ == KeyaMode::speed) return ramp(now, rated_ * value_ / keya_full_scale, acceleration_, deceleration_);
  if (mode_ == KeyaMode::torque) {
    const Dec friction = acceleration_dec(mechanics_.coasting_rps_per_s, turn_);
    if (value_ == 0) return ramp(now, 0, friction, friction);
    return std::clamp(now + full * value_ / keya_full_scale, -rated_, rated_);
  }
  const Dec highest = std::max<Dec>(rated_ * limit_ / keya_full_scale, 1);
  return approach(now, target_ - axis_.demand(), highest, acceleration_, deceleration_);
}

void KeyaMotor::step(Time at) {
  const Dec before = axis_.speed();
  const bool position_loop = enabled_ && (mode_ == KeyaMode::absolute || mode_ == KeyaMode::relative);
  axis_.step(wanted_speed(at), position_loop, direction_);
  ramping_ = axis_.speed() != before;
}

bool KeyaMotor::still() const {
  if (axis_.speed() != 0 || axis_.actual_speed() != 0) return false;
  if (!enabled_) return true;
  if (mode_ == KeyaMode::speed || mode_ == KeyaMode::torque) return value_ == 0;
  return target_ == axis_.demand() && std::abs(axis_.actual() - axis_.demand()) <= axis_.short_by();
}

std::uint16_t KeyaMotor::current() const {
  if (shown_current_) return *shown_current_;
  if (!enabled_) return 0;
  // The unit of 0003 is not stated; 0.1 A would make its default 15 A.
  if (mode_ == KeyaMode::torque) return static_cast<std::uint16_t>(std::abs(value_) * most_current_ / 100000);
  if (ramping_) return accelerating_amperes;
  return axis_.speed() != 0 ? running_amperes : 0;
}

std::uint16_t KeyaMotor::mechanical_angle() const {
  const std::int64_t within = (count() % turn_ + turn_) % turn_;
  return static_cast<std::uint16_t>(within * keya_full_scale / turn_);
}

std::uint16_t KeyaMotor::electrical_angle() const {
  return static_cast<std::uint16_t>(mechanical_angle() * pole_pairs_ / 10 % 1000);
}

void KeyaMotor::set_count(std::int32_t count) {
  const FinePosition before = axis_.actual();
  axis_.redefine(count * fine_per_count);
  target_ += axis_.actual() - before;
}

}  // namespace axisgate::simulated
