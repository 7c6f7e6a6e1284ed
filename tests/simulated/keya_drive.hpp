// SPDX-License-Identifier: Apache-2.0
// One simulated Keya KYDAS4860-2E: two motors, their fault words, the watchdog over both, what can be measured.
// Promises the same answers for the same commands at the same times, whatever interface they came by, and a count of
// what a test asks about: commands heard, moves begun, expiries of the watchdog.
// Never reads a clock, never draws a random number, and never sees a frame: KeyaCan, KeyaCanopen and KeyaLine do.
#pragma once

#include <array>

#include "tests/simulated/keya_motor.hpp"

namespace axisgate::simulated {

inline constexpr std::array<KeyaMotorName, 2> keya_motors{KeyaMotorName::a, KeyaMotorName::b};

// Bits of a fault word (9).
namespace keya_fault {
inline constexpr std::uint16_t disabled = 0x0001;
inline constexpr std::uint16_t mixed_mode = 0x0200;
inline constexpr std::uint16_t can_loss = 0x4000;
inline constexpr std::uint16_t rs232_loss = 0x8000;
}  // namespace keya_fault

// What the drive measures beside its motors' motion.
struct KeyaMeasured {
  std::uint8_t voltage = 48;
  std::int16_t temperature = 33;
  std::array<std::int16_t, 2> motor_temperature{25, 26};
  std::uint32_t version = 20220313;
};

class KeyaDrive {
 public:
  static constexpr Time watchdog_time = std::chrono::milliseconds(1000);

  // Throws std::invalid_argument for parameters that the drive does not have.
  KeyaDrive(const KeyaOptions& options, KeyaInterface plugged);
  KeyaDrive(const KeyaDrive&) = delete;
  KeyaDrive& operator=(const KeyaDrive&) = delete;

  // Control commands: each feeds the watchdog, also one that changes nothing.
  void enable(KeyaMotorName motor, std::optional<KeyaMode> mode, Time now);
  void disable(KeyaMotorName motor, Time now);
  void reset_faults(KeyaMotorName motor, Time now);  // and disables
  void zero_count(KeyaMotorName motor, Time now);
  // A value for the mode in force; `for_mode` where the command names one, and then it must be that. False: out of
  // range. A disabled motor, or one in another mode, ignores it.
  bool set_value(KeyaMotorName motor, std::int64_t value, std::optional<KeyaMode> for_mode, Time now);
  // A frame that carries the enabling of both motors and both values (serial).
  void set_both(std::uint8_t code, std::array<std::int32_t, 2> values, Time now);
  void feed(Time now) { last_control_ = now, ++controls_; }
  void heard_query(Time now) {
    if (options_.queries_feed_watchdog) last_control_ = now;
  }
  // In position mode, 1/10000 of rated.
  void limit_speed(KeyaMotorName motor, std::int64_t part) { at(motor).limit_speed(part); }

  void advance(Time now);
  void restart(Time now);  // the power goes and comes back
  bool booting() const { return boot_until_.has_value(); }

  // What a world does to it. A fault disables its motor and stays until its cause is cleared, and longer where the
  // manual wants a reset.
  void inject_fault(KeyaMotorName motor, std::uint16_t bits);
  void clear_fault_cause(KeyaMotorName motor, std::uint16_t bits);
  // A contact in the way of the torque of both motors: an enable is acknowledged, and is carried out when the contact
  // closes, if no disable came since.
  void lock(bool locked);
  // It acknowledges and carries nothing out.
  void numb(bool numb) { numb_ = numb; }
  KeyaMeasured& measured() { return measured_; }
  KeyaMotor& at(KeyaMotorName motor) { return motors_[static_cast<std::size_t>(motor)]; }

  // What a world looks at.
  const KeyaOptions& options() const { return options_; }
  const KeyaParameters& parameters() const { return parameters_; }
  const KeyaMeasured& measured() const { return measured_; }
  const KeyaMotor& at(KeyaMotorName motor) const { return motors_[static_cast<std::size_t>(motor)]; }
  // The interface that commands come by is the one of 0019.
  bool obeys(KeyaInterface from) const { return parameters_.interface_in_force() == from; }
  std::uint16_t faults(KeyaMotorName motor) const;
  bool enabled(KeyaMotorName motor) const { return at(motor).enabled(); }
  // Control state: interface and feedback, working mode of motor A (4.4).
  std::array<std::uint8_t, 2> control_state() const;
  std::optional<Time> last_control() const { return last_control_; }
  std::uint64_t controls() const { return controls_; }
  std::uint64_t trips() const { return trips_; }
  std::uint64_t moves(KeyaMotorName motor) const { return moves_[static_cast<std::size_t>(motor)]; }
  std::uint64_t restarts() const { return restarts_; }

 private:
  static std::size_t number(KeyaMotorName motor) { return static_cast<std::size_t>(motor); }
  void switch_on(KeyaMotorName motor, std::optional<KeyaMode> mode);
  void switch_off(KeyaMotorName motor, KeyaStop how);
  void take_value(KeyaMotorName motor, std::int64_t value);
  void drive_motors();
  std::uint16_t loss_bit() const;
  void watch(Time at);
  void step(Time at);
  bool quiet() const;

  const KeyaOptions options_;
  const KeyaParameters parameters_;
  std::array<KeyaMotor, 2> motors_;
  KeyaMeasured measured_;
  std::array<std::uint16_t, 2> words_{};   // of faults, bit 0 aside
  std::array<std::uint16_t, 2> causes_{};  // that are still there
  std::array<std::int64_t, 2> given_{};    // speeds or torques as commanded, before mixing
  std::array<std::optional<std::int64_t>, 2> last_move_{};
  bool locked_out_ = false;
  bool numb_ = false;
  std::array<bool, 2> asked_on_{};  // while locked out
  std::array<std::optional<KeyaMode>, 2> asked_mode_{};
  std::array<std::uint64_t, 2> moves_{};
  std::optional<Time> last_control_;
  std::optional<Time> boot_until_;
  std::uint64_t controls_ = 0;
  std::uint64_t trips_ = 0;
  std::uint64_t restarts_ = 0;
  Time stepped_{};
};

}  // namespace axisgate::simulated
