// SPDX-License-Identifier: Apache-2.0
// Modes, stops and faults of KincoDrive (JD 6, MD 8, MD M).
#include "tests/simulated/kinco_drive.hpp"

namespace axisgate::simulated {

using enum Cia402State;

void KincoDrive::heard_beside_operation(std::uint16_t) {
  if (operating() && follows_target()) start_move(controlword_);  // 0x103F may be sent directly (JD 6.4, MD 8.1)
}

Dec KincoDrive::option_deceleration(std::int64_t option) const {
  // Odd options ramp with 6084, even ones with 6085; the JD has neither options nor 6085 (MD M, JD 10.7).
  if (!model_.has_stop_options || option % 2 == 1) return object(0x6084);
  return object(0x6085);
}

std::optional<KincoDrive::Stop> KincoDrive::stop_of(Cia402Command command) const {
  // The JD's manual prints no stop options: torque goes off at once, but for 0x0B "load stops, then voltage off".
  std::int64_t option = 0;
  if (command == Cia402Command::quick_stop) option = model_.has_stop_options ? object(0x605A) : 1;
  if (command == Cia402Command::shutdown) option = object(0x605B);
  if (command == Cia402Command::switch_on) option = object(0x605C);
  if (option == 0) return std::nullopt;
  return Stop{option_deceleration(option), option >= 5};  // 5 and 6 stay in quick stop (MD M)
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
  const HomingSettings settings{
      .search_speed = object(0x6099, 0x01),
      .index_speed = object(0x6099, 0x02),
      .acceleration = object(0x609A),
      .offset = object(0x607C) * fine_per_count,
      .run_to_offset = !model_.home_offset_without_move && object(0x6099, 0x05) == 0,
  };
  motion_.home(static_cast<int>(object(0x6098)), settings, axis_, encoder_counts_);
}

void KincoDrive::start_mode() {
  if (mode_ == 4) halted_.reset();  // no halt with torque (MD 8.1)
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

void KincoDrive::raise_fault(std::uint16_t word_1, std::uint16_t word_2) {
  if ((error_1_ | word_1) == error_1_ && (error_2_ | word_2) == error_2_ && state_ == fault) return;
  error_1_ |= word_1;
  error_2_ |= word_2;
  if (model_.has_error_word_2 && error_2_ != 0) error_1_ |= 0x0001;  // "look at word 2" (MD 9)
  if (state_ == fault || state_ == fault_reaction_active) return;
  const std::int64_t option = object(0x605E);  // 0 on the JD, whose reaction is not described (JD 10.7)
  enter_fault(option == 0 ? std::nullopt : std::optional(option_deceleration(option)));
}

void KincoDrive::reset_fault(std::uint64_t tag) {
  if (state_ != fault) return;
  error_1_ = cause_1_;
  error_2_ = cause_2_;
  if (model_.has_error_word_2 && error_2_ != 0) error_1_ |= 0x0001;
  if (error_1_ == 0 && error_2_ == 0) change_state(switch_on_disabled, tag);
}

}  // namespace axisgate::simulated
