// SPDX-License-Identifier: Apache-2.0
// Modes, stops and faults of EdsDrive, and what it reports, as CiA 402 has it.
#include <algorithm>
#include <cstdlib>

#include "tests/simulated/eds_drive.hpp"

namespace axisgate::simulated {
namespace {

using enum Cia402State;

constexpr std::uint16_t start_bit = 0x0010, immediate_bit = 0x0020, relative_bit = 0x0040, halt_bit = 0x0100;
constexpr std::int64_t position_mode = 1, velocity_mode = 3, homing_mode = 6;

// CiA 402's numbers; below 0 the makers' own, against an end stop: the even ones downwards. Their index pulse is left
// out.
int method_of(std::int64_t method) {
  if (method == 35 || method == 37) return 35;
  if (method < 0) return method % 2 == 0 ? -17 : -18;
  return static_cast<int>(method);
}

}  // namespace

// 605Ah and 605Eh: 1 and 5 the mode's own ramp, 2 and 6 the quick stop's, the rest as hard as it can.
Dec EdsDrive::stop_deceleration(std::int64_t option) const {
  switch (option % 4) {
    case 1:
      return mode_ == homing_mode ? acceleration_of(object(0x609A)) : settings_.deceleration;
    case 2:
      return acceleration_of(object(0x6085));
    default:
      return full_acceleration();
  }
}

Dec EdsDrive::halt_deceleration() const { return stop_deceleration(object_or(0x605D, 1)); }

std::optional<EdsDrive::Stop> EdsDrive::stop_of(Cia402Command command) const {
  constexpr std::int64_t stays_from = 5;
  std::int64_t option = 0;
  if (command == Cia402Command::quick_stop) option = object_or(0x605A, type().quick_stop);
  if (command == Cia402Command::shutdown) option = object_or(0x605B, type().shutdown);
  if (command == Cia402Command::switch_on) option = object_or(0x605C, type().disable);
  if (option == 0) return std::nullopt;
  return Stop{stop_deceleration(option), command == Cia402Command::quick_stop && option >= stays_from};
}

// vl: the ramp's generator is enabled, unlocked and fed by 6042h, or its output is 0.
Dec EdsDrive::target_speed() const {
  constexpr std::uint16_t ramps = 0x0070;
  if (mode_ != vl_mode) return speed_of(object(0x60FF));
  return (controlword_ & ramps) == ramps ? speed_dec(object(0x6042), encoder_counts()) : 0;
}

void EdsDrive::halt_ended() {
  if (mode_ == velocity_mode || mode_ == vl_mode) motion_.run_at(target_speed(), false);
}

void EdsDrive::start_mode() {
  halted_.reset();
  if (mode_ == velocity_mode || mode_ == vl_mode) {
    motion_.run_at(target_speed(), false);
  } else if (mode_ == type().torque_mode) {
    motion_.run_torque();
  } else {  // 1 and 6 wait for their start; the others have no set-points here
    motion_.hold(axis_);
  }
  if ((controlword_ & halt_bit) != 0) halt(halt_bit, 0);
}

void EdsDrive::start_move(std::uint16_t word) {
  FinePosition target = fine_of(object(0x607A));
  if ((word & relative_bit) != 0) {
    const bool moving = commanded().task() == Task::position;
    target += moving ? commanded().target() : axis_.demand();
  }
  commanded().move_to(target, (word & immediate_bit) == 0, axis_);
}

void EdsDrive::start_homing() {
  const std::int64_t method = object(0x6098);
  const bool there = type().homing.empty() || std::ranges::count(type().homing, method) > 0;
  const HomingSettings settings{
      .search_speed = speed_of(object(0x6099, 1)),
      .index_speed = speed_of(object(0x6099, 2)),
      .acceleration = acceleration_of(object(0x609A)),
      .offset = 0,
      .run_to_offset = false,
  };
  motion_.home(there ? method_of(method) : 0, settings, axis_, encoder_counts());
}

void EdsDrive::raise_fault(std::uint16_t code) {
  if (state_ == fault || state_ == fault_reaction_active || state_ == not_ready_to_switch_on) return;
  error_ = code;
  const std::int64_t option = object_or(0x605E, type().fault_reaction);
  enter_fault(option == 0 ? std::nullopt : std::optional(stop_deceleration(option)));
}

void EdsDrive::reset_fault(std::uint64_t tag) {
  if (state_ != fault || cause_ != 0) return;
  error_ = 0;
  change_state(switch_on_disabled, tag);
}

std::uint8_t EdsDrive::error_register() const {
  switch (error_ >> 12) {
    case 0:
      return 0;
    case 2:
      return 0x03;
    case 3:
      return 0x05;
    case 4:
      return 0x09;
    case 8:
      return 0x11;
    default:
      return 0x01;
  }
}

bool EdsDrive::target_reached() const {
  constexpr std::int64_t speed_window_rpm = 10;
  if (halted_) return axis_.speed() == 0;
  if (mode_ == position_mode) {
    const bool commanded = motion_.task() == Task::position && motion_.target() != axis_.demand();
    const std::int64_t error = raw_of(std::abs(axis_.demand() - axis_.actual()));
    return !commanded && error <= object_or(0x6067, 0);
  }
  if (mode_ == velocity_mode || mode_ == vl_mode) {
    return std::abs(axis_.actual_speed() - target_speed()) <= speed_dec(speed_window_rpm, encoder_counts());
  }
  if (mode_ == homing_mode) return motion_.task() != Task::homing && axis_.speed() == 0;
  return mode_ == type().torque_mode;
}

std::uint16_t EdsDrive::statusword() const {
  std::uint16_t word = state_bits(state_);
  if (state_ == not_ready_to_switch_on) return word;
  const auto set = [&word](std::uint16_t bit, bool on) { word = static_cast<std::uint16_t>(on ? word | bit : word); };
  set(0x0200, true);  // remote
  set(0x0800, inputs_.at_positive_limit() || inputs_.at_negative_limit() || motion_.limited());
  if (mode_ == homing_mode) {
    set(0x1000, homed_);
    set(0x2000, homing_error_);
  }
  if (state_ != operation_enabled) return word;
  set(0x0400, target_reached());
  if (mode_ == velocity_mode) set(0x1000, axis_.actual_speed() == 0);
  if (mode_ == position_mode) set(0x1000, (controlword_ & start_bit) != 0);
  return word;
}

std::uint32_t EdsDrive::input_word() const {
  std::uint32_t word = static_cast<std::uint32_t>(inputs_.effective()) << 16;
  if (inputs_.at_negative_limit()) word |= 1U;
  if (inputs_.at_positive_limit()) word |= 2U;
  if (inputs_.active(InputFunction::home_switch)) word |= 4U;
  return word;
}

std::int64_t EdsDrive::torque_actual() const {
  if (motion_.task() == Task::coast) return 0;
  if (motion_.task() == Task::torque) return torque_demand_;
  const Dec full = std::max<Dec>(full_acceleration(), 1);
  return std::clamp<std::int64_t>(last_step_ * full_torque / full, -full_torque, full_torque);
}

std::optional<std::int64_t> EdsDrive::measured(ObjectKey key) const {
  if (key.sub != 0) return std::nullopt;
  switch (key.index) {
    case 0x603F:
      return error_;
    case 0x6040:
      return heard_controlword();
    case 0x6041:
      return statusword();
    case 0x6043:
      return rpm_of(axis_.speed(), encoder_counts());
    case 0x6044:
      return rpm_of(axis_.told_speed(), encoder_counts());
    case 0x6061:
      return mode_;
    case 0x6062:
      return static_cast<std::int32_t>(raw_of(axis_.demand()));
    case 0x6063:
      return static_cast<std::int32_t>(counts_of(axis_.actual()));
    case 0x6064:
      return position();
    case 0x606B:
      return raw_speed_of(axis_.speed());
    case 0x606C:
      return raw_speed_of(axis_.told_speed());
    case 0x6074:
      return torque_demand_;
    case 0x6077:
    case 0x6078:
      return torque_actual();
    case 0x60F4:
      return raw_of(axis_.following_error() * fine_per_count);
    case 0x60FD:
      return input_word();
    default:
      return std::nullopt;
  }
}

}  // namespace axisgate::simulated
