// SPDX-License-Identifier: Apache-2.0
// Controlword, modes, stops and alarms of LeadshineDrive (5, 6).
#include "tests/simulated/leadshine_drive.hpp"

namespace axisgate::simulated {
namespace {

using enum Cia402State;

constexpr std::uint16_t start_bit = 0x0010;
constexpr std::uint16_t immediate_bit = 0x0020;
constexpr std::uint16_t relative_bit = 0x0040;
constexpr std::uint16_t reset_bit = 0x0080;
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

void LeadshineDrive::take_controlword(std::uint16_t word, std::uint64_t tag) {
  if (numb_) {
    unheard_ = word;
    return;
  }
  const auto rising = static_cast<std::uint16_t>(word & ~controlword_);
  const auto falling = static_cast<std::uint16_t>(controlword_ & ~word);
  controlword_ = word;
  if (state_ == fault) {
    if ((rising & reset_bit) != 0) reset_fault(tag);
    return;
  }
  if (state_ == not_ready_to_switch_on || state_ == fault_reaction_active) return;
  const bool was_operating = operating();
  obey(command_in(word), tag);
  if (was_operating && operating()) {
    operate(rising, falling);
  } else if (mode_ == homing_mode && (rising & start_bit) != 0 && at_once(object(0x6098))) {
    finish_homing();
  }
}

void LeadshineDrive::lock(bool locked) {
  locked_out_ = locked;
  const bool waits = state_ == ready_to_switch_on || state_ == switched_on;
  if (!locked && waits) obey(command_in(controlword_), 0);
}

void LeadshineDrive::numb(bool numb) {
  numb_ = numb;
  if (numb) return;
  set_mode(object(0x6060));
  if (unheard_) take_controlword(*unheard_, 0);
  unheard_.reset();
  take_target_speed();
}

void LeadshineDrive::ignore_quick_stop(bool ignores) {
  ignores_quick_stop_ = ignores;
  if (state_ != quick_stop_active) return;
  leave_operation(Cia402Command::quick_stop, switch_on_disabled, 0);
  if (ignores) motion_.run_at(speed_of(object(0x60FF)), false);
}

void LeadshineDrive::obey(Cia402Command command, std::uint64_t tag) {
  const bool enable = command == Cia402Command::enable_operation;
  if (enable && inputs_.active(InputFunction::emergency_stop)) return;
  if (enable && locked_out_ && state_ != operation_enabled) return;
  if (state_ == operation_enabled && enable) {
    if (pending_) {  // the stop under way is taken back
      pending_.reset();
      start_mode();
    }
    return;
  }
  // CiA 402: out of quick stop lead transitions 12 and 16 alone, the latter where the drive stays in it.
  if (state_ == quick_stop_active && (command == Cia402Command::shutdown || (enable && pending_))) return;
  const auto to = next_state(state_, command, true);
  if (!to) return;
  if (state_ == operation_enabled) {
    leave_operation(command, *to, tag);
  } else {
    pending_.reset();
    change_state(*to, tag);
  }
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

void LeadshineDrive::leave_operation(Cia402Command command, Cia402State to, std::uint64_t tag) {
  const bool slows_down = object(0x2506) == 0;  // Pr5.06: slow down and release, or release at once
  pending_.reset();
  halted_.reset();
  if (command == Cia402Command::quick_stop && ignores_quick_stop_) {
    change_state(quick_stop_active, tag);
    return;
  }
  if (command == Cia402Command::quick_stop) {
    const std::int64_t option = object(0x605A);
    if (option == 0 && !slows_down) {
      change_state(switch_on_disabled, tag);
      return;
    }
    motion_.stop(stop_deceleration(option));
    change_state(quick_stop_active, tag);
    if (option < 5) pending_ = switch_on_disabled;
    return;
  }
  if (command == Cia402Command::disable_voltage || !slows_down) {
    change_state(to, tag);
    return;
  }
  // Which ramp is not printed; this is the one of the worked examples, that of 6084h.
  motion_.stop(settings_.deceleration);
  pending_ = to;
  if (axis_.speed() == 0) {
    pending_.reset();
    change_state(to, tag);
  }
}

void LeadshineDrive::change_state(Cia402State to, std::uint64_t tag) {
  if (to == state_) return;
  transitions_.push_back({now_, tag, state_, to});
  if (transitions_.size() > transition_limit) transitions_.pop_front();
  state_ = to;
  if (to == operation_enabled) {
    axis_.forget_demand();
    halted_.reset();
    start_mode();
    return;
  }
  if (to == quick_stop_active || to == fault_reaction_active) return;  // still with torque, stopping
  motion_.coast();
  halted_.reset();
}

void LeadshineDrive::operate(std::uint16_t rising, std::uint16_t falling) {
  halt(rising, falling);
  if (mode_ == position_mode && (rising & start_bit) != 0) start_move(controlword_);
  if (mode_ == homing_mode && (rising & start_bit) != 0) start_homing();
  if (mode_ == homing_mode && (falling & start_bit) != 0 && motion_.task() == Task::homing) motion_.hold(axis_);
}

void LeadshineDrive::halt(std::uint16_t rising, std::uint16_t falling) {
  if ((rising & halt_bit) != 0 && !halted_) {
    halted_ = motion_;
    motion_.stop(stop_deceleration(object(0x605D)));
  } else if ((falling & halt_bit) != 0 && halted_) {
    motion_ = *halted_;  // what was begun goes on
    halted_.reset();
    if (mode_ == velocity_mode) motion_.run_at(speed_of(object(0x60FF)), false);
  }
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
  homed_ = homing_error_ = false;
  const HomingSettings settings{
      .search_speed = speed_of(object(0x6099, 1)),
      .index_speed = speed_of(object(0x6099, 2)),
      .acceleration = acceleration_of(object(0x609A)),
      .offset = 0,
      .run_to_offset = false,
  };
  motion_.home(method_of(object(0x6098)), settings, axis_, options_.encoder_counts);
}

void LeadshineDrive::set_mode(std::int64_t mode) {
  if (mode == mode_ || numb_) return;
  mode_ = mode;
  if (operating()) start_mode();
}

void LeadshineDrive::start_mode() {
  halted_.reset();
  if (mode_ == velocity_mode) {
    motion_.run_at(options_.needs_halt_edge ? 0 : speed_of(object(0x60FF)), false);
  } else if (mode_ == torque_mode) {
    motion_.run_torque();
  } else {  // 1 and 6 wait for their start; the others have no set-points here
    motion_.hold(axis_);
  }
  if ((controlword_ & halt_bit) != 0) halt(halt_bit, 0);
}

void LeadshineDrive::take_target_speed() {
  if (numb_ || !operating() || commanded().task() != Task::velocity || options_.needs_halt_edge) return;
  commanded().run_at(speed_of(object(0x60FF)), false);
}

void LeadshineDrive::raise_fault(std::uint16_t code) {
  if (state_ == fault || state_ == fault_reaction_active || state_ == not_ready_to_switch_on) return;
  error_ = code;
  pending_.reset();
  halted_.reset();
  // 605Eh counts for communication alarms only; 0 and all other alarms stop by an attribute that is not printed.
  const bool by_option = code >> 12 == 8 && object(0x605E) != 0 && mode_ != torque_mode;
  if (state_ == operation_enabled && by_option) {
    motion_.stop(stop_deceleration(object(0x605E)));
    change_state(fault_reaction_active, 0);
    pending_ = fault;
  } else {
    change_state(fault, 0);
  }
}

void LeadshineDrive::reset_fault(std::uint64_t tag) {
  if (state_ != fault || cause_ != 0) return;
  error_ = 0;
  change_state(switch_on_disabled, tag);
}

}  // namespace axisgate::simulated
