// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gateway/profile/resolve/profile_resolve.hpp"

namespace axisgate::check {
namespace {

std::vector<std::string_view> keys_of(const profile::AxisLimits& limits) {
  std::vector<std::string_view> keys;
  const auto add = [&keys](const auto& limit, Quantity quantity) {
    if (limit) keys.push_back(profile::limit_key(quantity));
  };
  add(limits.position, Quantity::target_position);
  add(limits.velocity, Quantity::target_velocity);
  add(limits.acceleration, Quantity::profile_acceleration);
  add(limits.torque, Quantity::target_torque);
  add(limits.quick_stop_deceleration_min, Quantity::quick_stop_deceleration);
  return keys;
}

/// What this key is for, where nobody can write any of it on this drive; else nothing.
std::vector<std::string_view> bounded_in_vain(std::string_view key, const model::AxisModel& axis) {
  std::vector<std::string_view> names;
  for (const QuantityRow& each : quantity_table()) {
    if (profile::limit_key(each.quantity) != key) continue;
    if (axis.takes(each.quantity)) return {};
    names.push_back(each.name);
  }
  return names;
}

constexpr double kPerRpm = 1000, kPerPercent = 10, kPerRpmEachSecond = 10;

bool turns_to_positions(const model::AxisModel& axis) { return axis.takes(Quantity::target_position); }
bool has_velocity(const model::AxisModel& axis) {
  return axis.takes(Quantity::target_velocity) || axis.takes(Quantity::profile_velocity);
}

/// 3000 for 3000 rpm is 3 rpm: nobody means so little.
void warn_about_units(const config::AxisConfig& config, const model::AxisModel& axis, const std::string& file,
                      std::vector<std::string>& out) {
  constexpr double kLeast = 10, kLeastPart = 0.01;
  if (!config.limits.velocity) return;
  const double rpm = static_cast<double>(*config.limits.velocity) / kPerRpm;
  const double rated = axis.rated_speed ? static_cast<double>(*axis.rated_speed) / kPerRpm : 0;
  if (rpm >= kLeast && rpm >= kLeastPart * rated) return;
  const std::string part =
      rated > 0 ? fmt::format(", {:.2g} % of the rated speed of {:g} rpm", 100 * rpm / rated, rated) : std::string();
  out.push_back(fmt::format("{}: {}/limits/velocity: {} is {:g} rpm{}: its unit is 0.001 rpm, {} would be {:g} rpm",
                            file, config.pointer, *config.limits.velocity, rpm, part, *config.limits.velocity * 1000,
                            rpm * kPerRpm));
}

void warn_about(const config::AxisConfig& config, const model::AxisModel& axis, const model::DriveModel& drive,
                const std::string& file, std::vector<std::string>& out) {
  const auto warn = [&](std::string_view key, const std::string& what) {
    out.push_back(fmt::format("{}: {}/limits/{}: {}", file, config.pointer, key, what));
  };
  for (const std::string_view key : keys_of(config.limits))
    if (const auto names = bounded_in_vain(key, axis); !names.empty())
      warn(key, fmt::format("limits nothing, for {} has no {} that can be written on {}: take it out", drive.title,
                            fmt::join(names, ", "), drive.protocol));
  const bool homes_at_its_own = axis.supports(Command::home) && !axis.takes(Quantity::homing_speed_switch) &&
                                !axis.takes(Quantity::homing_speed_zero);
  const bool moves_at_its_own = axis.supports(Command::move_absolute) && axis.takes(Quantity::target_velocity) &&
                                !axis.takes(Quantity::profile_velocity);
  const auto warn_of_own_speed = [&](bool at_its_own, std::string_view motion, std::string_view speed) {
    if (config.limits.velocity && at_its_own)
      warn(profile::limit_key(Quantity::target_velocity),
           fmt::format(
               "does not reach {}: of {} no {} is known that could be written; set a safe one in the drive itself",
               motion, drive.title, speed));
  };
  warn_of_own_speed(homes_at_its_own, "homing", "homing speed");
  warn_of_own_speed(moves_at_its_own, "moves", "profile_velocity");
}

}  // namespace

ReportLines limit_lines(const config::AxisConfig& config, const model::AxisModel& axis) {
  const profile::AxisLimits& limits = config.limits;
  const double units = config.units_per_rev.to_double();
  std::vector<std::string> parts;
  if (limits.velocity)
    parts.push_back(fmt::format("velocity {:g} rpm", static_cast<double>(*limits.velocity) / kPerRpm));
  else if (has_velocity(axis))
    parts.emplace_back("velocity NONE");
  if (limits.position)
    parts.push_back(fmt::format("position {} to {} ({:.2f} to {:.2f} turns)", limits.position->min,
                                limits.position->max, static_cast<double>(limits.position->min) / units,
                                static_cast<double>(limits.position->max) / units));
  else if (turns_to_positions(axis))
    parts.emplace_back("position NONE");
  if (limits.acceleration)
    parts.push_back(
        fmt::format("acceleration {:g} rpm/s", static_cast<double>(*limits.acceleration) / kPerRpmEachSecond));
  if (limits.torque) parts.push_back(fmt::format("torque {:g} %", static_cast<double>(*limits.torque) / kPerPercent));
  if (limits.quick_stop_deceleration_min)
    parts.push_back(fmt::format("a quick stop not below {:g} rpm/s",
                                static_cast<double>(*limits.quick_stop_deceleration_min) / kPerRpmEachSecond));
  if (parts.empty()) return {};
  return {{"limits", fmt::format("{}", fmt::join(parts, "; "))}};
}

std::vector<std::string> limit_warnings(const config::LoadedConfig& loaded) {
  std::vector<std::string> out;
  std::vector<AxisNumber> any_speed, any_position;
  for (std::size_t b = 0; b < loaded.models.size(); ++b)
    for (std::size_t d = 0; d < loaded.models[b].size(); ++d) {
      const model::DriveModel& drive = loaded.models[b][d];
      for (std::size_t a = 0; a < drive.axes.size(); ++a) {
        const config::AxisConfig& config = loaded.config.buses[b].drives[d].axes[a];
        warn_about(config, drive.axes[a], drive, loaded.config.file, out);
        warn_about_units(config, drive.axes[a], loaded.config.file, out);
        if (!config.limits.velocity && has_velocity(drive.axes[a])) any_speed.push_back(config.number);
        if (!config.limits.position && turns_to_positions(drive.axes[a])) any_position.push_back(config.number);
      }
    }
  if (!any_speed.empty())
    out.push_back(
        fmt::format("no limit of velocity: axis {}: a slip of the keyboard is sent as it is; write "
                    "\"limits\": {{\"velocity\": N}}, in 0.001 rpm",
                    fmt::join(any_speed, ", ")));
  if (!any_position.empty())
    out.push_back(
        fmt::format("no limit of position: axis {}: a move may end anywhere; where its way has an end, write "
                    "\"limits\": {{\"position\": [MIN, MAX]}}",
                    fmt::join(any_position, ", ")));
  return out;
}

}  // namespace axisgate::check
