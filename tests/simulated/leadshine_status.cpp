// SPDX-License-Identifier: Apache-2.0
// What LeadshineDrive reports: statusword, inputs and measured values (3.4, 3.5, 5.2).
#include <algorithm>
#include <cstdlib>

#include "tests/simulated/leadshine_drive.hpp"

namespace axisgate::simulated {
namespace {

using enum Cia402State;

constexpr std::uint16_t ready_to_start = 0x0020;

}  // namespace

bool LeadshineDrive::target_reached() const {
  if (halted_) return axis_.speed() == 0;
  switch (mode_) {
    case 1: {
      if (now_ < reached_until_) return true;
      const bool commanded = motion_.task() == Task::position && motion_.target() != axis_.demand();
      return !commanded && std::abs(units_of(axis_.demand() - axis_.actual())) <= object(0x2431);
    }
    case 3: {
      const Dec width = speed_dec(object(0x2435), options_.encoder_counts);
      return std::abs(axis_.actual_speed() - speed_of(object(0x60FF))) <= width;
    }
    case 4:
      return torque_demand_ / 1000 == object(0x6071);
    case 6:
      return motion_.task() != Task::homing && axis_.speed() == 0;
    default:
      return false;
  }
}

std::uint16_t LeadshineDrive::statusword() const {
  std::uint16_t word = state_bits(state_);
  if (state_ == not_ready_to_switch_on) return word;
  const auto set = [&word](std::uint16_t bit, bool on) { word = static_cast<std::uint16_t>(on ? word | bit : word); };
  set(0x0200, true);  // remote
  set(0x0800, inputs_.at_positive_limit() || inputs_.at_negative_limit() || motion_.limited());
  if (mode_ == 6) {
    set(0x1000, homed_);
    set(0x2000, homing_error_);
  }
  if (state_ != operation_enabled) return word;
  set(0x0400, target_reached());
  set(0x0100, (mode_ == 1 || mode_ == 6) && motion_.limited());
  if (mode_ == 3) set(0x1000, axis_.actual_speed() == 0);
  if (mode_ == 1) {
    set(0x1000, options_.acknowledges_setpoints && (controlword_ & 0x0010) != 0);
    set(0x2000, now_ - inside_following_window_ > object(0x6066) * one_millisecond);
  }
  return word;
}

std::uint32_t LeadshineDrive::input_word() const {
  const auto levels = inputs_.effective();
  std::uint32_t word = static_cast<std::uint32_t>(levels) << 4;
  if (inputs_.at_negative_limit()) word |= 1U;
  if (inputs_.at_positive_limit()) word |= 2U;
  if (inputs_.active(InputFunction::home_switch)) word |= 4U;
  if (inputs_.active(InputFunction::emergency_stop)) word |= 1U << 23;
  if (state_ == operation_enabled && target_reached()) word |= 1U << 24;
  return word;
}

std::int64_t LeadshineDrive::torque_actual() const {
  if (motion_.task() == Task::coast) return 0;
  if (motion_.task() == Task::torque) return torque_demand_ / 1000;
  const Dec full = full_acceleration();
  return std::clamp<std::int64_t>(last_step_ * full_torque / std::max<Dec>(full, 1), -full_torque, full_torque);
}

std::optional<std::int64_t> LeadshineDrive::measured(ObjectKey key) const {
  switch (key.index << 8 | key.sub) {
    case 0x300100: {
      const bool ready = options_.ready_flag && mode_ == 1 && operating() && (controlword_ & 0x0030) == 0x0020;
      return ready ? ready_to_start : 0;
    }
    case 0x301000:
      return error_ == 0 ? 0 : leadshine_alarm(error_).alarm;
    case 0x603F00:
      return error_;
    case 0x604000:
      return heard_controlword();
    case 0x604100:
      return statusword();
    case 0x606100:
      return mode_;
    case 0x606200:
      return static_cast<std::int32_t>(units_of(axis_.demand()));
    case 0x606300:
      return static_cast<std::int32_t>(counts_of(axis_.actual()));
    case 0x606400:
      return position();
    case 0x606B00:
      return units_per_s_of(axis_.speed());
    case 0x606C00:
      return units_per_s_of(axis_.told_speed());
    case 0x607400:
      return torque_demand_ / 1000;
    case 0x607700:
      return torque_actual();
    case 0x60F400:
      return units_of(axis_.following_error() * fine_per_count);
    case 0x60FA00:
      return units_per_s_of(axis_.speed());
    case 0x60FC00:
      return static_cast<std::int32_t>(counts_of(axis_.demand()));
    case 0x60FD00:
      return input_word();
    default:
      return monitored(key);
  }
}

std::optional<std::int64_t> LeadshineDrive::monitored(ObjectKey key) const {
  const std::int64_t counts = counts_of(axis_.actual());
  switch (key.index << 8 | key.sub) {
    case 0x550003:
      return static_cast<std::int32_t>(counts);
    case 0x550004:
      return static_cast<std::int32_t>(counts >> 32);
    case 0x550005:
      return static_cast<std::int32_t>(units_of(axis_.actual()));
    case 0x550006:
      return static_cast<std::int32_t>(units_of(axis_.actual()) >> 32);
    case 0x550101:
      return rpm_of(axis_.actual_speed(), options_.encoder_counts);
    case 0x550102:
      return rpm_of(axis_.speed(), options_.encoder_counts);
    case 0x550104:
      return torque_actual();
    case 0x550105:
      return torque_demand_ / 1000;
    case 0x550106:
      return axis_.following_error();
    case 0x550207:
      return now_ / std::chrono::seconds(1);
    default:
      return std::nullopt;
  }
}

}  // namespace axisgate::simulated
