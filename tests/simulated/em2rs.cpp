// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/em2rs.hpp"

#include <algorithm>
#include <cstdlib>

namespace axisgate::simulated {
namespace {

struct Em2rsAt {
  enum Register : std::uint16_t {
    pulses = 0x0001,
    direction = 0x0007,
    forced_enable = 0x000F,
    first_input = 0x0145,  // every second register up to 0151h
    motion_status = 0x1003,
    following_error = 0x1010,
    demand_position = 0x1012,
    actual_position = 0x1014,
    demand_speed = 0x1044,
    actual_speed = 0x1046,
    control_word = 0x1801,
    save_status = 0x1901,
    current_alarm = 0x2203,
    pr_control = 0x6000,
    pr_trigger = 0x6002,
    soft_limit_positive = 0x6006,
    soft_limit_negative = 0x6008,
    homing_mode = 0x600A,
    homing_fast = 0x600F,
    homing_slow = 0x6010,
    homing_acceleration = 0x6011,
    homing_deceleration = 0x6012,
    path_0 = 0x6200,
  };
};
constexpr std::uint16_t path_size = 8;
constexpr std::uint16_t path_count = 9;

struct Em2rsInput {
  enum Function : std::uint16_t { enable = 0x08, positive_limit = 0x25, negative_limit = 0x26, home_switch = 0x27 };
};

std::map<std::uint16_t, RegisterRow> rows_of(const Em2rsOptions& options) {
  std::map<std::uint16_t, RegisterRow> made;
  const auto add = [&made](const RegisterRow& row) { made[row.number] = row; };
  add({Em2rsAt::pulses, true, 10000, 200, 51200});
  if (options.closed_loop) add({0x0003, true, 2, 0, 2});  // closed loop
  add({Em2rsAt::direction, true, 0, 0, 1});
  add({Em2rsAt::forced_enable, true, 0, 0, 1});
  for (std::uint16_t input = 0; input < Em2rs::inputs; ++input)
    add({static_cast<std::uint16_t>(Em2rsAt::first_input + 2 * input), true, 0});
  made[Em2rsAt::first_input].initial = options.input_enables ? 0x88 : 0x08;
  add({0x0179});                      // levels of the inputs
  add({0x0191, true, 10, 1, 80});     // peak current, 0.1 A
  add({0x01BD, true, 4, 0, 6});       // baud rate
  add({0x01BF, true, options.unit});  // its number
  for (const std::uint16_t pair : {Em2rsAt::following_error, Em2rsAt::demand_position, Em2rsAt::actual_position,
                                   Em2rsAt::demand_speed, Em2rsAt::actual_speed}) {
    add({pair});
    add({static_cast<std::uint16_t>(pair + 1)});
  }
  add({Em2rsAt::motion_status});
  add({Em2rsAt::control_word, true});
  add({Em2rsAt::save_status});
  add({Em2rsAt::current_alarm});
  add({Em2rsAt::pr_control, true, 0});
  add({Em2rsAt::pr_trigger, true});
  for (std::uint16_t limit = Em2rsAt::soft_limit_positive; limit < Em2rsAt::soft_limit_negative + 2; ++limit)
    add({limit, true});
  for (std::uint16_t number = Em2rsAt::homing_mode; number <= Em2rsAt::homing_deceleration; ++number)
    add({number, true});
  made[Em2rsAt::homing_fast].initial = 200;
  made[Em2rsAt::homing_slow].initial = 50;
  made[Em2rsAt::homing_acceleration].initial = made[Em2rsAt::homing_deceleration].initial = 100;
  for (std::uint16_t path = 0; path < path_count; ++path) {
    const auto at = [path](int offset) {
      return static_cast<std::uint16_t>(Em2rsAt::path_0 + path_size * path + offset);
    };
    for (int offset = 0; offset < path_size; ++offset) add({at(offset), true});
    add({at(3), true, 60, -5000, 5000});
    add({at(4), true, 100, 1, 32767});
    add({at(5), true, 100, 1, 32767});
  }
  for (const auto& [number, value] : options.stored) made.at(number).initial = value;
  return made;
}

}  // namespace

Em2rs::Em2rs(const Em2rsOptions& options)
    : RegisterSlave(rows_of(options), options.boot_time),
      options_(options),
      axis_(options_.mechanics, held(Em2rsAt::pulses)) {
  power_up();
}

std::string Em2rs::describe() const {
  return (options_.closed_loop ? "cs2rs@" : "em2rs@") + std::to_string(options_.unit);
}

void Em2rs::power_up() {
  forget();
  fault_ = cause_;
  path_completed_ = true;
  homed_ = homing_ = stopping_ = false;
  save_status_ = 0x1111;
  axis_.redefine(0);
  axis_.forget_demand();
  follow_switches();
}

void Em2rs::restart(Time now) {
  RegisterSlave::restart(now);
  motion_.end();
}

bool Em2rs::at_rest() const { return !motion_.running() && axis_.speed() == 0; }

void Em2rs::step() {
  follow_switches();
  if (!enabled()) motion_.end();
  const bool ran = motion_.running();
  FinePosition highest = INT64_MAX / 4;
  FinePosition lowest = -highest;
  if ((held(Em2rsAt::pr_control) & 2) != 0) {
    highest = held_pair(Em2rsAt::soft_limit_positive) * fine_per_count;
    lowest = held_pair(Em2rsAt::soft_limit_negative) * fine_per_count;
  }
  const Id286proSignals signals{active(Em2rsInput::positive_limit), active(Em2rsInput::negative_limit),
                                active(Em2rsInput::home_switch)};
  const Dec speed = ran ? motion_.next_speed(axis_, signals, lowest, highest) : 0;
  axis_.step(speed, enabled(), held(Em2rsAt::direction) == 1 ? -1 : 1);
  if (motion_.take_reference()) {
    axis_.redefine(axis_.actual() - axis_.demand());
    homed_ = true;
  }
  if (ran && !motion_.running() && enabled() && !stopping_ && (!homing_ || homed_)) path_completed_ = true;
}

bool Em2rs::active(std::uint16_t function) const {
  for (std::size_t input = 0; input < closed_.size(); ++input) {
    const std::int64_t set = held(static_cast<std::uint16_t>(Em2rsAt::first_input + 2 * input));
    if ((set & 0x7F) == function && closed_[input] != ((set & 0x80) != 0)) return true;
  }
  return false;
}

void Em2rs::follow_switches() {
  const Mechanics& by = options_.mechanics;
  const std::int64_t place = counts_of(axis_.physical());
  const auto wire = [this](std::uint16_t function, bool on) {
    for (std::size_t input = 0; input < closed_.size(); ++input) {
      const std::int64_t set = held(static_cast<std::uint16_t>(Em2rsAt::first_input + 2 * input));
      if ((set & 0x7F) == function) closed_[input] = on != ((set & 0x80) != 0);
    }
  };
  if (by.positive_limit) wire(Em2rsInput::positive_limit, place >= *by.positive_limit);
  if (by.negative_limit) wire(Em2rsInput::negative_limit, place <= *by.negative_limit);
  if (by.home_from || by.home_to)
    wire(Em2rsInput::home_switch, (!by.home_from || place >= *by.home_from) && (!by.home_to || place <= *by.home_to));
}

// "Software forced Em2rsInput::enable has a higher priority than IO Em2rsInput::enable": 0 leaves it to the inputs.
bool Em2rs::enabled() const {
  return fault_ == 0 && !booting() && (held(Em2rsAt::forced_enable) == 1 || active(Em2rsInput::enable));
}

std::int64_t Em2rs::status() const {
  const bool idle = !motion_.running();
  return (fault_ != 0 ? 1 : 0) | (enabled() ? 2 : 0) | (idle ? 0 : 4) | (idle && path_completed_ ? 0x30 : 0) |
         (homed_ ? 0x40 : 0);
}

Dec Em2rs::speed_of(std::int64_t rpm) const {
  return divide_rounded(rpm * held(Em2rsAt::pulses) * fine_per_count, 60'000);
}

std::int64_t Em2rs::rpm_of(Dec speed) const {
  return divide_rounded(speed * 60'000, held(Em2rsAt::pulses) * fine_per_count);
}

// The time from 0 to 1000 rpm.
Dec Em2rs::ramp_of(std::int64_t ms_per_1000_rpm) const {
  return std::max<Dec>(speed_of(1000) / std::max<std::int64_t>(ms_per_1000_rpm, 1), 1);
}

std::optional<std::int64_t> Em2rs::shown(std::uint16_t number) const {
  const auto half = [number](std::uint16_t pair, std::int64_t value) -> std::optional<std::int64_t> {
    if (number == pair) return high_of(value);
    if (number == pair + 1) return low_of(value);
    return std::nullopt;
  };
  if (number == Em2rsAt::motion_status) return status();
  if (number == Em2rsAt::current_alarm) return fault_;
  if (number == Em2rsAt::save_status) return save_status_;
  if (const auto word = half(Em2rsAt::following_error, axis_.following_error())) return word;
  if (const auto word = half(Em2rsAt::demand_position, counts_of(axis_.demand()))) return word;
  if (const auto word = half(Em2rsAt::actual_position, counts_of(axis_.actual()))) return word;
  if (const auto word = half(Em2rsAt::demand_speed, rpm_of(axis_.speed()))) return word;
  return half(Em2rsAt::actual_speed, rpm_of(axis_.actual_speed()));
}

// 5555h once, and 1111h from then on.
void Em2rs::was_read(std::uint16_t number) {
  if (number == Em2rsAt::save_status) save_status_ = 0x1111;
}

void Em2rs::written(std::uint16_t number, std::int64_t value, std::uint64_t) {
  if (number == Em2rsAt::pr_trigger && !numb_) trigger(value);
  if (number == Em2rsAt::control_word && value == 0x1111) fault_ = cause_;
  if (number == Em2rsAt::control_word && value == 0x2211) save_status_ = 0x5555;
  if (number == Em2rsAt::forced_enable && !enabled()) motion_.end();
}

void Em2rs::trigger(std::int64_t value) {
  if (value == 0x40 && motion_.running()) {  // quick stop: its ramp is not printed; a tenth of the path's
    stopping_ = true;
    path_completed_ = false;
    motion_.stop({0, 0, 1, ramp_of(std::max<std::int64_t>(held(Em2rsAt::path_0 + 5) / 10, 1)), 0});
  }
  if (value == 0x21 && !motion_.running()) axis_.redefine(axis_.actual() - axis_.demand());
  if (!enabled()) return;
  if (value == 0x20 && !motion_.running()) home();
  if (value >= 0x10 && value < 0x10 + path_count) run_path(static_cast<std::uint16_t>(value - 0x10));
}

void Em2rs::run_path(std::uint16_t path) {
  const auto at = [path](int offset) {
    return static_cast<std::uint16_t>(Em2rsAt::path_0 + path_size * path + offset);
  };
  const std::int64_t mode = held(at(0));
  const bool interrupts = (mode & 0x10) != 0;
  if (motion_.running() && !interrupts) return;
  stopping_ = homing_ = false;
  path_completed_ = false;
  const Id286proProfile profile{0, 0, ramp_of(held(at(4))), ramp_of(held(at(5))), speed_of(std::abs(held(at(3))))};
  const FinePosition travel = held_pair(at(1)) * fine_per_count;
  if ((mode & 0x0F) == 2) return motion_.run(speed_of(held(at(3))), profile);
  if ((mode & 0x0F) == 3) return home();
  if ((mode & 0x0F) != 1) return;
  if ((mode & 0x40) != 0) return motion_.move(Id286proMotion::Task::relative, axis_.demand() + travel, profile);
  motion_.move(Id286proMotion::Task::absolute, travel, profile);
}

// 600Ah: bit 0 forward, bits 2 and on what is looked for: 0 a limit switch, 1 the home switch.
void Em2rs::home() {
  const std::int64_t mode = held(Em2rsAt::homing_mode);
  const bool forward = (mode & 1) != 0;
  homed_ = stopping_ = false;
  homing_ = true;
  path_completed_ = false;
  Id286proHoming way = forward ? Id286proHoming::to_positive_limit : Id286proHoming::to_negative_limit;
  if (mode >> 2 == 1) way = forward ? Id286proHoming::clockwise_to_origin : Id286proHoming::counter_to_origin;
  if (mode >> 2 > 1) return;  // by the Z signal or by torque: not simulated
  motion_.home(way, speed_of(held(Em2rsAt::homing_slow)),
               {0, 0, ramp_of(held(Em2rsAt::homing_acceleration)), ramp_of(held(Em2rsAt::homing_deceleration)),
                speed_of(held(Em2rsAt::homing_fast))});
}

void Em2rs::inject_fault(std::uint16_t code) {
  cause_ = code;
  if (booting()) return;
  fault_ = code;
  motion_.end();
}

void Em2rs::set_input(int input, bool closed) {
  closed_.at(static_cast<std::size_t>(input - 1)) = closed;
  if (!enabled()) motion_.end();
}

}  // namespace axisgate::simulated
