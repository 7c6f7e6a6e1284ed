// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check_sections.hpp"

namespace axisgate::check {
namespace {

std::string what_counts(const model::AxisModel& axis) {
  constexpr double kOfRegister = 0.001;  // rpm
  if (axis.binding(Quantity::position_actual) != nullptr)
    return fmt::format("{:g} turns of the motor", axis.watch.travel.to_double());
  return fmt::format("{:g} rpm", model::kTimesStandstill * kOfRegister * static_cast<double>(axis.standstill_velocity));
}

std::string reaction_text(model::WatchReaction reaction) {
  switch (reaction) {
    case model::WatchReaction::off:
      return "against a stop or a disable alone: alarm, and that stop once more";
    case model::WatchReaction::alarm:
      return "alarm; against a stop or a disable that stop once more";
    case model::WatchReaction::stop:
      break;
  }
  return "alarm and quick stop; against a stop or a disable that stop once more";
}

}  // namespace

ReportLines watch_lines(const model::AxisModel& axis) {
  const bool moves = axis.binding(Quantity::position_actual) != nullptr;
  const bool turns = axis.binding(Quantity::velocity_actual) != nullptr;
  if (axis.position_commanded)
    return {{"watch", "NONE: its position is only what the drive has commanded, and tells of no motion by itself"}};
  if (!moves && !turns) return {{"watch", "NONE: the drive tells neither position nor velocity"}};
  ReportLines out{{"watch", fmt::format("unexpected above {}, {:.0f} ms after a motion: {}", what_counts(axis),
                                        in_ms(axis.watch.settle), reaction_text(axis.watch.reaction))}};
  if (moves && turns && !axis.watch.units) out.emplace_back("", "velocity is not held against position (units off)");
  return out;
}

}  // namespace axisgate::check
