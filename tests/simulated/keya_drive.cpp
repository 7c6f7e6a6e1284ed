// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/keya_drive.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::simulated {
namespace {

// "Automatic when normal" (9): these go with their cause; the next ones with their cause and a disabling.
constexpr std::uint16_t goes_by_itself = 0x2412;
constexpr std::uint16_t goes_by_disabling = 0x0AE0;
constexpr std::uint16_t goes_by_enabling = keya_fault::can_loss | keya_fault::rs232_loss;

KeyaMotorName other(KeyaMotorName motor) { return motor == KeyaMotorName::a ? KeyaMotorName::b : KeyaMotorName::a; }

bool positions(KeyaMode mode) { return mode == KeyaMode::absolute || mode == KeyaMode::relative; }

}  // namespace

KeyaDrive::KeyaDrive(const KeyaOptions& options, KeyaInterface plugged)
    : options_(options),
      parameters_(options, plugged),
      motors_{KeyaMotor(parameters_, KeyaMotorName::a, options.mechanics),
              KeyaMotor(parameters_, KeyaMotorName::b, options.mechanics)} {
  measured_.version = options.version;
}

std::uint16_t KeyaDrive::faults(KeyaMotorName motor) const {
  return static_cast<std::uint16_t>(words_[number(motor)] | (enabled(motor) ? 0 : keya_fault::disabled));
}

std::array<std::uint8_t, 2> KeyaDrive::control_state() const {
  const auto feedback = static_cast<std::uint8_t>(parameters_.get(22) & 0xF);
  return {static_cast<std::uint8_t>(parameters_.get(19) << 4 | feedback),
          static_cast<std::uint8_t>(static_cast<unsigned>(at(KeyaMotorName::a).mode()) << 4)};
}

void KeyaDrive::switch_on(KeyaMotorName motor, std::optional<KeyaMode> mode) {
  const std::size_t n = number(motor);
  words_[n] = static_cast<std::uint16_t>(words_[n] & ~(goes_by_enabling & ~causes_[n]));
  if (words_[n] != 0 || numb_) return;  // acknowledged, and it stays disabled
  if (locked_out_ && !enabled(motor)) {
    asked_on_[n] = true;
    asked_mode_[n] = mode;
    return;
  }
  const bool was = enabled(motor);
  const KeyaMode before = at(motor).mode();
  at(motor).enable(mode.value_or(was ? before : at(motor).configured_mode()));
  if (was && at(motor).mode() == before) return;
  given_[n] = 0;
  last_move_[n].reset();
}

void KeyaDrive::lock(bool locked) {
  locked_out_ = locked;
  for (const KeyaMotorName motor : keya_motors)
    if (!locked && std::exchange(asked_on_[number(motor)], false)) switch_on(motor, asked_mode_[number(motor)]);
}

void KeyaDrive::switch_off(KeyaMotorName motor, KeyaStop how) {
  if (numb_) return;
  asked_on_[number(motor)] = false;
  at(motor).disable(how, stepped_);
  given_[number(motor)] = 0;
}

void KeyaDrive::enable(KeyaMotorName motor, std::optional<KeyaMode> mode, Time now) {
  advance(now);
  feed(now);
  switch_on(motor, mode);
  if (parameters_.mixed() && motor == KeyaMotorName::a) switch_on(KeyaMotorName::b, mode);
}

void KeyaDrive::disable(KeyaMotorName motor, Time now) {
  advance(now);
  feed(now);
  for (const KeyaMotorName it : keya_motors) {
    if (it != motor && !(parameters_.mixed() && motor == KeyaMotorName::a)) continue;
    switch_off(it, KeyaStop::coast);
    std::uint16_t& word = words_[number(it)];
    word = static_cast<std::uint16_t>(word & ~(goes_by_disabling & ~causes_[number(it)]));
  }
  drive_motors();
}

void KeyaDrive::reset_faults(KeyaMotorName motor, Time now) {
  disable(motor, now);
  std::uint16_t& word = words_[number(motor)];
  word = static_cast<std::uint16_t>(word & ~(goes_by_enabling & ~causes_[number(motor)]));
}

void KeyaDrive::zero_count(KeyaMotorName motor, Time now) {
  advance(now);
  feed(now);
  at(motor).set_count(0);
}

bool KeyaDrive::set_value(KeyaMotorName motor, std::int64_t value, std::optional<KeyaMode> for_mode, Time now) {
  const bool whole = for_mode ? positions(*for_mode) : positions(at(motor).mode());
  if (!whole && (value < -keya_full_scale || value > keya_full_scale)) return false;
  advance(now);
  feed(now);
  const KeyaMode mode = at(motor).mode();
  const bool fits = !for_mode || (positions(mode) ? positions(*for_mode) : mode == *for_mode);
  if (fits) take_value(motor, value);
  return true;
}

