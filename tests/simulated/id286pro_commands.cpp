// SPDX-License-Identifier: Apache-2.0
// What 0323, 0206 and the inputs' functions make the iD286pro do (iD286pro 5, 6, 7).
#include <algorithm>

#include "tests/simulated/id286pro.hpp"

namespace axisgate::simulated {
namespace {

enum Command : std::uint16_t {
  absolute_move = 1,
  relative_move = 2,
  speed_mode = 3,
  jog_forward = 4,
  jog_reverse = 5,
  decelerated_stop = 6,
  emergency_stop = 7,
  set_current_position = 8,
  origin_signal = 11,
  start_homing = 12,
  clear_the_alarm = 13,
  save_segments = 15,
};

bool begins_motion(std::uint16_t command) {
  return (command >= absolute_move && command <= jog_reverse) || command == start_homing;
}

}  // namespace

Dec Id286pro::speed_of(std::int64_t hundredths) const {
  return divide_rounded(hundredths * registers_.get(242) * fine_per_count, 100'000);
}

Dec Id286pro::acceleration_of(std::int64_t revolutions) const {
  return std::max<Dec>(divide_rounded(revolutions * registers_.get(242) * fine_per_count, 1'000'000), 1);
}

// The settings as they stand when the command comes: that a later change acts is stated for the target alone.
Id286proProfile Id286pro::profile(std::int64_t speed) const {
  return {speed_of(registers_.get(301)), speed_of(registers_.get(302)), acceleration_of(registers_.get(303)),
          acceleration_of(registers_.get(304)), speed_of(speed)};
}

bool Id286pro::can_obey(std::uint16_t command) const {
  if (command == set_current_position) return !motion_.running();
  if (command == relative_move && motion_.running()) return false;
  return !begins_motion(command) || (internal_ && enabled());
}

void Id286pro::obey(std::uint16_t command, std::uint64_t tag) {
  if (numb_ || !can_obey(command)) return;
  if (begins_motion(command)) {
    starts_.push_back({now_, tag, command});
    if (starts_.size() > start_limit) starts_.pop_front();
  }
  const FinePosition travel = registers_.get(313) * fine_per_count;
  switch (command) {
    case absolute_move:
      return motion_.move(Id286proMotion::Task::absolute, travel, profile(registers_.get(306)));
    case relative_move:
      return motion_.move(Id286proMotion::Task::relative, axis_.demand() + travel, profile(registers_.get(306)));
    case speed_mode:
      return motion_.run(speed_of(registers_.get(307)), profile(0));
    case jog_forward:
      return motion_.run(speed_of(registers_.get(308)), profile(0));
    case jog_reverse:
      return motion_.run(-speed_of(registers_.get(308)), profile(0));
    case decelerated_stop:
      return motion_.stop(profile(0));
    case emergency_stop:
      return motion_.end();
    case set_current_position:
      return axis_.redefine(axis_.actual() + registers_.get(321) * fine_per_count - axis_.demand());
    case origin_signal:
      origin_command_ = motion_.running();
      return;
    case start_homing:
      return motion_.home(static_cast<Id286proHoming>(registers_.get(305)), speed_of(registers_.get(310)),
                          profile(registers_.get(309)));
    case clear_the_alarm:
      return clear_alarm();
    case save_segments:
      return registers_.save_area();
    default:  // limits and enable are levels of inputs; how segments are packed is not stated, so none is ever run
      return;
  }
}

void Id286pro::clear_alarm() {
  if (clearable_) fault_ = cause_;
}

void Id286pro::obey_user_command(std::int64_t command) {
  if (command == 1) {
    registers_.restore_defaults();
    inputs_.configure(registers_);
  }
  if (command == 2) clear_alarm();
  if (command == 3) restart_at_ = now_ + options_.restart_after;
}

}  // namespace axisgate::simulated
