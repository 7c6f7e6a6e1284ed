// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/metrics/axis_metrics.hpp"

#include <string>
#include <utility>

#include "gateway/core/error.hpp"
#include "gateway/core/words.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::web {
namespace {

constexpr std::uint32_t kLinkStates = static_cast<std::uint32_t>(LinkState::link_down) + 1;
constexpr std::uint32_t kAxisStates = static_cast<std::uint32_t>(AxisState::unknown) + 1;
constexpr double kSecondsPerMinute = 60, kPerRatio = 100, kMicro = 1e6, kMsPerSecond = 1000;

/// One series for each state; that which it has is 1.
void add_states(Families& to, Metric metric, const Families::Labels& axis, WordKind kind, std::uint32_t count,
                std::uint32_t now) {
  for (std::uint32_t state = 0; state < count; ++state)
    to.add(metric, {axis[0], {"state", word_label(kind, state)}}, state == now ? 1 : 0);
}

/// In the unit that people read; a position in turns.
double in_unit(Quantity quantity, const AxisPicture& axis) {
  const auto value = static_cast<long double>(axis.of(quantity).value);
  const Kind kind = axisgate::row(quantity).kind;
  const long double units = kind == Kind::position ? static_cast<long double>(axis.info.units_numerator) /
                                                         static_cast<long double>(axis.info.units_denominator)
                                                   : static_cast<long double>(shown_unit(kind).registers);
  return static_cast<double>(value / units);
}

void add_values(Families& to, const Families::Labels& axis, const AxisPicture& of) {
  const auto add = [&](Quantity quantity, Metric metric, double per, const Families::Labels& labels) {
    const bool good = (of.sample.valid & bit(quantity)) != 0 && of.of(quantity).known;
    if (good) to.add(metric, labels, in_unit(quantity, of) / per);
  };
  add(Quantity::position_actual, Metric::axis_position, 1, axis);
  add(Quantity::velocity_actual, Metric::axis_velocity, kSecondsPerMinute, axis);
  add(Quantity::torque_actual, Metric::axis_torque, kPerRatio, axis);
  add(Quantity::current_actual, Metric::axis_current, 1, axis);
  add(Quantity::drive_temperature, Metric::axis_temperature, 1, {axis[0], {"sensor", "drive"}});
  add(Quantity::motor_temperature, Metric::axis_temperature, 1, {axis[0], {"sensor", "motor"}});
}

void add_commands(Families& to, const Families::Labels& axis, const AxisPicture& of) {
  const auto add = [&](std::uint32_t command, std::uint32_t result, double count) {
    to.add(Metric::axis_commands,
           {axis[0],
            {"command", std::string(text(static_cast<Command>(command)))},
            {"result", word_label(WordKind::result, result)}},
           count);
  };
  std::uint32_t missing = of.info.supported_commands;
  constexpr auto kDone = static_cast<std::uint8_t>(CommandResult::done);
  constexpr std::uint32_t kBits = 32;
  for (const CommandCount& each : of.counts->commands) {
    add(each.command, each.result, each.count);
    if (each.result == kDone && each.command < kBits) missing &= ~(1U << each.command);
  }
  // From 0 on: a rise from nothing is none to Prometheus.
  for (std::uint32_t command = 1; command <= kLastCommand; ++command)
    if ((missing >> command & 1U) != 0) add(command, kDone, 0);
}

void add_counts(Families& to, const Families::Labels& axis, const AxisPicture& of) {
  to.add(Metric::axis_faults, axis, of.counts->faults);
  to.add(Metric::axis_lease_expiries, axis, of.counts->lease_expiries);
  to.add(Metric::axis_enabled, axis, static_cast<double>(of.counts->enabled_ms) / kMsPerSecond);
  to.add(Metric::axis_travel, axis, static_cast<double>(of.counts->travel_microturns) / kMicro);
  add_commands(to, axis, of);
}

}  // namespace

void add_axis(Families& to, const Picture& picture, std::uint16_t number, const AxisPicture& of, SteadyNs now) {
  const Families::Labels axis{{"axis", std::to_string(number)}};
  const auto bus = picture.buses().find(of.info.bus);
  to.add(Metric::axis_info,
         {axis[0],
          {"name", of.info.name},
          {"bus", bus == picture.buses().end() ? std::string() : bus->second.info.name},
          {"drive", of.info.drive},
          {"profile", of.info.profile},
          {"node", std::to_string(of.info.node)}},
         1);
  if (of.counts) add_counts(to, axis, of);
  if (of.sampled == 0) return;
  add_states(to, Metric::axis_link_state, axis, WordKind::link_state, kLinkStates, of.sample.link_state);
  // A stop that is latched is a state of its own once the axis stands, as everywhere.
  const bool latched =
      of.sample.axis_state == static_cast<std::uint8_t>(AxisState::stopping) && of.latched_and_stands();
  add_states(to, Metric::axis_state, axis, WordKind::axis_state, kAxisStates,
             latched ? kAxisStates : of.sample.axis_state);
  to.add(Metric::axis_state, {axis[0], {"state", "latched"}}, latched ? 1 : 0);
  for (std::uint32_t alarm = 0; alarm < kAxisAlarmCount; ++alarm)
    to.add(Metric::axis_alarm, {axis[0], {"alarm", word_label(WordKind::axis_alarm, alarm)}},
           of.sample.alarms >> alarm & 1U);
  if (of.sample.age_ms != UINT32_MAX)
    to.add(Metric::axis_age, axis,
           of.sample.age_ms / kMsPerSecond + static_cast<double>(now - of.sampled) / static_cast<double>(kSecond));
  add_values(to, axis, of);
}

}  // namespace axisgate::web
