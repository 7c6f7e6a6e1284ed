// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/zlac8015d.hpp"

#include <algorithm>
#include <cstdlib>

namespace axisgate::simulated {
namespace {

// Where there are two, the left motor's; the right one's follows at once, or 30h on.
struct ZlacAt {
  enum Register : std::uint16_t {
    loss_time = 0x2000,
    inputs = 0x2003,
    clear_position = 0x2005,
    set_origin = 0x2006,
    max_speed = 0x2008,
    operating_mode = 0x200D,
    control_word = 0x200E,
    synchronous = 0x200F,
    save_on_write = 0x2010,
    quick_stop_code = 0x2011,
    encoder_lines = 0x2030,
    acceleration_time = 0x2080,
    deceleration_time = 0x2082,
    emergency_time = 0x2084,
    target_speed = 0x2088,
    target_position = 0x208A,  // pairs
    position_speed = 0x208E,
    target_torque = 0x2090,
    bus_voltage = 0x20A1,
    motor_states = 0x20A2,
    motor_temperatures = 0x20A4,
    faults = 0x20A5,
    actual_position = 0x20A7,  // pairs
    actual_speed = 0x20AB,
    actual_torque = 0x20AD,
  };
};
constexpr std::uint16_t right_lines = 0x2060;
struct ZlacMode {
  enum : std::uint16_t { relative_position = 1, absolute_position = 2, speed = 3 };
};

std::uint16_t register_of(std::uint16_t left_register, std::size_t motor) {
  return static_cast<std::uint16_t>(left_register + motor);
}
std::uint16_t pair_of(std::uint16_t left_register, std::size_t motor) {
  return static_cast<std::uint16_t>(left_register + 2 * motor);
}

std::map<std::uint16_t, RegisterRow> rows_of(const ZlacOptions& options) {
  std::map<std::uint16_t, RegisterRow> made;
  const auto add = [&made](const RegisterRow& row) { made[row.number] = row; };
  add({ZlacAt::loss_time, true, 0, 0, 32767});
  add({0x2001, true, options.unit, 1, 127});
  add({ZlacAt::inputs});
  add({ZlacAt::clear_position, true, 0, 0, 3});
  add({ZlacAt::set_origin, true, 0, 0, 3});
  add({ZlacAt::max_speed, true, 1000, 1, 1000});
  add({ZlacAt::operating_mode, true, 0, 0, 4});
  add({ZlacAt::control_word, true, 0});
  add({ZlacAt::synchronous, true, 0, 0, 1});
  add({ZlacAt::save_on_write, true, 0, 0, 1});
  add({ZlacAt::quick_stop_code, true, 5, 5, 7});
  add({ZlacAt::encoder_lines, true, 1024, 0, 4096});
  add({right_lines, true, 1024, 0, 4096});
  for (const std::size_t motor : {Zlac8015d::left, Zlac8015d::right}) {
    add({register_of(ZlacAt::acceleration_time, motor), true, 500, 0, 32767});
    add({register_of(ZlacAt::deceleration_time, motor), true, 500, 0, 32767});
    add({register_of(ZlacAt::emergency_time, motor), true, 10, 0, 32767});
    add({register_of(ZlacAt::target_speed, motor), true, 0, -3000, 3000});
    add({register_of(ZlacAt::position_speed, motor), true, 120, 1, 1000});
    add({register_of(ZlacAt::target_torque, motor), true, 0, -30000, 30000});
    add({register_of(ZlacAt::faults, motor)});
    add({register_of(ZlacAt::actual_speed, motor)});
    add({register_of(ZlacAt::actual_torque, motor)});
    for (const int half : {0, 1}) {
      add({static_cast<std::uint16_t>(pair_of(ZlacAt::target_position, motor) + half), true});
      add({static_cast<std::uint16_t>(pair_of(ZlacAt::actual_position, motor) + half)});
    }
  }
  for (const int other : {0x2086, 0x2087}) add({static_cast<std::uint16_t>(other), true, 300});  // torque slopes
  for (const int other : {0x20A0, 0x20A3, 0x20AF})
    add({static_cast<std::uint16_t>(other)});  // version, Hall sensors, host's link
  add({ZlacAt::bus_voltage});
  add({ZlacAt::motor_states});
  add({ZlacAt::motor_temperatures});
  for (const auto& [number, value] : options.stored) made.at(number).initial = value;
  return made;
}

std::int64_t lines_in(const ZlacOptions& options, std::uint16_t number) {
  const auto found = options.stored.find(number);
  return found == options.stored.end() ? 1024 : found->second;
}

}  // namespace

Zlac8015d::Zlac8015d(const ZlacOptions& options)
    : RegisterSlave(rows_of(options), options.boot_time),
      options_(options),
      motors_{Motor{Axis(options_.mechanics[left], 4 * lines_in(options_, ZlacAt::encoder_lines)), {}},
              Motor{Axis(options_.mechanics[right], 4 * lines_in(options_, right_lines)), {}}} {
  power_up();
}

std::int64_t Zlac8015d::counts_per_rev(std::size_t motor) const {
  return 4 * held(motor == left ? std::uint16_t{ZlacAt::encoder_lines} : right_lines);
}

void Zlac8015d::power_up() {
  forget();
  state_ = State::released;
  faults_ = causes_;
  for (Motor& motor : motors_) {
    motor.motion.end();
    motor.axis.redefine(0);
    motor.axis.forget_demand();
  }
}

bool Zlac8015d::at_rest() const {
  return std::ranges::all_of(motors_,
                             [](const Motor& motor) { return !motor.motion.running() && motor.axis.speed() == 0; });
}

void Zlac8015d::step() {
  constexpr FinePosition far = INT64_MAX / 4;
  bool moves = false;
  for (Motor& motor : motors_) {
    if (!powered()) motor.motion.end();
    const Dec now_speed = motor.motion.running() ? motor.motion.next_speed(motor.axis, {}, -far, far) : 0;
    motor.axis.step(now_speed, powered(), 1);
    moves = moves || motor.motion.running();
  }
  if (state_ == State::stopping && !moves) state_ = State::released;
}

Dec Zlac8015d::speed_of(std::size_t motor, std::int64_t tenths) const {
  return divide_rounded(tenths * counts_per_rev(motor) * fine_per_count, 600'000);
}

std::int64_t Zlac8015d::tenths_of_rpm(std::size_t motor) const {
  const std::int64_t revolution = counts_per_rev(motor) * fine_per_count;
  return divide_rounded(motors_[motor].axis.actual_speed() * 600'000, std::max<std::int64_t>(revolution, 1));
}

Dec Zlac8015d::ramp_of(std::size_t motor, std::uint16_t time_register) const {
  const std::int64_t ms = std::max<std::int64_t>(held(register_of(time_register, motor)), 1);
  return std::max<Dec>(speed_of(motor, 10 * options_.ramp_speed_rpm) / ms, 1);
}

std::optional<std::int64_t> Zlac8015d::shown(std::uint16_t number) const {
  std::int64_t states = 0;
  for (const std::size_t motor : {left, right}) {
    const std::int64_t position = counts_of(motors_[motor].axis.actual());
    if (number == pair_of(ZlacAt::actual_position, motor)) return high_of(position);
    if (number == pair_of(ZlacAt::actual_position, motor) + 1) return low_of(position);
    if (number == register_of(ZlacAt::actual_speed, motor)) return tenths_of_rpm(motor);
    if (number == register_of(ZlacAt::actual_torque, motor)) return 0;
    if (number == register_of(ZlacAt::faults, motor)) return faults_[motor];
    const bool runs = motors_[motor].axis.actual_speed() != 0;
    states |= runs ? (motor == left ? 0x100 : 1) : 0;
  }
  if (number == ZlacAt::bus_voltage) return 3600;  // 0.01 V
  if (number == ZlacAt::motor_states) return states;
  if (number == ZlacAt::motor_temperatures) return 30 << 8 | 31;  // degrees, the left one's high
  return std::nullopt;
}

void Zlac8015d::written(std::uint16_t number, std::int64_t value, std::uint64_t) {
  if (numb_) return;
  if (number == ZlacAt::control_word) control(value);
  if (number == ZlacAt::set_origin || number == ZlacAt::clear_position) {
    for (const std::size_t motor : {left, right}) {
      if ((value >> motor & 1) != 0 && !motors_[motor].motion.running()) motors_[motor].axis.redefine(0);
    }
    hold(number, 0);
  }
  // What a change of mode does to motors that run is not stated; they are stopped.
  if (number == ZlacAt::operating_mode && state_ == State::enabled) stop(false);
  for (const std::size_t motor : {left, right}) {
    if (number == register_of(ZlacAt::target_speed, motor)) follow_speed(motor);
  }
}

void Zlac8015d::control(std::int64_t word) {
  switch (word) {
    case 0x05:
      if (state_ != State::enabled) return;
      stop(held(ZlacAt::quick_stop_code) != 5);
      state_ = State::quick_stopped;
      return;
    case 0x06:
      if (faulted()) state_ = State::released;
      faults_ = causes_;
      return;
    case 0x07:
      if (state_ == State::released) return;
      stop(false);
      state_ = !booting() && at_rest() ? State::released : State::stopping;
      return;
    case 0x08:
      if (faulted()) return;
      state_ = State::enabled;
      for (const std::size_t motor : {left, right}) follow_speed(motor);
      return;
    case 0x10:
      if (held(ZlacAt::synchronous) == 1) {
        start(left);
        start(right);
      }
      return;
    case 0x11:
    case 0x12:
      if (held(ZlacAt::synchronous) == 0) start(word == 0x11 ? left : right);
      return;
    default:
      return;
  }
}

void Zlac8015d::start(std::size_t motor) {
  const std::int64_t mode = held(ZlacAt::operating_mode);
  if (state_ != State::enabled || faulted() ||
      (mode != ZlacMode::relative_position && mode != ZlacMode::absolute_position))
    return;
  Motor& it = motors_[motor];
  const FinePosition travel = held_pair(pair_of(ZlacAt::target_position, motor)) * fine_per_count;
  const Id286proProfile profile{0, 0, ramp_of(motor, ZlacAt::acceleration_time),
                                ramp_of(motor, ZlacAt::deceleration_time),
                                speed_of(motor, 10 * held(register_of(ZlacAt::position_speed, motor)))};
  const bool relative = mode == ZlacMode::relative_position;
  it.motion.move(relative ? Id286proMotion::Task::relative : Id286proMotion::Task::absolute,
                 relative ? it.axis.demand() + travel : travel, profile);
}

// In speed mode a target acts as it is written.
void Zlac8015d::follow_speed(std::size_t motor) {
  if (state_ != State::enabled || faulted() || held(ZlacAt::operating_mode) != ZlacMode::speed) return;
  const std::int64_t limit = held(ZlacAt::max_speed);
  const std::int64_t rpm = std::clamp(held(register_of(ZlacAt::target_speed, motor)), -limit, limit);
  motors_[motor].motion.run(speed_of(motor, 10 * rpm), {0, 0, ramp_of(motor, ZlacAt::acceleration_time),
                                                        ramp_of(motor, ZlacAt::deceleration_time), 0});
}

void Zlac8015d::stop(bool emergency) {
  for (const std::size_t motor : {left, right}) {
    const Dec ramp =
        ramp_of(motor, emergency ? std::uint16_t{ZlacAt::emergency_time} : std::uint16_t{ZlacAt::deceleration_time});
    motors_[motor].motion.stop({0, 0, 1, ramp, 0});
  }
}

void Zlac8015d::inject_fault(std::size_t motor, std::uint16_t bits) {
  causes_.at(motor) = bits;
  if (booting()) return;
  faults_.at(motor) = bits;
  for (Motor& each : motors_) each.motion.end();
}

}  // namespace axisgate::simulated