void KeyaDrive::take_value(KeyaMotorName motor, std::int64_t value) {
  if (!enabled(motor) || numb_) return;
  const std::size_t n = number(motor);
  switch (at(motor).mode()) {
    case KeyaMode::speed:
    case KeyaMode::torque:
      given_[n] = std::clamp(value, -keya_full_scale, keya_full_scale);
      drive_motors();
      break;
    case KeyaMode::absolute:
      if (at(motor).move_to(static_cast<std::int32_t>(value))) ++moves_[n];
      break;
    case KeyaMode::relative:
      if (!options_.repeated_move_moves && last_move_[n] == value) break;
      last_move_[n] = value;
      if (at(motor).move_by(value)) ++moves_[n];
      break;
  }
}

// Motor 1 = clamp(g1 + g2), motor 2 = clamp(g1 - g2) in mixed mode (8.6).
void KeyaDrive::drive_motors() {
  std::array<std::int64_t, 2> executed = given_;
  if (parameters_.mixed()) executed = {given_[0] + given_[1], given_[0] - given_[1]};
  for (const KeyaMotorName motor : keya_motors) {
    if (enabled(motor)) at(motor).run(std::clamp(executed[number(motor)], -keya_full_scale, keya_full_scale));
  }
}

void KeyaDrive::set_both(std::uint8_t code, std::array<std::int32_t, 2> values, Time now) {
  advance(now);
  std::array<bool, 2> was{};
  for (const KeyaMotorName motor : keya_motors) was[number(motor)] = enabled(motor);
  if (code == 0) {
    disable(KeyaMotorName::a, now);
    disable(KeyaMotorName::b, now);
    --controls_;  // one frame
    return;
  }
  feed(now);
  const bool both = parameters_.mixed() && (code & 1) != 0;
  for (const KeyaMotorName motor : keya_motors) {
    const bool wanted = both || (code >> number(motor) & 1) != 0;
    if (wanted) {
      switch_on(motor, std::nullopt);
    } else if (options_.code_disables_other) {
      switch_off(motor, KeyaStop::coast);
    }
  }
  for (const KeyaMotorName motor : keya_motors) {
    const std::size_t n = number(motor);
    const bool plain_enable = !was[n] && values[n] == 0 && at(motor).mode() == KeyaMode::absolute;
    if (!plain_enable || options_.enable_with_zero_moves) take_value(motor, values[n]);
  }
}

std::uint16_t KeyaDrive::loss_bit() const {
  switch (parameters_.interface_in_force()) {
    case KeyaInterface::can:
    case KeyaInterface::canopen:
      return keya_fault::can_loss;
    case KeyaInterface::rs232:
      return keya_fault::rs232_loss;
    default:
      return 0;  // none is stated for RS485 (5.1)
  }
}

void KeyaDrive::watch(Time at) {
  if (!(enabled(KeyaMotorName::a) || enabled(KeyaMotorName::b)) || loss_bit() == 0) return;
  if (at - last_control_.value_or(Time{}) <= watchdog_time) return;
  ++trips_;
  for (const KeyaMotorName motor : keya_motors) {
    switch_off(motor, options_.loss_stop);
    words_[number(motor)] |= loss_bit();
  }
}

bool KeyaDrive::quiet() const {
  if (boot_until_ || !at(KeyaMotorName::a).still() || !at(KeyaMotorName::b).still()) return false;
  return !(enabled(KeyaMotorName::a) || enabled(KeyaMotorName::b)) || loss_bit() == 0;
}

void KeyaDrive::advance(Time now) {
  while (stepped_ + one_millisecond <= now) {
    if (quiet()) {
      stepped_ = now / one_millisecond * one_millisecond;
      return;
    }
    stepped_ += one_millisecond;
    step(stepped_);
  }
  watch(now);
}

void KeyaDrive::step(Time at_time) {
  if (boot_until_ && at_time >= *boot_until_) boot_until_.reset();
  watch(at_time);
  for (KeyaMotor& motor : motors_) motor.step(at_time);
}

void KeyaDrive::inject_fault(KeyaMotorName motor, std::uint16_t bits) {
  const auto real = static_cast<std::uint16_t>(bits & ~keya_fault::disabled);
  causes_[number(motor)] |= real;
  words_[number(motor)] |= real;
  switch_off(motor, KeyaStop::coast);
  if (!parameters_.mixed()) return;
  words_[number(other(motor))] |= keya_fault::mixed_mode;
  switch_off(other(motor), KeyaStop::coast);
}

void KeyaDrive::clear_fault_cause(KeyaMotorName motor, std::uint16_t bits) {
  const std::size_t n = number(motor);
  causes_[n] = static_cast<std::uint16_t>(causes_[n] & ~bits);
  words_[n] = static_cast<std::uint16_t>(words_[n] & ~(bits & goes_by_itself));
}

void KeyaDrive::restart(Time now) {
  advance(now);
  ++restarts_;
  for (const KeyaMotorName motor : keya_motors) {
    switch_off(motor, KeyaStop::coast);
    words_[number(motor)] = causes_[number(motor)];
    last_move_[number(motor)].reset();
    at(motor).limit_speed(keya_full_scale);
    if (!options_.keeps_counts) at(motor).set_count(0);
  }
  last_control_.reset();
  boot_until_ = now + options_.boot_time;
  if (options_.boot_time <= Time{}) boot_until_.reset();
}

}  // namespace axisgate::simulated
