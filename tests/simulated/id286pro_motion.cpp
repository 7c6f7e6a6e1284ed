// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/id286pro_motion.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "tests/simulated/trapezoid.hpp"

namespace axisgate::simulated {

void Id286proMotion::move(Task absolute_or_relative, FinePosition target, const Id286proProfile& profile) {
  task_ = absolute_or_relative;
  target_ = target;
  profile_ = profile;
}

void Id286proMotion::run(Dec speed, const Id286proProfile& profile) {
  task_ = Task::speed;
  target_speed_ = speed;
  profile_ = profile;
}

void Id286proMotion::stop(const Id286proProfile& profile) {
  if (task_ == Task::none) return;
  task_ = Task::stop;
  profile_ = profile;
}

void Id286proMotion::home(Id286proHoming mode, Dec creep, const Id286proProfile& profile) {
  task_ = Task::homing;
  stage_ = Stage::search;
  homing_ = mode;
  creep_ = creep;
  profile_ = profile;
}

bool Id286proMotion::take_reference() { return std::exchange(reference_, false); }

int Id286proMotion::homing_direction() const {
  return homing_ == Id286proHoming::clockwise_to_origin || homing_ == Id286proHoming::to_positive_limit ? 1 : -1;
}

Dec Id286proMotion::towards(Dec speed, Dec target) const {
  if (target == 0 && std::abs(speed) <= profile_.stop) return 0;
  if (speed == 0) {
    const Dec first = std::min(std::abs(target), std::max(profile_.start, profile_.acceleration));
    return target < 0 ? -first : first;
  }
  return ramp(speed, target, profile_.acceleration, profile_.deceleration);
}

Dec Id286proMotion::over(Dec speed, FinePosition remaining, Dec highest) const {
  const Dec acceleration = speed == 0 ? std::max(profile_.start, profile_.acceleration) : profile_.acceleration;
  return approach(speed, remaining, highest, acceleration, profile_.deceleration);
}

Dec Id286proMotion::task_speed(const Axis& axis, FinePosition lowest, FinePosition highest) {
  const Dec now = axis.speed();
  const FinePosition here = axis.demand();
  switch (task_) {
    case Task::none:
    case Task::homing:
      break;
    case Task::absolute:
    case Task::relative: {
      const FinePosition target = std::max(std::min(target_, highest), lowest);
      if (now == 0 && here == target) break;
      return over(now, target - here, profile_.speed);
    }
    case Task::speed: {
      if (now == 0 && target_speed_ == 0) break;
      const int direction = target_speed_ > 0 ? 1 : -1;
      const FinePosition room = direction > 0 ? highest - here : here - lowest;
      if (now == 0 && room <= 0) break;
      const Dec wanted = towards(now, target_speed_);
      if (target_speed_ == 0 || direction * wanted <= 0) return wanted;  // it slows down, or turns round first
      const Dec allowed = room > 0 ? over(now, direction * room, std::abs(target_speed_)) : 0;
      return std::abs(allowed) < std::abs(wanted) ? allowed : wanted;
    }
    case Task::stop:
      if (now == 0) break;
      return towards(now, 0);
  }
  task_ = Task::none;
  return 0;
}

Dec Id286proMotion::homing_speed(const Axis& axis, const Id286proSignals& signals) {
  const int direction = homing_direction();
  const bool to_origin = homing_ == Id286proHoming::clockwise_to_origin || homing_ == Id286proHoming::counter_to_origin;
  const bool at_limit = direction > 0 ? signals.positive_limit : signals.negative_limit;
  const bool found = to_origin ? signals.origin : at_limit;
  switch (stage_) {
    case Stage::search:
      if (!found) return at_limit ? 0 : towards(axis.speed(), direction * profile_.speed);
      edge_ = axis.demand();
      stage_ = Stage::slow_down;
      [[fallthrough]];
    case Stage::slow_down:
      if (axis.speed() != 0) return towards(axis.speed(), 0);
      stage_ = Stage::return_to_edge;
      [[fallthrough]];
    case Stage::return_to_edge:
      if (axis.speed() != 0 || axis.demand() != edge_) return over(axis.speed(), edge_ - axis.demand(), creep_);
      reference_ = true;
      task_ = Task::none;
      return 0;
  }
  return 0;
}

Dec Id286proMotion::next_speed(const Axis& axis, const Id286proSignals& signals, FinePosition lowest,
                               FinePosition highest) {
  if (task_ == Task::homing) {
    const Dec speed = homing_speed(axis, signals);
    // A limit on the way to the origin ends the homing; nothing says that it turns round.
    if (speed == 0 && stage_ == Stage::search) task_ = Task::none;
    return speed;
  }
  const Dec speed = task_speed(axis, lowest, highest);
  if ((speed > 0 && signals.positive_limit) || (speed < 0 && signals.negative_limit)) {
    task_ = Task::none;
    return 0;
  }
  return speed;
}

}  // namespace axisgate::simulated
