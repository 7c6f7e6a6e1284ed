// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/pair_drive.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace axisgate::simulated {
namespace {

constexpr double kRamp = 30'000;          // 0.1 rpm in a second
constexpr double kCounts = 4096 / 600.0;  // counts a second of 0.1 rpm
constexpr std::uint16_t kHalt = 0x100, kReset = 0x80;

}  // namespace

std::uint8_t PairDrive::size_of(Object object) const {
  switch (object.index) {
    case 0x6040:
    case 0x2072:
      return 2;
    case 0x6041:
      return 4;
    case 0x6060:
    case 0x6061:
      return 1;
    case 0x6064:
    case 0x606C:
    case 0x60FF:
      return object.sub == 1 || object.sub == 2 ? 4 : 0;
    default:
      return 0;
  }
}

std::uint16_t PairDrive::statusword(const Motor& motor) {
  constexpr std::array<std::uint16_t, 6> kWords{0x40, 0x21, 0x23, 0x27, 0x07, 0x08};
  return kWords.at(static_cast<std::size_t>(motor.state));
}

std::uint32_t PairDrive::read(Object object) const {
  const auto whole = [](double value) { return static_cast<std::uint32_t>(std::lround(value)); };
  switch (object.index) {
    case 0x6040:
      return word;
    case 0x6041:
      return std::uint32_t{statusword(motors[1])} << 16 | statusword(motors[0]);
    case 0x6064:
      return whole(motors.at(object.sub - 1U).position);
    case 0x606C:
      return whole(motors.at(object.sub - 1U).speed);
    case 0x60FF:
      return static_cast<std::uint32_t>(motors.at(object.sub - 1U).target);
    case 0x2072:
      return limits;
    default:
      return static_cast<std::uint8_t>(mode);
  }
}

void PairDrive::write(Object object, std::uint32_t value) {
  if (object.index == 0x60FF) motors.at(object.sub - 1U).target = static_cast<std::int32_t>(value);
  if (object.index == 0x2072) limits = static_cast<std::uint16_t>(value);
  if (object.index == 0x6060) mode = static_cast<std::int8_t>(value);
  if (object.index != 0x6040) return;
  const auto rising = static_cast<std::uint16_t>(value & ~std::uint32_t{word});
  word = static_cast<std::uint16_t>(value);
  for (Motor& motor : motors) obey(motor, rising);
}

void PairDrive::obey(Motor& motor, std::uint16_t rising) {
  if (motor.state == State::fault) {
    if ((rising & kReset) != 0 && !motor.fails_again) motor.state = State::disabled;
    return;
  }
  const unsigned request = word & 0x0FU;
  const bool has_torque = motor.state == State::enabled || motor.state == State::quick_stop;
  if ((request & 2) == 0) {
    motor.state = State::disabled;
  } else if ((request & 4) == 0) {
    motor.state = has_torque ? State::quick_stop : State::disabled;
  } else if (request == 6 && motor.state != State::quick_stop) {
    motor.state = State::ready;
  } else if (request == 7 && motor.state != State::disabled && motor.state != State::quick_stop) {
    motor.state = State::switched_on;
  } else if (request == 15 && motor.state == State::switched_on) {
    motor.state = State::enabled;
    ++motor.enables;
  }
}

void PairDrive::advance(Time now) {
  const double passed = std::chrono::duration<double>(now - now_).count();
  now_ = now;
  for (Motor& motor : motors) {
    const bool follows = motor.state == State::enabled && (word & kHalt) == 0 && mode == 3;
    const double wanted = follows ? motor.target : 0;
    motor.speed += std::clamp(wanted - motor.speed, -kRamp * passed, kRamp * passed);
    motor.position += motor.speed * kCounts * passed;
    if (motor.state == State::quick_stop && motor.speed == 0) motor.state = State::disabled;
  }
}

void PairDrive::fail(std::size_t motor) { motors.at(motor).state = State::fault; }

}  // namespace axisgate::simulated
