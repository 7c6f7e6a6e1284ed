// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/cia402_drive.hpp"

#include <algorithm>

namespace axisgate::simulated {
namespace {

using enum Cia402State;

constexpr std::uint16_t start_bit = 0x0010, reset_bit = 0x0080, halt_bit = 0x0100, follow_bit = 0x1000;
constexpr std::int64_t position_mode = 1, homing_mode = 6;

}  // namespace

void Cia402Drive::restart(Time now) {
  advance(now);
  ++restarts_;
  store_until_.reset();  // a store under way is lost with the power
  boot_until_ = now + facts_.boot_time;
  pending_.reset();
  motion_.coast();
  halted_.reset();
  change_state(not_ready_to_switch_on, 0);
}

bool Cia402Drive::quiescent() const {
  return !boot_until_ && !store_until_ && !pending_ && !halted_ && motion_.at_rest(axis_) &&
         axis_.demand() == axis_.actual() && !axis_.blurred() && rests();
}

void Cia402Drive::advance(Time now) {
  const std::int64_t until = now / one_millisecond;
  while (ticks_ < until) {
    // A drive at rest has nothing to compute; only its inputs are looked at, once.
    ticks_ = quiescent() ? until : ticks_ + 1;
    tick(ticks_ * one_millisecond);
  }
  now_ = std::max(now_, now);
  boot_by(now_);
}

void Cia402Drive::boot_by(Time at) {
  if (!boot_until_ || at < *boot_until_) return;
  boot_until_.reset();
  power_up();
}

void Cia402Drive::tick(Time at) {
  now_ = at;
  boot_by(at);
  if (store_until_ && at >= *store_until_) {
    store_until_.reset();
    store_now();
    ++stores_;
  }
  inputs_.follow(mechanics_, axis_.physical());
  before_step();
  const Dec before = axis_.speed();
  const Dec speed = motion_.next_speed(axis_, inputs_, settings_);
  axis_.step(speed, motion_.position_loop(), direction());
  after_step(before);
  if (boot_until_) return;
  follow_motion();
  supervise();
}

void Cia402Drive::follow_motion() {
  if (pending_ && axis_.speed() == 0) {
    const Cia402State to = *pending_;
    pending_.reset();
    change_state(to, 0);
    return;
  }
  if (motion_.task() != Task::homing) return;
  switch (motion_.homing()->outcome()) {
    case HomingRun::Outcome::running:
      return;
    case HomingRun::Outcome::reference_found:
      finish_homing();
      homed_ = true;
      break;
    case HomingRun::Outcome::failed:
      homing_error_ = true;
      break;
  }
  motion_.hold(axis_);
}

void Cia402Drive::take_controlword(std::uint16_t word, std::uint64_t tag) {
  if (numb_) {
    unheard_ = word;
    return;
  }
  const auto rising = static_cast<std::uint16_t>(word & ~controlword_);
  const auto falling = static_cast<std::uint16_t>(controlword_ & ~word);
  controlword_ = word;
  if (state_ == fault) {
    const bool whole = (word & facts_.fault_reset_word) == facts_.fault_reset_word;
    if (whole && (rising & reset_bit) != 0) reset_fault(tag);
    return;
  }
  if (state_ == not_ready_to_switch_on || state_ == fault_reaction_active) return;
  const bool was_operating = operating();
  obey(command_in(word), tag);
  if (was_operating && operating()) {
    operate(rising, falling);
  } else {
    heard_beside_operation(rising);
  }
}

void Cia402Drive::lock(bool locked) {
  locked_out_ = locked;
  const bool waits = state_ == ready_to_switch_on || state_ == switched_on;
  if (!locked && waits) obey(command_in(controlword_), 0);
}

void Cia402Drive::numb(bool numb) {
  numb_ = numb;
  if (numb) return;
  set_mode(object(0x6060));
  if (unheard_) take_controlword(*unheard_, 0);
  unheard_.reset();
  take_target_speed();
}

void Cia402Drive::ignore_quick_stop(bool ignores) {
  ignores_quick_stop_ = ignores;
  if (state_ != quick_stop_active) return;
  leave_operation(Cia402Command::quick_stop, switch_on_disabled, 0);
  if (ignores) motion_.run_at(target_speed(), false);
}

void Cia402Drive::obey(Cia402Command command, std::uint64_t tag) {
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
  if (state_ == quick_stop_active) {
    // Transition 16 exists only where the drive stays in quick stop; a stop that ends in torque off runs to its end.
    if (enable && pending_) return;
    if (command == Cia402Command::shutdown && !facts_.shutdown_leaves_quick_stop) return;
  }
  const auto to = next_state(state_, command, facts_.needs_shutdown_first);
  if (!to) return;
  if (state_ == operation_enabled) {
    leave_operation(command, *to, tag);
  } else {
    pending_.reset();
    change_state(*to, tag);
  }
}

void Cia402Drive::leave_operation(Cia402Command command, Cia402State to, std::uint64_t tag) {
  const bool quick = command == Cia402Command::quick_stop;
  pending_.reset();
  halted_.reset();
  if (quick && ignores_quick_stop_) {
    change_state(quick_stop_active, tag);
    return;
  }
  const auto stop = stop_of(command);
  if (!stop) {
    change_state(quick ? switch_on_disabled : to, tag);
    return;
  }
  motion_.stop(stop->deceleration);
  if (quick) {
    change_state(quick_stop_active, tag);
    if (!stop->stays) pending_ = switch_on_disabled;
  } else if (facts_.stands_released_at_once && axis_.speed() == 0) {
    change_state(to, tag);
  } else {
    pending_ = to;
  }
}

void Cia402Drive::change_state(Cia402State to, std::uint64_t tag) {
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

void Cia402Drive::operate(std::uint16_t rising, std::uint16_t falling) {
  if (can_halt()) halt(rising, falling);
  const bool starts = (rising & start_bit) != 0;
  if (mode_ == position_mode && (starts || (follows_target() && (rising & follow_bit) != 0))) start_move(controlword_);
  if (mode_ != homing_mode) return;
  if (starts) {
    homed_ = homing_error_ = false;
    start_homing();
  }
  if ((falling & start_bit) != 0 && motion_.task() == Task::homing) motion_.hold(axis_);
}

void Cia402Drive::halt(std::uint16_t rising, std::uint16_t falling) {
  if ((rising & halt_bit) != 0 && !halted_) {
    halted_ = motion_;
    motion_.stop(halt_deceleration());
  } else if ((falling & halt_bit) != 0 && halted_) {
    motion_ = *halted_;  // what was begun goes on
    halted_.reset();
    halt_ended();
  }
}

void Cia402Drive::set_mode(std::int64_t mode) {
  if (mode == mode_ || numb_) return;
  mode_ = mode;
  if (operating()) start_mode();
}

void Cia402Drive::take_target_speed() {
  if (numb_ || !operating() || !facts_.takes_new_speed_while_on) return;
  const Task task = commanded().task();
  const bool immediate = task == Task::immediate_velocity;
  if (task == Task::velocity || immediate) commanded().run_at(target_speed(), immediate);
}

void Cia402Drive::enter_fault(std::optional<Dec> deceleration) {
  pending_.reset();
  halted_.reset();
  if (state_ == operation_enabled && deceleration) {
    motion_.stop(*deceleration);
    change_state(fault_reaction_active, 0);
    pending_ = fault;
  } else {
    change_state(fault, 0);
  }
}

Dec Cia402Drive::full_acceleration() const {
  return acceleration_dec(mechanics_.rps_per_s_at_full_current, facts_.encoder_counts);
}

Refusal Cia402Drive::poke(ObjectKey key, std::int64_t value) {
  const ObjectEntry* row = objects_.find(key);
  if (row == nullptr) return Refusal::no_such_object;
  if (row->access == Access::rw) {
    return take_write(key, bytes_of(row->type), static_cast<std::uint32_t>(value), 0, false);
  }
  if (measured(key)) return Refusal::read_only;
  objects_.set(key, value_in(row->type, static_cast<std::uint32_t>(value)));
  return Refusal::none;
}

std::optional<std::int64_t> Cia402Drive::peek(ObjectKey key) const {
  const ObjectEntry* found = entry(key);
  return found == nullptr ? std::nullopt : std::optional(value_of(*found));
}

std::int64_t Cia402Drive::value_of(const ObjectEntry& entry) const {
  const auto value = measured(entry.key());
  return value ? *value : objects_.get(entry.key());
}

}  // namespace axisgate::simulated
