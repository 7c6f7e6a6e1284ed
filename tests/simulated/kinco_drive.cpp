// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/kinco_drive.hpp"

#include <algorithm>

namespace axisgate::simulated {
namespace {

constexpr ObjectKey station_number{0x100B, 0x00};
constexpr ObjectKey cascade_switch{0x6510, 0x0B};
constexpr ObjectKey rs485_protocol{0x6510, 0x0C};
constexpr ObjectKey store_command{0x2FF0, 0x01};
constexpr ObjectKey store_motor_command{0x2FF0, 0x03};

// Baud codes are 10368000 / baud (JD 2.0, MD 2.1).
std::uint32_t baud_of(std::int64_t code) { return code > 0 ? static_cast<std::uint32_t>(10368000 / code) : 0; }

// The functions that keep a bus from enabling and moving the drive (JD 1.4 points 1 and 2; MD 4.5, last line).
bool blocks_the_bus(std::int64_t function) {
  return (function & 0x8000) == 0 && (function & (0x0001 | 0x0004 | 0x0010 | 0x0020)) != 0;
}

}  // namespace

KincoDrive::KincoDrive(const DriveOptions& options)
    : options_(options),
      model_(model_of(options.type)),
      encoder_counts_(options.encoder_counts != 0 ? options.encoder_counts : model_.encoder_counts),
      objects_(model_.motion_objects, model_.setup_objects, options.out_of_range.value_or(model_.out_of_range)),
      inputs_(model_.digital_inputs),
      axis_(options_.mechanics, encoder_counts_) {
  objects_.set_stored(station_number, options_.station);
  objects_.set_stored(cascade_switch, options_.cascade ? 1 : 0);
  if (options_.rs485_modbus && objects_.find(rs485_protocol) != nullptr) objects_.set_stored(rs485_protocol, 0);
  for (int input = 1; !options_.factory_fresh && input <= model_.digital_inputs; ++input) {
    const ObjectKey key = input_function_object(input);
    const bool limit = (objects_.get(key) & (0x0010 | 0x0020)) != 0;
    const bool wired = limit && (options_.mechanics.positive_limit || options_.mechanics.negative_limit);
    if (blocks_the_bus(objects_.get(key)) && !wired) objects_.set_stored(key, 0);
  }
  power_up();
}

void KincoDrive::power_up() {
  objects_.power_up();
  // Communication settings act from the stored values after a restart only (JD 2.0, MD 3.1).
  station_ = static_cast<std::uint8_t>(object(station_number.index));
  cascade_ = objects_.get(cascade_switch) == 1;
  rs232_baud_ = baud_of(object(0x2FE0));
  rs485_speaks_kinco_ = model_.rs485_speaks_this_protocol && object(0x6510, 0x0C) == 1;
  locked_ = object(0x2FFD) != 0;
  controlword_ = 0;
  torque_command_ = 0;
  error_1_ = cause_1_;
  error_2_ = cause_2_;
  reference_found_ = homing_error_ = false;
  mode_ = object(0x6060);
  inputs_.configure(objects_);
  inputs_.follow(options_.mechanics, axis_.physical());
  refresh_settings();
  // JD: an incremental encoder counts from 0. MD: the encoder knows its place in one turn (MD 12.12).
  const FinePosition turn = encoder_counts_ * fine_per_count;
  const FinePosition in_turn = ((axis_.physical() % turn) + turn) % turn;
  axis_.redefine(model_.keeps_single_turn_position ? in_turn : 0);
  axis_.forget_demand();
  change_state(Cia402State::switch_on_disabled, 0);
  if (error_1_ != 0 || error_2_ != 0) raise_fault(error_1_, error_2_);
  scan_inputs();
  // Auto-enable and home at power-on act without any request: JD 4.1 (2000:00), MD F (6099.03).
  const bool home_at_power_on = object(0x6099, 0x03) == 1;
  if ((object(0x2000) == 1 || home_at_power_on) && !inputs_.has(InputFunction::drive_enable)) {
    take_controlword(0x000F, 0);
    if (home_at_power_on) {
      objects_.set({0x6060, 0}, 6);
      set_mode(6);
      take_controlword(0x001F, 0);
    }
  }
}

void KincoDrive::restart(Time now) {
  advance(now);
  ++restarts_;
  store_until_.reset();  // a store under way is lost with the power
  boot_until_ = now + options_.boot_time;
  pending_.reset();
  motion_.coast();
  halted_.reset();
  change_state(Cia402State::not_ready_to_switch_on, 0);
}

void KincoDrive::begin_store(Keep what) {
  store_what_ = what;
  store_until_ = now_ + options_.store_time;
}

bool KincoDrive::quiescent() const {
  return !boot_until_ && !store_until_ && !pending_ && !halted_ && sampled_rpm_ == 0 && motion_.at_rest(axis_) &&
         axis_.demand() == axis_.actual();
}

void KincoDrive::advance(Time now) {
  const std::int64_t until = now / one_millisecond;
  while (ticks_ < until) {
    // A drive at rest has nothing to compute; only its inputs are looked at, once.
    ticks_ = quiescent() ? until : ticks_ + 1;
    tick(ticks_ * one_millisecond);
  }
  now_ = std::max(now_, now);
  if (boot_until_ && now_ >= *boot_until_) {
    boot_until_.reset();
    power_up();
  }
}

void KincoDrive::tick(Time at) {
  now_ = at;
  if (boot_until_ && at >= *boot_until_) {
    boot_until_.reset();
    power_up();
  }
  if (store_until_ && at >= *store_until_) {
    store_until_.reset();
    objects_.set(store_what_ == Keep::eeprom ? store_command : store_motor_command, 0);
    objects_.store(store_what_);
    ++stores_;
  }
  inputs_.follow(options_.mechanics, axis_.physical());
  if (!boot_until_) scan_inputs();

  const Dec before = axis_.speed();
  const Dec speed = motion_.next_speed(axis_, inputs_, settings_);
  const int direction = object(0x607E) == 1 ? -1 : 1;
  axis_.step(speed, motion_.position_loop(), direction);
  const Dec full = std::max<Dec>(acceleration_dec(options_.mechanics.rps_per_s_at_full_current, encoder_counts_), 1);
  current_ = motion_.task() == Task::coast ? 0 : std::clamp<Dec>((axis_.speed() - before) * 2048 / full, -2048, 2047);
  if (motion_.task() == Task::torque) current_ = torque_command_;

  if (!boot_until_) {
    follow_motion();
    supervise();
  }
  if (!inside_position_window()) outside_window_at_ = at;
  // 606C of the JD is sampled each 200 ms (JD 4.2).
  if (ticks_ % 200 == 0) sampled_rpm_ = rpm_of(axis_.actual_speed(), encoder_counts_);
}

void KincoDrive::scan_inputs() {
  const bool reset = inputs_.active(InputFunction::fault_reset);
  if (reset && !reset_input_) reset_fault(0);
  reset_input_ = reset;
  if (inputs_.has(InputFunction::mode_control)) {
    const std::uint8_t choice = inputs_.active(InputFunction::mode_control) ? 0x0E : 0x0D;
    objects_.set({0x6060, 0}, object(0x2020, choice));
    set_mode(object(0x2020, choice));
  }
  if (inputs_.has(InputFunction::drive_enable)) {
    // The input forces the controlword to 2020:0F or to 0x06 (MD A).
    const bool enable = inputs_.active(InputFunction::drive_enable);
    const auto word = static_cast<std::uint16_t>(enable ? object(0x2020, 0x0F) : 0x0006);
    if (word != controlword_) take_controlword(word, 0);
  }
  if (inputs_.active(InputFunction::emergency_stop) && operating()) obey(Cia402Command::quick_stop, 0);
}

void KincoDrive::follow_motion() {
  if (pending_ && axis_.speed() == 0) {
    const Cia402State to = *pending_;
    pending_.reset();
    change_state(to, 0);
    return;
  }
  if (motion_.task() != Task::homing) return;
  switch (motion_.homing()->outcome()) {
    case HomingRun::Outcome::running:
      return;
    case HomingRun::Outcome::reference_found:
      axis_.redefine(motion_.homing()->final_position());
      reference_found_ = true;
      break;
    case HomingRun::Outcome::failed:
      homing_error_ = true;
      break;
  }
  motion_.hold(axis_);
}

void KincoDrive::supervise() {
  const std::int64_t largest = object(0x6065);
  const std::int64_t error = axis_.following_error();
  if (operating() && motion_.task() != Task::homing && largest > 0 && (error > largest || error < -largest)) {
    raise_fault(0x0200, 0);  // bit 9: JD 7, MD 9
  }
  // Limits after homing are an alarm only where 2010.19 asks for it (MD E, MD 9 word 2).
  if (model_.has_error_word_2 && reference_found_ && object(0x2010, 0x19) == 0) {
    if (inputs_.at_positive_limit()) raise_fault(0, 0x0200);
    if (inputs_.at_negative_limit()) raise_fault(0, 0x0400);
  }
}

void KincoDrive::inject_fault(int error_word, std::uint16_t bits) {
  (error_word == 1 ? cause_1_ : cause_2_) |= bits;
  if (!boot_until_) raise_fault(error_word == 1 ? bits : 0, error_word == 1 ? 0 : bits);
}

void KincoDrive::clear_fault_cause(int error_word, std::uint16_t bits) {
  auto& cause = error_word == 1 ? cause_1_ : cause_2_;
  cause = static_cast<std::uint16_t>(cause & ~bits);
}

}  // namespace axisgate::simulated
