// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/homing_run.hpp"

#include <cstdlib>

#include "tests/simulated/trapezoid.hpp"

namespace axisgate::simulated {

HomingRun::HomingRun(int method, const HomingSettings& settings, const Axis& axis, std::int64_t encoder_counts)
    : method_(homing_method(method)),
      settings_(settings),
      started_at_(axis.actual()),
      longest_(longest_search * encoder_counts * fine_per_count) {
  // A reserved method, or a speed of 0 with which nothing would ever be found, is a homing error (statusword bit 13).
  if (!method_ || (!method_->at_once && (settings.search_speed <= 0 || settings.index_speed <= 0))) {
    outcome_ = Outcome::failed;
  } else {
    search_direction_ = method_->search;
  }
}

bool HomingRun::signal_active(const Axis& axis, const DigitalInputs& inputs) const {
  switch (method_->signal) {
    case HomingSignal::negative_limit:
      return inputs.at_negative_limit();
    case HomingSignal::positive_limit:
      return inputs.at_positive_limit();
    case HomingSignal::home_switch:
      return inputs.active(InputFunction::home_switch);
    case HomingSignal::end_stop:
      return axis.stalled();
    case HomingSignal::none:
      break;
  }
  return false;
}

bool HomingRun::blocked(const DigitalInputs& inputs, int direction) const {
  return direction > 0 ? inputs.at_positive_limit() : inputs.at_negative_limit();
}

HomingRun::Stage HomingRun::first_stage(bool active) const {
  if (method_->at_once || method_->signal == HomingSignal::none) return Stage::index;
  if (!active) return Stage::search;
  return method_->entering && method_->signal != HomingSignal::end_stop ? Stage::leave : Stage::last_run;
}

void HomingRun::latch(FinePosition reference) {
  reference_ = reference + (settings_.run_to_offset ? settings_.offset : 0);
  stage_ = Stage::return_to_reference;
}

void HomingRun::edge_passed(const Axis& axis) {
  if (method_->index) {
    stage_ = Stage::index;
  } else {
    latch(axis.actual());
  }
}

void HomingRun::advance_stage(const Axis& axis, const DigitalInputs& inputs) {
  const bool active = signal_active(axis, inputs);
  switch (stage_) {
    case Stage::search:
      if (active) {
        stage_ = first_stage(true);
      } else if (method_->signal == HomingSignal::home_switch && blocked(inputs, search_direction_)) {
        // The switch is not on this side. Methods 7 to 14 turn round once; without a switch in between, it failed.
        if (!method_->turns_round || turned_) outcome_ = Outcome::failed;
        turned_ = true;
        search_direction_ = -search_direction_;
      }
      break;
    case Stage::leave:
      if (!active) stage_ = Stage::last_run;
      break;
    case Stage::last_run:
      if (active == method_->entering) edge_passed(axis);
      break;
    case Stage::index:
      if (method_->at_once) {
        latch(axis.actual());
      } else if (axis.index_passed()) {
        latch(*axis.index_passed());
      } else if (method_->signal == HomingSignal::none && blocked(inputs, method_->last)) {
        outcome_ = Outcome::failed;
      }
      break;
    case Stage::return_to_reference:
      if (axis.speed() == 0 && axis.demand() == reference_) outcome_ = Outcome::reference_found;
      break;
  }
  if (stage_ != Stage::return_to_reference && std::abs(axis.demand() - started_at_) > longest_) {
    outcome_ = Outcome::failed;
  }
}

Dec HomingRun::run(const Axis& axis, int direction, Dec speed) const {
  return ramp(axis.speed(), direction * speed, settings_.acceleration, settings_.acceleration);
}

Dec HomingRun::next_speed(const Axis& axis, const DigitalInputs& inputs) {
  if (outcome_ != Outcome::running) return ramp(axis.speed(), 0, settings_.acceleration, settings_.acceleration);
  if (begun_) {
    advance_stage(axis, inputs);
  } else {
    stage_ = first_stage(signal_active(axis, inputs));
    begun_ = true;
  }
  switch (stage_) {
    case Stage::search:
      return run(axis, search_direction_, settings_.search_speed);
    case Stage::leave:
      return run(axis, -method_->last, settings_.index_speed);
    case Stage::last_run:
      return run(axis, method_->last, settings_.index_speed);
    case Stage::index:
      return run(axis, method_->last, settings_.index_speed);
    case Stage::return_to_reference:
      return approach(axis.speed(), reference_ - axis.demand(), settings_.index_speed, settings_.acceleration,
                      settings_.acceleration);
  }
  return 0;
}

}  // namespace axisgate::simulated
