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

Cia402Facts facts_of(const DriveOptions& options) {
  const KincoModel& model = model_of(options.type);
  return {.encoder_counts = options.encoder_counts != 0 ? options.encoder_counts : model.encoder_counts,
          .inputs = model.digital_inputs,
          .boot_time = options.boot_time,
          .store_time = options.store_time,
          .fault_reset_word = model.fault_reset_word,
          .needs_shutdown_first = options.needs_shutdown_first,
          .shutdown_leaves_quick_stop = true,
          .stands_released_at_once = false,
          .takes_new_speed_while_on = true};
}

ObjectDictionary objects_of(const DriveOptions& options) {
  const KincoModel& model = model_of(options.type);
  return {model.motion_objects, model.setup_objects, options.out_of_range.value_or(model.out_of_range)};
}

}  // namespace

KincoDrive::KincoDrive(const DriveOptions& options)
    : Cia402Drive(facts_of(options), options.mechanics, objects_of(options)),
      options_(options),
      model_(model_of(options.type)),
      encoder_counts_(facts_.encoder_counts) {
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
  homed_ = homing_error_ = false;
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
  before_step();
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

void KincoDrive::begin_store(Keep what) {
  store_what_ = what;
  Cia402Drive::begin_store();
}

void KincoDrive::store_now() {
  objects_.set(store_what_ == Keep::eeprom ? store_command : store_motor_command, 0);
  objects_.store(store_what_);
}

void KincoDrive::after_step(Dec speed_before) {
  const Dec full = std::max<Dec>(full_acceleration(), 1);
  const bool coasts = motion_.task() == Task::coast;
  current_ = coasts ? 0 : std::clamp<Dec>((axis_.speed() - speed_before) * 2048 / full, -2048, 2047);
  if (motion_.task() == Task::torque) current_ = torque_command_;
  // 606C of the JD is sampled each 200 ms (JD 4.2).
  if (ticks_ % 200 == 0) sampled_rpm_ = rpm_of(axis_.told_speed(), encoder_counts_);
}

void KincoDrive::before_step() {
  if (booting()) return;
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

void KincoDrive::supervise() {
  const std::int64_t largest = object(0x6065);
  const std::int64_t error = axis_.following_error();
  if (operating() && motion_.task() != Task::homing && largest > 0 && (error > largest || error < -largest)) {
    raise_fault(0x0200, 0);  // bit 9: JD 7, MD 9
  }
  // Limits after homing are an alarm only where 2010.19 asks for it (MD E, MD 9 word 2).
  if (model_.has_error_word_2 && homed_ && object(0x2010, 0x19) == 0) {
    if (inputs_.at_positive_limit()) raise_fault(0, 0x0200);
    if (inputs_.at_negative_limit()) raise_fault(0, 0x0400);
  }
  if (!inside_position_window()) outside_window_at_ = now_;
}

void KincoDrive::inject_fault(int error_word, std::uint16_t bits) {
  (error_word == 1 ? cause_1_ : cause_2_) |= bits;
  if (!booting()) raise_fault(error_word == 1 ? bits : 0, error_word == 1 ? 0 : bits);
}

void KincoDrive::clear_fault_cause(int error_word, std::uint16_t bits) {
  auto& cause = error_word == 1 ? cause_1_ : cause_2_;
  cause = static_cast<std::uint16_t>(cause & ~bits);
}

}  // namespace axisgate::simulated
