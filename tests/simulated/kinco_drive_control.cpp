// SPDX-License-Identifier: Apache-2.0
// Controlword, modes and stops of KincoDrive (JD 6, MD 8, MD M).
#include "tests/simulated/kinco_drive.hpp"

namespace axisgate::simulated {

using enum Cia402State;

void KincoDrive::take_controlword(std::uint16_t word, std::uint64_t tag) {
  if (numb_) {
    unheard_ = word;
    return;
  }
  const auto rising = static_cast<std::uint16_t>(word & ~controlword_);
  const auto falling = static_cast<std::uint16_t>(controlword_ & ~word);
  controlword_ = word;
  if (state_ == fault) {
    // JD 0x80, MD 0x86 (JD 6.1, MD 8.1): bit 7 rising, and for the MD bits 1 and 2 with it.
    const bool whole = (word & model_.fault_reset_word) == model_.fault_reset_word;
    if (whole && (rising & 0x0080) != 0) reset_fault(tag);
    return;
  }
  if (state_ == not_ready_to_switch_on || state_ == fault_reaction_active) return;
  const bool was_operating = operating();
  obey(command_in(word), tag);
  if (!operating()) return;
  if (was_operating) {
    operate(rising, falling);
  } else if (follows_target()) {
    start_move(word);  // 0x103F may be sent directly (JD 6.4, MD 8.1)
  }
}

void KincoDrive::lock(bool locked) {
  locked_out_ = locked;
  const bool waits = state_ == ready_to_switch_on || state_ == switched_on;
  if (!locked && waits) obey(command_in(controlword_), 0);
}

void KincoDrive::numb(bool numb) {
  numb_ = numb;
  if (numb) return;
  set_mode(object(0x6060));
  if (unheard_) take_controlword(*unheard_, 0);
  unheard_.reset();
  take_target_speed();
}

void KincoDrive::ignore_quick_stop(bool ignores) {
  ignores_quick_stop_ = ignores;
  if (state_ != quick_stop_active) return;
  leave_operation(Cia402Command::quick_stop, switch_on_disabled, 0);
  if (ignores) motion_.run_at(object(0x60FF), false);
}

void KincoDrive::obey(Cia402Command command, std::uint64_t tag) {
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
  // Transition 16 exists only where the drive stays in quick stop; a stop that ends in torque off runs to its end.
  if (state_ == quick_stop_active && enable && pending_) return;
  const auto to = next_state(state_, command, options_.needs_shutdown_first);
  if (!to) return;
  if (state_ == operation_enabled) {
    leave_operation(command, *to, tag);
  } else {
    pending_.reset();
    change_state(*to, tag);
  }
}

Dec KincoDrive::option_deceleration(std::int64_t option) const {
  // Odd options ramp with 6084, even ones with 6085; the JD has neither options nor 6085 (MD M, JD 10.7).
  if (!model_.has_stop_options || option % 2 == 1) return object(0x6084);
  return object(0x6085);
}

void KincoDrive::leave_operation(Cia402Command command, Cia402State to, std::uint64_t tag) {
  // The JD's manual prints no stop options: torque goes off at once, but for 0x0B "load stops, then voltage off".
  std::int64_t option = 0;
  if (command == Cia402Command::quick_stop) option = model_.has_stop_options ? object(0x605A) : 1;
  if (command == Cia402Command::shutdown) option = object(0x605B);
  if (command == Cia402Command::switch_on) option = object(0x605C);
  pending_.reset();
  halted_.reset();
  if (command == Cia402Command::quick_stop && ignores_quick_stop_) {
    change_state(quick_stop_active, tag);
    return;
  }
  if (option == 0) {
    change_state(command == Cia402Command::quick_stop ? switch_on_disabled : to, tag);
    return;
  }
  motion_.stop(option_deceleration(option));
  if (command == Cia402Command::quick_stop) {
    change_state(quick_stop_active, tag);
    if (option < 5) pending_ = switch_on_disabled;  // 5 and 6 stay in quick stop (MD M)
  } else {
    pending_ = to;
  }
}

void KincoDrive::change_state(Cia402State to, std::uint64_t tag) {
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

bool KincoDrive::follows_target() const { return mode_ == 1 && (controlword_ & 0x1010) == 0x1010; }

void KincoDrive::operate(std::uint16_t rising, std::uint16_t falling) {
  if (model_.has_halt && mode_ != 4) {
    if ((rising & 0x0100) != 0 && !halted_) {
      halted_ = motion_;
      motion_.stop(option_deceleration(object(0x605D)));
    } else if ((falling & 0x0100) != 0 && halted_) {
      motion_ = *halted_;  // what was begun goes on
      halted_.reset();
    }
  }
  if (mode_ == 1 && ((rising & 0x0010) != 0 || (follows_target() && (rising & 0x1000) != 0))) start_move(controlword_);
  if (mode_ == 6 && (rising & 0x0010) != 0) start_homing();
  if (mode_ == 6 && (falling & 0x0010) != 0 && motion_.task() == Task::homing) motion_.hold(axis_);
}

void KincoDrive::start_move(std::uint16_t word) {
  const std::int64_t wanted = object(0x607A);
  const std::int64_t counts = counts_of(axis_.demand());
  // 6063 wraps at 32 bits; an absolute target is meant in what 6063 reads.
  FinePosition target = (counts + wanted - static_cast<std::int32_t>(counts)) * fine_per_count;
  if ((word & 0x0040) != 0) {  // relative to the set-point (JD 6.1 bit 6)
    const bool moving = commanded().task() == Task::position;
    target = (moving ? counts_of(commanded().target()) : counts) * fine_per_count + wanted * fine_per_count;
  }
  const bool buffered = (word & 0x0020) == 0 && (word & 0x1000) == 0;  // bit 5: change immediately
  commanded().move_to(target, buffered, axis_);
  outside_window_at_ = now_;
}

void KincoDrive::start_homing() {
  reference_found_ = homing_error_ = false;
  const HomingSettings settings{
      .search_speed = object(0x6099, 0x01),
      .index_speed = object(0x6099, 0x02),
      .acceleration = object(0x609A),
      .offset = object(0x607C) * fine_per_count,
      .run_to_offset = !model_.home_offset_without_move && object(0x6099, 0x05) == 0,
  };
  motion_.home(static_cast<int>(object(0x6098)), settings, axis_, encoder_counts_);
}

void KincoDrive::set_mode(std::int64_t mode) {
  if (mode == mode_ || numb_) return;
  mode_ = mode;
  if (!operating()) return;
  if (halted_ && mode == 4) halted_.reset();  // no halt with torque (MD 8.1)
  start_mode();
}

void KincoDrive::start_mode() {
  outside_window_at_ = now_;
  switch (mode_) {
    case 3:
    case -3:
      commanded().run_at(object(0x60FF), mode_ == -3);
      return;
    case 4:
      commanded().run_torque();
      return;
    default:  // 1 and 6 wait for their start; -4 has no pulses here and 7 no set-points
      commanded().hold(axis_);
  }
}

void KincoDrive::take_target_speed() {
  if (numb_) return;
  const Task task = commanded().task();
  if (operating() && (task == Task::velocity || task == Task::immediate_velocity)) {
    commanded().run_at(object(0x60FF), mode_ == -3);
  }
}

void KincoDrive::raise_fault(std::uint16_t word_1, std::uint16_t word_2) {
  if ((error_1_ | word_1) == error_1_ && (error_2_ | word_2) == error_2_ && state_ == fault) return;
  error_1_ |= word_1;
  error_2_ |= word_2;
  if (model_.has_error_word_2 && error_2_ != 0) error_1_ |= 0x0001;  // "look at word 2" (MD 9)
  if (state_ == fault || state_ == fault_reaction_active) return;
  const std::int64_t option = object(0x605E);  // 0 on the JD, whose reaction is not described (JD 10.7)
  pending_.reset();
  halted_.reset();
  if (state_ == operation_enabled && option != 0) {
    motion_.stop(option_deceleration(option));
    change_state(fault_reaction_active, 0);
    pending_ = fault;
  } else {
    change_state(fault, 0);
  }
}

void KincoDrive::reset_fault(std::uint64_t tag) {
  if (state_ != fault) return;
  error_1_ = cause_1_;
  error_2_ = cause_2_;
  if (model_.has_error_word_2 && error_2_ != 0) error_1_ |= 0x0001;
  if (error_1_ == 0 && error_2_ == 0) change_state(switch_on_disabled, tag);
}

}  // namespace axisgate::simulated
