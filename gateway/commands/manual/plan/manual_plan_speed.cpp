// SPDX-License-Identifier: Apache-2.0
// The speed at which a command by hand moves an axis: asked for, told before anything moves, and set back.
#include <fmt/format.h>

#include "gateway/commands/manual/plan/manual_plan.hpp"

namespace axisgate::commands {

ManualWrite ManualPlan::speed_write(const Rational& rpm) const {
  const bool jog = arguments_.task == ManualTask::jog;
  return {.what = jog ? ManualWrite::What::jog_velocity : ManualWrite::What::profile_velocity, .number = rpm};
}

/// A drive without one moves at its own speed.
bool ManualPlan::has_speed() const {
  if (arguments_.task == ManualTask::jog) return view_->can.supports(Command::run_velocity);
  return arguments_.task == ManualTask::move && view_->can.supports(Quantity::profile_velocity);
}

std::optional<Rational> ManualPlan::speed_shown() const {
  if (!has_speed()) return std::nullopt;
  return arguments_.task == ManualTask::jog ? view_->jog_rpm : view_->profile_rpm;
}

std::string ManualPlan::too_fast() const {
  const double most = view_->rated_rpm ? view_->rated_rpm->to_double() : static_cast<double>(kMostRpm);
  if (!arguments_.rpm || arguments_.rpm->to_double() <= most) return {};
  return fmt::format(
      "{} rpm is above {}: nothing was sent", arguments_.rpm->to_double(),
      view_->rated_rpm ? fmt::format("the rated speed of the motor of {}, {} rpm", axis_text(), most)
                       : fmt::format("what {} is moved at by hand, {} rpm (the rated speed of its motor is not known)",
                                     axis_text(), most));
}

void ManualPlan::write_speed(Instant now) {
  write(speed_write(rpm_));
  claim(now);
  go(Step::speed);
}

/// The usual speed was refused: by a limit below it, which the gateway names, or because the drive has none to write.
bool ManualPlan::lowers_speed() {
  constexpr std::int64_t kPerRpm = 1000;
  const bool usual = !arguments_.rpm && !speed_set_ && !speed_is_limit_ && !may_move_;
  const Rational limit(view_->detail, kPerRpm);
  if (!usual || refused_what_ != (arguments_.task == ManualTask::jog ? "jog_velocity" : "profile_velocity") ||
      exception_ != ModbusException::illegal_data_value || limit.numerator() <= 0 ||
      limit.to_double() >= rpm_.to_double())
    return false;
  rpm_ = limit;
  speed_is_limit_ = true;
  exception_ = ModbusException::none;
  return true;
}

void ManualPlan::note_dangers() {
  const bool moves = arguments_.task == ManualTask::move || arguments_.task == ManualTask::jog;
  const auto speed = speed_shown();
  if (moves && speed)
    notes_.push_back(fmt::format("{} turns at {} rpm{}", axis_text(), speed->to_double(),
                                 speed_is_limit_  ? ", its limit"
                                 : arguments_.rpm ? ""
                                                  : "; --velocity sets another speed"));
  else if (moves)
    notes_.push_back(fmt::format("{} turns at the drive's own speed, which no register shows", axis_text()));
  const std::uint16_t within = view_->loss_stop_ms;
  notes_.push_back(within == kGoesOn ? "if the gateway dies it GOES ON: keep its wired stop in reach"
                   : within == kLossNotKnown
                       ? "whether it stops if the gateway dies is NOT KNOWN: keep its wired stop in reach"
                       : fmt::format("if the gateway dies the drive begins to stop by itself within {} ms", within));
}

}  // namespace axisgate::commands
