// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

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

constexpr double kPerRpm = 1000, kPerPercent = 10, kPerRpmEachSecond = 10, kSecondsPerMinute = 60;

bool turns_to_positions(const model::AxisModel& axis) { return axis.takes(Quantity::target_position); }
bool has_velocity(const model::AxisModel& axis) {
  return axis.takes(Quantity::target_velocity) || axis.takes(Quantity::profile_velocity);
}

/// Numbers that look like another unit, and what they would be in it. Where one could be meant, nothing is said.
class UnitSuspicions {
 public:
  UnitSuspicions(const config::AxisConfig& config, const model::AxisModel& axis) : config_(config), axis_(axis) {}

  /// (key, what is odd)
  [[nodiscard]] std::vector<std::pair<std::string_view, std::string>> all() const {
    std::vector<std::pair<std::string_view, std::string>> out;
    const auto add = [&](std::string_view key, const std::string& what) {
      if (!what.empty()) out.emplace_back(key, what);
    };
    const profile::AxisLimits& limits = config_.limits;
    if (limits.velocity) add("velocity", velocity(*limits.velocity));
    if (limits.position) add("position", position(*limits.position));
    if (limits.velocity && limits.acceleration) add("acceleration", acceleration(*limits.acceleration));
    if (limits.torque) add("torque", torque(*limits.torque));
    return out;
  }

 private:
  /// 3000 for 3000 rpm is 3 rpm.
  [[nodiscard]] std::string velocity(std::int64_t limit) const {
    constexpr double kLeast = 10, kMost = 100'000, kLeastPart = 0.01, kMostTimes = 10;
    const double rpm = static_cast<double>(limit) / kPerRpm;
    const double rated = axis_.rated_speed ? static_cast<double>(*axis_.rated_speed) / kPerRpm : 0;
    if (rpm > kMost || (rated > 0 && rpm > kMostTimes * rated))
      return fmt::format("{} is {} rpm, {}: its unit is 0.001 rpm of the motor; so it limits nothing", limit, rpm,
                         rated > 0 ? fmt::format("{:.2g} times the rated speed of {:g} rpm", rpm / rated, rated)
                                   : "faster than motors turn");
    if (rpm >= kLeast && rpm >= kLeastPart * rated) return "";
    const std::string part =
        rated > 0 ? fmt::format(", {:.2g} % of the rated speed of {:g} rpm", 100 * rpm / rated, rated) : std::string();
    return fmt::format("{} is {:g} rpm{}: its unit is 0.001 rpm, {} would be {:g} rpm", limit, rpm, part, limit * 1000,
                       rpm * kPerRpm);
  }
  /// [0, 10] for ten turns.
  [[nodiscard]] std::string position(const Range& limit) const {
    constexpr double kLeastTurns = 0.05;
    const double units = config_.units_per_rev.to_double();
    const double turns = static_cast<double>(limit.max - limit.min) / units;
    if (turns >= kLeastTurns) return "";
    return fmt::format("{} to {} is {:.2g} of a turn of the motor: its unit is 1/{:g} turn (units_per_rev)", limit.min,
                       limit.max, turns, units);
  }
  /// Where the limit of velocity is reached after minutes alone.
  [[nodiscard]] std::string acceleration(std::int64_t limit) const {
    constexpr double kLongest = 60;  // s
    const double each_second = static_cast<double>(limit) / kPerRpmEachSecond;
    const double seconds = static_cast<double>(*config_.limits.velocity) / kPerRpm / each_second;
    if (seconds <= kLongest) return "";
    return fmt::format("{} is {:g} rpm/s: the limit of velocity is reached after {:.0f} s; its unit is 0.1 rpm/s",
                       limit, each_second, seconds);
  }
  /// 1 for 100 %.
  [[nodiscard]] static std::string torque(std::int64_t limit) {
    constexpr double kLeast = 1;
    const double percent = static_cast<double>(limit) / kPerPercent;
    if (percent >= kLeast) return "";
    return fmt::format("{} is {:g} % of the rated torque: its unit is 0.1 %, 1000 is the rated torque", limit, percent);
  }

  const config::AxisConfig& config_;
  const model::AxisModel& axis_;
};

void warn_about(const config::AxisConfig& config, const model::AxisModel& axis, const model::DriveModel& drive,
                std::vector<config::ConfigFault>& out) {
  const auto warn = [&](std::string_view key, const std::string& what) {
    out.push_back({"", fmt::format("{}/limits/{}", config.pointer, key), what});
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
  for (const auto& [key, what] : UnitSuspicions(config, axis).all()) warn(key, what);
}

/// Without current and torque nobody sees how hard the motor works; other constants cost less, and are named beside
/// what the axis has not.
void warn_about_constants(const config::DriveConfig& config, const model::DriveModel& drive,
                          std::vector<config::ConfigFault>& out) {
  constexpr std::array kEffort{Quantity::current_actual, Quantity::torque_actual};
  for (const model::AxisModel& axis : drive.axes)
    if (std::ranges::any_of(kEffort, [&](Quantity quantity) { return axis.supports(quantity); })) return;
  for (const Quantity effort : kEffort) {
    const std::size_t before = out.size();
    for (const profile::WantedConstant& wanted : config.wanted)
      if (std::ranges::find(wanted.quantities, effort) != wanted.quantities.end())
        out.push_back(
            {"", config.pointer + "/constants",
             fmt::format("\"{}\" is not given, and so nothing tells how hard the motor works, neither current "
                         "nor torque: {}",
                         wanted.name, wanted.text)});
    if (out.size() > before) return;  // what torque needs besides is no more than named
  }
}

}  // namespace

ReportLines limit_lines(const config::AxisConfig& config, const model::AxisModel& axis) {
  const profile::AxisLimits& limits = config.limits;
  const double units = config.units_per_rev.to_double();
  std::vector<std::string> parts;
  if (limits.velocity) {
    const double rpm = static_cast<double>(*limits.velocity) / kPerRpm;
    parts.push_back(fmt::format("velocity {:g} rpm", rpm));
    if (config.metres_per_rev)
      parts.back() += fmt::format(" ({:g} m/s)", rpm / kSecondsPerMinute * config.metres_per_rev->to_double());
  }
  if (!limits.velocity && has_velocity(axis)) parts.emplace_back("velocity NONE");
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
  std::vector<config::ConfigFault> at_places;
  std::vector<AxisNumber> any_speed, any_position;
  for (std::size_t b = 0; b < loaded.models.size(); ++b)
    for (std::size_t d = 0; d < loaded.models[b].size(); ++d) {
      const model::DriveModel& drive = loaded.models[b][d];
      warn_about_constants(loaded.config.buses[b].drives[d], drive, at_places);
      for (std::size_t a = 0; a < drive.axes.size(); ++a) {
        const config::AxisConfig& config = loaded.config.buses[b].drives[d].axes[a];
        warn_about(config, drive.axes[a], drive, at_places);
        if (!config.limits.velocity && has_velocity(drive.axes[a])) any_speed.push_back(config.number);
        if (!config.limits.position && turns_to_positions(drive.axes[a])) any_position.push_back(config.number);
      }
    }
  for (config::ConfigFault& warning : at_places) warning.file = loaded.config.file;
  profile::locate(at_places, loaded.config.read);
  std::vector<std::string> out;
  for (const config::ConfigFault& warning : at_places) out.push_back(text(warning));
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
