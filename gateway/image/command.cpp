// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/command.hpp"

#include "gateway/core/name_table.hpp"

namespace axisgate {

std::string_view text(Command command) {
  using enum Command;
  static constexpr auto kNames = names_of<Command>({
      {none, "none"},
      {enable, "enable"},
      {disable, "disable"},
      {quick_stop, "quick_stop"},
      {halt, "halt"},
      {fault_reset, "fault_reset"},
      {move_absolute, "move_absolute"},
      {move_relative, "move_relative"},
      {run_velocity, "run_velocity"},
      {run_torque, "run_torque"},
      {home, "home"},
      {set_position, "set_position"},
      {save_parameters, "save_parameters"},
      {release, "release"},
      {take_over, "take_over"},
      {end_halt, "end_halt"},
      {jog_forward, "jog_forward"},
      {jog_reverse, "jog_reverse"},
      {jog_end, "jog_end"},
      {end_run, "end_run"},
  });
  static_assert(kNames.has_all_to(Command{kLastCommand}));
  return kNames.of(command);
}

std::optional<Quantity> target_of(Command command) {
  switch (command) {
    case Command::move_absolute:
    case Command::move_relative:
      return Quantity::target_position;
    case Command::run_velocity:
      return Quantity::target_velocity;
    case Command::run_torque:
      return Quantity::target_torque;
    default:
      return std::nullopt;
  }
}

std::string_view subject_of(const WriteBatch& batch) {
  if (batch.command != Command::none) return text(batch.command);
  if (batch.object) return "object";
  if (batch.controlword) return "controlword";
  if (batch.mode) return row(Quantity::mode).name;
  if (!batch.setpoints.empty()) return row(batch.setpoints.back().quantity).name;
  if (batch.set_position_value) return "set_position_value";
  return batch.jog_velocity || batch.jog_again ? "jog_velocity" : std::string_view();
}

bool asks_nothing(const WriteBatch& batch) {
  return batch.setpoints.empty() && !batch.mode && !batch.controlword && batch.command == Command::none &&
         !batch.set_position_value && !batch.jog_velocity && !batch.object;
}

std::string_view text(Role role) {
  static constexpr auto kNames = names_of<Role>({
      {Role::none, "none"},
      {Role::viewer, "viewer"},
      {Role::operator_, "operator"},
      {Role::engineer, "engineer"},
  });
  static_assert(kNames.has_all_to(Role::engineer));
  return kNames.of(role);
}

}  // namespace axisgate
