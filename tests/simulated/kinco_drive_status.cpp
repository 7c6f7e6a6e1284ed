// SPDX-License-Identifier: Apache-2.0
// What KincoDrive reports: statusword, inputs, outputs and measured values (JD 4.2, JD 6.2, MD B, MD 8.2).
#include <algorithm>
#include <cstdlib>

#include "tests/simulated/kinco_drive.hpp"

namespace axisgate::simulated {

using enum Cia402State;

FinePosition KincoDrive::set_position() const {
  return motion_.task() == Task::position ? motion_.target() : axis_.demand();
}

bool KincoDrive::inside_position_window() const {
  return std::abs(counts_of(set_position()) - counts_of(axis_.actual())) <= object(0x6067);
}

bool KincoDrive::target_reached() const {
  switch (mode_) {
    case 1:  // the same target, and the error inside 6067, for as long as 2508:09 (JD 4.17, MD E)
      return inside_position_window() && now_ - outside_window_at_ >= object(0x2508, 0x09) * one_millisecond;
    case 3:
    case -3: {
      const bool has_window = objects_.find({0x60F9, 0x0A}) != nullptr;
      const Dec window = has_window ? object(0x60F9, 0x0A) : speed_dec(1, encoder_counts_);
      return std::abs(axis_.actual_speed() - object(0x60FF)) <= window;
    }
    case 4:
      return true;  // the current follows its command at once here
    default:
      return false;  // 0xC037 after homing shows bits 10 and 12 clear (JD 6.2, MD 8.2)
  }
}

std::uint16_t KincoDrive::statusword() const {
  std::uint16_t word = state_bits(state_);
  if (state_ == not_ready_to_switch_on) return word;
  const auto set = [&word](std::uint16_t bit, bool on) { word = static_cast<std::uint16_t>(on ? word | bit : word); };
  set(0x4000, true);  // commutation found
  set(0x8000, homed_);
  set(0x0800, inputs_.at_positive_limit() || inputs_.at_negative_limit() || motion_.limited());
  set(0x2000, homing_error_ || (error_1_ & 0x0200) != 0);
  if (state_ != operation_enabled) return word;
  set(0x0400, target_reached());
  set(0x0200, model_.remote_bit_in_mode_3 && mode_ == 3);
  // Bit 12 follows the start bit in mode 1 (0x5037, 0xD437, 0x4437) and says "v = 0" in the speed modes (JD 6.2).
  if (mode_ == 1) set(0x1000, (controlword_ & 0x0010) != 0);
  if (mode_ == 3 || mode_ == -3) set(0x1000, axis_.actual_speed() == 0);
  return word;
}

std::uint16_t KincoDrive::outputs() const {
  const bool enabled = state_ == operation_enabled;
  const bool limit = inputs_.at_positive_limit() || inputs_.at_negative_limit();
  std::uint16_t functions = 0;  // JD 4.17, MD 6.2
  const auto set = [&functions](std::uint16_t bit, bool on) {
    functions = static_cast<std::uint16_t>(on ? functions | bit : functions);
  };
  set(0x0001, state_ != fault && state_ != not_ready_to_switch_on);
  set(0x0002, state_ == fault);
  set(0x0004, enabled && mode_ == 1 && target_reached());
  set(0x0008, enabled && axis_.actual_speed() == 0);
  set(0x0010, enabled);
  set(0x0020, enabled && (mode_ == 3 || mode_ == -3) && target_reached());
  set(0x0100, enabled);
  set(0x0200, limit);
  set(0x0400, homed_);
  std::uint16_t pins = 0;
  const auto output = [&](int number, std::uint8_t sub) {
    const auto function = static_cast<std::uint16_t>(object(0x2010, sub));
    const bool forced = ((object(0x2010, 0x0E) >> (number - 1)) & 1) != 0;
    if (forced || ((function & 0x8000) == 0 && (function & functions) != 0)) {
      pins = static_cast<std::uint16_t>(pins | (1U << (number - 1)));
    }
  };
  for (int number = 1; number <= 5; ++number) output(number, static_cast<std::uint8_t>(0x0E + number));
  output(6, 0x1E);
  output(7, 0x1F);
  return pins;
}

std::optional<std::int64_t> KincoDrive::measured(ObjectKey key) const {
  const auto in_16_bits = [](std::int64_t value) { return std::clamp<std::int64_t>(value, -32768, 32767); };
  const Dec speed = axis_.told_speed();
  switch (key.index << 8 | key.sub) {
    case 0x604000:
      return heard_controlword();
    case 0x604100:
      return statusword();
    case 0x606100:
      return mode_;
    case 0x606300:
      return position();
    case 0x606C00:
      return model_.speed_reading == SpeedReading::dec ? speed : in_16_bits(sampled_rpm_);
    case 0x60F919:
      return in_16_bits(rpm_of(speed, encoder_counts_, 100));
    case 0x60F91A:
      return in_16_bits(counts_of(speed));
    case 0x60F91C:
      return object(0x60FF) - speed;
    case 0x60FB08:
      return axis_.following_error();
    case 0x607800:
    case 0x60F60C:
    case 0x60F617:
      return current_;
    case 0x60FD00:
      return inputs_.input_state();
    case 0x20100A:
      return inputs_.pins();
    case 0x201014:
      return outputs();
    case 0x260100:
      return error_1_;
    case 0x260200:
      return error_2_;
    case 0x2FF700:
      return now_ / std::chrono::seconds(1);
    default:
      return std::nullopt;
  }
}

}  // namespace axisgate::simulated
