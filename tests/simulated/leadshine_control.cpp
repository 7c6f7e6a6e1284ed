// SPDX-License-Identifier: Apache-2.0
// Modes, stops and alarms of LeadshineDrive (5, 6).
#include "tests/simulated/leadshine_drive.hpp"

namespace axisgate::simulated {
namespace {

using enum Cia402State;

constexpr std::uint16_t start_bit = 0x0010;
constexpr std::uint16_t immediate_bit = 0x0020;
constexpr std::uint16_t relative_bit = 0x0040;
constexpr std::uint16_t halt_bit = 0x0100;

constexpr std::int64_t position_mode = 1;
constexpr std::int64_t velocity_mode = 3;
constexpr std::int64_t torque_mode = 4;
constexpr std::int64_t homing_mode = 6;

// 35 and 37 need no motion and no enabled motor (5.8).
bool at_once(std::int64_t method) { return method == 35 || method == 37; }

// The methods with a torque limit run against an end stop; Z after it is left out.
int method_of(std::int64_t method) {
  if (at_once(method)) return 35;
  if (method >= -6 && method <= -1) return method % 2 == 0 ? -17 : -18;
  return static_cast<int>(method);
}

}  // namespace

void LeadshineDrive::heard_beside_operation(std::uint16_t rising) {
  if (mode_ != homing_mode || (rising & start_bit) == 0 || !at_once(object(0x6098))) return;
  finish_homing();
  homed_ = true;
}

// 605Ah and 605Dh (5.4): 1 and 5 the mode's own ramp, 2 and 6 the quick stop's, 3 and 7 the largest.
Dec LeadshineDrive::stop_deceleration(std::int64_t option) const {
  switch (option % 4) {
    case 1:
      return acceleration_of(mode_ == homing_mode ? object(0x609A) : object(0x6084));
    case 2:
      return acceleration_of(object(0x6085));
    case 3:
      return acceleration_of(object(0x60C6));
    default:
      return settings_.deceleration;
  }
}

std::optional<LeadshineDrive::Stop> LeadshineDrive::stop_of(Cia402Command command) const {
  const bool slows_down = object(0x2506) == 0;  // Pr5.06: slow down and release, or release at once
  if (command == Cia402Command::quick_stop) {
    const std::int64_t option = object(0x605A);
    if (option == 0 && !slows_down) return std::nullopt;
    return Stop{stop_deceleration(option), option >= 5};
  }
  if (command == Cia402Command::disable_voltage || !slows_down) return std::nullopt;
  // Which ramp is not printed; this is the one of the worked examples, that of 6084h.
  return Stop{settings_.deceleration, false};
}

void LeadshineDrive::halt_ended() {
  if (mode_ == velocity_mode) motion_.run_at(target_speed(), false);
}

void LeadshineDrive::start_move(std::uint16_t word) {
  if (target_reached()) reached_until_ = now_ + options_.reached_falls;
  FinePosition target = fine_of(object(0x607A));
  if ((word & relative_bit) != 0) {
    const bool moving = commanded().task() == Task::position;
    target += moving ? commanded().target() : axis_.demand();
  }
  commanded().move_to(target, (word & immediate_bit) == 0, axis_);
}

void LeadshineDrive::start_homing() {
  const HomingSettings settings{
      .search_speed = speed_of(object(0x6099, 1)),
      .index_speed = speed_of(object(0x6099, 2)),
      .acceleration = acceleration_of(object(0x609A)),
      .offset = 0,
      .run_to_offset = false,
  };
  motion_.home(method_of(object(0x6098)), settings, axis_, options_.encoder_counts);
}

void LeadshineDrive::start_mode() {
  halted_.reset();
  if (mode_ == velocity_mode) {
    motion_.run_at(options_.needs_halt_edge ? 0 : target_speed(), false);
  } else if (mode_ == torque_mode) {
    motion_.run_torque();
  } else {  // 1 and 6 wait for their start; the others have no set-points here
    motion_.hold(axis_);
  }
  if ((controlword_ & halt_bit) != 0) halt(halt_bit, 0);
}

void LeadshineDrive::raise_fault(std::uint16_t code) {
  if (state_ == fault || state_ == fault_reaction_active || state_ == not_ready_to_switch_on) return;
  error_ = code;
  // 605Eh counts for communication alarms only; 0 and all other alarms stop by an attribute that is not printed.
  const bool by_option = code >> 12 == 8 && object(0x605E) != 0 && mode_ != torque_mode;
  enter_fault(by_option ? std::optional(stop_deceleration(object(0x605E))) : std::nullopt);
}

void LeadshineDrive::reset_fault(std::uint64_t tag) {
  if (state_ != fault || cause_ != 0) return;
  error_ = 0;
  change_state(switch_on_disabled, tag);
}

}  // namespace axisgate::simulated
