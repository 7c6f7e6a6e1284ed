// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/motion.hpp"

#include <algorithm>
#include <cstdlib>

#include "tests/simulated/trapezoid.hpp"

namespace axisgate::simulated {

void Motion::begin(Task task) {
  task_ = task;
  buffered_.reset();
  homing_.reset();
  limited_ = false;
}

void Motion::hold(const Axis& axis) {
  begin(Task::hold);
  target_ = axis.demand();
}

void Motion::move_to(FinePosition target, bool buffered, const Axis& axis) {
  if (buffered && task_ == Task::position && axis.demand() != target_) {
    buffered_ = target;
    return;
  }
  begin(Task::position);
  target_ = target;
}

void Motion::run_at(Dec speed, bool immediate) {
  begin(immediate ? Task::immediate_velocity : Task::velocity);
  target_speed_ = speed;
}

void Motion::stop(Dec deceleration) {
  begin(Task::stop);
  stop_deceleration_ = deceleration;
}

void Motion::home(int method, const HomingSettings& settings, const Axis& axis, std::int64_t encoder_counts) {
  begin(Task::homing);
  homing_.emplace(method, settings, axis, encoder_counts);
}

bool Motion::position_loop() const {
  return task_ == Task::position || task_ == Task::hold || task_ == Task::velocity || task_ == Task::homing ||
         task_ == Task::stop;
}

bool Motion::at_rest(const Axis& axis) const {
  if (axis.speed() != 0 || axis.actual_speed() != 0) return false;
  switch (task_) {
    case Task::coast:
    case Task::hold:
      return true;
    case Task::position:
      return axis.demand() == target_ && !buffered_;
    case Task::velocity:
    case Task::immediate_velocity:
      return target_speed_ == 0;
    case Task::torque:
    case Task::stop:
    case Task::homing:
      return false;
  }
  return false;
}

Dec Motion::wanted_speed(const Axis& axis, const DigitalInputs& inputs, const MotionSettings& settings) {
  const Dec now = axis.speed();
  const Dec highest = std::max<Dec>(settings.maximum_speed, 0);
  switch (task_) {
    case Task::coast:
      return ramp(now, 0, settings.coasting, settings.coasting);
    case Task::hold:  // a mode without a set-point of its own: whatever still moves is brought to rest
      return ramp(now, 0, settings.deceleration, settings.deceleration);
    case Task::stop:
      return ramp(now, 0, stop_deceleration_, stop_deceleration_);
    case Task::position: {
      if (buffered_ && axis.demand() == target_) {
        target_ = *buffered_;
        buffered_.reset();
      }
      FinePosition target = target_;
      if (settings.software_maximum) target = std::min(target, *settings.software_maximum);
      if (settings.software_minimum) target = std::max(target, *settings.software_minimum);
      limited_ = limited_ || target != target_;
      return approach(now, target - axis.demand(), std::min(settings.profile_velocity, highest), settings.acceleration,
                      settings.deceleration);
    }
    case Task::velocity:
      return ramp(now, std::clamp(target_speed_, -highest, highest), settings.acceleration, settings.deceleration);
    case Task::immediate_velocity:
      return ramp(now, std::clamp(target_speed_, -highest, highest), settings.full_acceleration,
                  settings.full_acceleration);
    case Task::torque:  // only 6080 and the load bound the speed (JD 6.4)
      if (settings.torque_acceleration == 0) return ramp(now, 0, settings.coasting, settings.coasting);
      return std::clamp(now + settings.torque_acceleration, -highest, highest);
    case Task::homing:
      return homing_->next_speed(axis, inputs);
  }
  return 0;
}

Dec Motion::within_limits(Dec speed, const Axis& axis, const DigitalInputs& inputs, const MotionSettings& settings) {
  if (task_ == Task::homing || task_ == Task::coast) return speed;
  if ((speed > 0 && inputs.at_positive_limit()) || (speed < 0 && inputs.at_negative_limit())) {
    limited_ = true;
    const Dec slowed = ramp(axis.speed(), 0, settings.limit_deceleration, settings.limit_deceleration);
    return (slowed > 0) == (speed > 0) ? slowed : 0;
  }
  if (task_ != Task::velocity && task_ != Task::immediate_velocity && task_ != Task::torque) return speed;
  const auto& end = speed > 0 ? settings.software_maximum : settings.software_minimum;
  if (!end || speed == 0) return speed;
  const FinePosition remaining = *end - axis.demand();
  const Dec allowed =
      (remaining > 0) == (speed > 0)
          ? approach(axis.speed(), remaining, std::abs(speed), settings.full_acceleration, settings.deceleration)
          : ramp(axis.speed(), 0, settings.deceleration, settings.deceleration);
  if (std::abs(allowed) >= std::abs(speed)) return speed;
  limited_ = true;
  return allowed;
}

Dec Motion::next_speed(const Axis& axis, const DigitalInputs& inputs, const MotionSettings& settings) {
  limited_ = false;
  return within_limits(wanted_speed(axis, inputs, settings), axis, inputs, settings);
}

}  // namespace axisgate::simulated
