// SPDX-License-Identifier: Apache-2.0
// What a command that moves an axis by hand says: what it does now, and why it was refused.
#include <fmt/format.h>

#include "gateway/commands/manual/plan/manual_plan.hpp"
#include "gateway/core/words.hpp"

namespace axisgate::commands {

std::string ManualPlan::why_refused() const {
  const auto result = static_cast<std::uint32_t>(view_->result);
  std::string out = fmt::format(
      "{}: {} was {}", axis_text(), refused_what_,
      exception_ == ModbusException::none ? "not carried out" : "refused with " + exception_text(exception_));
  if (exception_ == ModbusException::illegal_function)
    return out + ": the gateway gives this computer another role than operator (key \"allow\")";
  if (exception_ == ModbusException::illegal_data_address)
    return out + ": this drive does not have it (axisgate map shows what it has)";
  if (exception_ == ModbusException::illegal_data_value) return out + limit_text();
  if (view_->result == CommandResult::none) return out;
  const Word* word = find_word(WordKind::result, result);
  out += fmt::format(", result {}", result);
  const std::string alarm =
      refused_what_ == text(Command::enable) ? against_enable(view_->alarms, arguments_.axis) : std::string();
  if (word != nullptr) out += fmt::format(" {}: {}", word->name, alarm.empty() ? word->meaning : alarm);
  return out;
}

/// A refused row's limit is in command_detail, in the units of the row.
std::string ManualPlan::limit_text() const {
  constexpr double kPerRpm = 1000;
  const bool target = refused_what_ == "target_position";
  const bool speed = refused_what_ == "profile_velocity" || refused_what_ == "jog_velocity";
  if (target)
    return fmt::format(": {} turns is beyond the limit of {} turns", arguments_.turns.to_double(),
                       static_cast<std::int32_t>(view_->detail) / view_->units_per_rev.to_double());
  if (refused_what_.starts_with("move_") && view_->detail != 0)
    return fmt::format(": it would end beyond the limit of {} turns",
                       static_cast<std::int32_t>(view_->detail) / view_->units_per_rev.to_double());
  if (speed && view_->detail != 0)
    return fmt::format(": {} rpm is beyond the limit of {} rpm", rpm_.to_double(), view_->detail / kPerRpm);
  return ": beyond the limits of the axis, its profile or its drive";
}

std::string ManualPlan::axis_text() const { return fmt::format("axis {}", arguments_.axis); }

std::string ManualPlan::doing() const {
  if (step_ == Step::stop || (step_ == Step::standing && !reached_)) return "quick stop";
  if (step_ == Step::disable) return "disabling";
  if (step_ < Step::working) return "";
  if (step_ != Step::working) return "";
  switch (arguments_.task) {
    case ManualTask::enable:
      return "held; Ctrl-C disables it";
    case ManualTask::move:
      return fmt::format("{} {} turns; Ctrl-C stops", arguments_.relative ? "by" : "to", arguments_.turns.to_double());
    case ManualTask::jog:
      break;
    case ManualTask::stop:
      return "";
  }
  return button_.held() == JogButton::Which::none      ? "hold an arrow key; q ends"
         : button_.held() == JogButton::Which::forward ? "jogs forward"
                                                       : "jogs in reverse";
}

}  // namespace axisgate::commands
