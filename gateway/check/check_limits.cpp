// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check_limits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gateway/profile/resolve/limit_keys.hpp"

namespace axisgate::app {
namespace {

std::vector<std::string_view> keys_of(const AxisLimits& limits) {
  std::vector<std::string_view> keys;
  const auto add = [&keys](const auto& limit, Quantity quantity) {
    if (limit) keys.push_back(drive::limit_key(quantity));
  };
  add(limits.position, Quantity::target_position);
  add(limits.velocity, Quantity::target_velocity);
  add(limits.acceleration, Quantity::profile_acceleration);
  add(limits.torque, Quantity::target_torque);
  add(limits.quick_stop_deceleration_min, Quantity::quick_stop_deceleration);
  return keys;
}

/// What this key is for, where nobody can write any of it on this drive; else nothing.
std::vector<std::string_view> bounded_in_vain(std::string_view key, const drive::AxisModel& axis) {
  std::vector<std::string_view> names;
  for (const QuantityRow& each : quantity_table()) {
    if (drive::limit_key(each.quantity) != key) continue;
    if (axis.takes(each.quantity)) return {};
    names.push_back(each.name);
  }
  return names;
}

void warn_about(const AxisConfig& config, const drive::AxisModel& axis, const drive::DriveModel& drive,
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
      warn(drive::limit_key(Quantity::target_velocity),
           fmt::format(
               "does not reach {}: of {} no {} is known that could be written; set a safe one in the drive itself",
               motion, drive.title, speed));
  };
  warn_of_own_speed(homes_at_its_own, "homing", "homing speed");
  warn_of_own_speed(moves_at_its_own, "moves", "profile_velocity");
}

}  // namespace

std::vector<std::string> limit_warnings(const LoadedConfig& loaded) {
  std::vector<std::string> out;
  for (std::size_t b = 0; b < loaded.models.size(); ++b)
    for (std::size_t d = 0; d < loaded.models[b].size(); ++d) {
      const drive::DriveModel& drive = loaded.models[b][d];
      for (std::size_t a = 0; a < drive.axes.size(); ++a)
        warn_about(loaded.config.buses[b].drives[d].axes[a], drive.axes[a], drive, loaded.config.file, out);
    }
  return out;
}

}  // namespace axisgate::app
