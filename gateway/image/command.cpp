// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/command.hpp"

namespace axisgate {

std::string_view text(Command command) {
  switch (command) {
    case Command::none:
      return "none";
    case Command::enable:
      return "enable";
    case Command::disable:
      return "disable";
    case Command::quick_stop:
      return "quick_stop";
    case Command::halt:
      return "halt";
    case Command::fault_reset:
      return "fault_reset";
    case Command::move_absolute:
      return "move_absolute";
    case Command::move_relative:
      return "move_relative";
    case Command::run_velocity:
      return "run_velocity";
    case Command::run_torque:
      return "run_torque";
    case Command::home:
      return "home";
    case Command::set_position:
      return "set_position";
    case Command::save_parameters:
      return "save_parameters";
    case Command::release:
      return "release";
    case Command::take_over:
      return "take_over";
    case Command::end_halt:
      return "end_halt";
    case Command::jog_forward:
      return "jog_forward";
    case Command::jog_reverse:
      return "jog_reverse";
    case Command::jog_end:
      return "jog_end";
    case Command::end_run:
      return "end_run";
  }
  return "?";
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

bool asks_nothing(const WriteBatch& batch) {
  return batch.setpoints.empty() && !batch.mode && !batch.controlword && batch.command == Command::none &&
         !batch.set_position_value && !batch.jog_velocity && !batch.object;
}

std::string_view text(Role role) {
  switch (role) {
    case Role::none:
      return "none";
    case Role::viewer:
      return "viewer";
    case Role::operator_:
      return "operator";
    case Role::engineer:
      return "engineer";
  }
  return "?";
}

}  // namespace axisgate
