// SPDX-License-Identifier: Apache-2.0
// A drive of two motors behind one controlword, as wheel drives have it, made up from CiA 402: one mode, the two
// statuswords in one object, a target velocity each, and two torque limits in one object. Promises that what is written
// acts at once, and that a motor gets faster and slower on a ramp. Never reads a clock and never sees a frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

class PairDrive {
 public:
  enum class State : std::uint8_t { disabled, ready, switched_on, enabled, quick_stop, fault };
  struct Motor {
    State state = State::disabled;
    double speed = 0;         // 0.1 rpm
    std::int32_t target = 0;  // 60FFh
    double position = 0;      // 4096 a turn
    int enables = 0;          // how often it got torque
    bool fails_again = false;
  };

  struct Object {
    std::uint16_t index;
    std::uint8_t sub;
  };
  std::uint8_t size_of(Object object) const;  // 0: there is no such object
  std::uint32_t read(Object object) const;
  void write(Object object, std::uint32_t value);
  void advance(Time now);
  void fail(std::size_t motor);

  std::array<Motor, 2> motors{};
  std::uint16_t limits = 0x3264;  // A 100 %, B 50 %
  std::int8_t mode = 3;
  std::uint16_t word = 0;

 private:
  static std::uint16_t statusword(const Motor& motor);
  void obey(Motor& motor, std::uint16_t rising);

  Time now_{};
};

}  // namespace axisgate::simulated
