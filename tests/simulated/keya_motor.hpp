// SPDX-License-Identifier: Apache-2.0
// One of the two motors of a simulated Keya: what it does while enabled, and how it comes to rest when it is not.
// Promises ramps by parameters 0013 and 0030, a brake that falls 0027 after the disabling, and a move that ends exactly
// on its target. Never knows a fault word, a watchdog or a frame.
#pragma once

#include <optional>

#include "tests/simulated/axis.hpp"
#include "tests/simulated/keya_parameters.hpp"

namespace axisgate::simulated {

inline constexpr std::int64_t keya_full_scale = 10000;  // of speed and torque

class KeyaMotor {
 public:
  KeyaMotor(const KeyaParameters& parameters, KeyaMotorName name, const Mechanics& mechanics);
  KeyaMotor(const KeyaMotor&) = delete;
  KeyaMotor& operator=(const KeyaMotor&) = delete;

  void enable(KeyaMode mode);
  void disable(KeyaStop how, Time now);
  bool enabled() const { return enabled_; }
  KeyaMode mode() const { return mode_; }
  KeyaMode configured_mode() const { return configured_; }

  void run(std::int64_t value) { value_ = value; }  // speed or torque, by the mode
  // Tells whether a move begins.
  bool move_to(std::int32_t target);
  bool move_by(std::int64_t distance);
  void limit_speed(std::int64_t part) { limit_ = part; }  // of position modes, in 1/10000 of rated
  std::int64_t speed_limit() const { return limit_; }

  void step(Time at);
  bool still() const;  // and it stays so without a command

  std::int64_t value() const { return value_; }
  std::int32_t count() const { return static_cast<std::int32_t>(counts_of(axis_.actual())); }
  std::int16_t rpm() const { return static_cast<std::int16_t>(rpm_of(axis_.actual_speed(), turn_)); }
  std::uint16_t current() const;
  std::uint16_t electrical_angle() const;  // 0..1000
  std::uint16_t mechanical_angle() const;  // 0..9999
  void set_count(std::int32_t count);
  void show_current(std::optional<std::uint16_t> amperes) { shown_current_ = amperes; }
  void jam(bool jammed) { axis_.jam(jammed); }
  void fall_short(std::int64_t counts) { axis_.fall_short(counts * fine_per_count); }

 private:
  Dec wanted_speed(Time at) const;

  Mechanics mechanics_;
  KeyaMode configured_;
  KeyaMode mode_;
  std::int64_t turn_;  // counts of one
  std::int64_t most_current_;
  std::int64_t pole_pairs_;
  Dec rated_;
  Dec acceleration_;
  Dec deceleration_;
  Time brake_delay_;
  int direction_;
  Axis axis_;
  bool enabled_ = false;
  std::int64_t value_ = 0;
  std::int64_t limit_ = keya_full_scale;
  FinePosition target_ = 0;
  KeyaStop stop_ = KeyaStop::coast;
  Time brake_at_{};
  bool ramping_ = false;
  std::optional<std::uint16_t> shown_current_;
};

}  // namespace axisgate::simulated
