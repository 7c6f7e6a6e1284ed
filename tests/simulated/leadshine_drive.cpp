// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/leadshine_drive.hpp"

#include <algorithm>
#include <cstdlib>

namespace axisgate::simulated {
namespace {

constexpr int positive_limit_input = 2;
constexpr int negative_limit_input = 3;
constexpr int home_input = 4;
constexpr int stop_input = 6;
constexpr ObjectKey save_trigger{0x3002, 0};
constexpr ObjectKey save_status{0x3003, 0};
constexpr std::uint16_t following_alarm = 0x8611;
constexpr std::uint16_t heartbeat_alarm = 0x8130;

}  // namespace

CommunicationFacts communication_of(const LeadshineOptions& options) {
  CommunicationFacts facts;
  facts.sdo.segmented = options.segmented;
  facts.sdo.block = options.block;
  facts.pdo.event_timer = options.event_timer;
  facts.pdo.takes_type_254 = false;
  facts.pdo.type = 255;
  facts.leaves_operational_on_loss = options.leaves_operational_on_loss;
  facts.sends_emergencies = options.sends_emergencies;
  facts.identity = options.identity;
  facts.name = options.name;
  facts.hardware = "1.0";
  facts.software = "V1.00";
  return facts;
}

LeadshineDrive::LeadshineDrive(const LeadshineOptions& options)
    : options_(options),
      objects_(leadshine_objects(), leadshine_parameters(), OutOfRange::refuse),
      inputs_(input_count),
      axis_(options_.mechanics, options_.encoder_counts) {
  objects_.set_stored({0x2023, 0}, options_.node);
  for (const auto& [key, value] : options_.stored) objects_.set_stored(key, value);
  power_up();
}

void LeadshineDrive::wire_inputs() {
  const Mechanics& wired = options_.mechanics;
  const auto wire = [this](int input, InputFunction function, bool there) {
    inputs_.assign(input, there ? static_cast<std::uint16_t>(function) : std::uint16_t{0});
  };
  wire(positive_limit_input, InputFunction::positive_limit, wired.positive_limit.has_value());
  wire(negative_limit_input, InputFunction::negative_limit, wired.negative_limit.has_value());
  wire(home_input, InputFunction::home_switch, wired.home_from || wired.home_to);
  wire(stop_input, InputFunction::emergency_stop, true);
  inputs_.follow(wired, axis_.physical());
}

void LeadshineDrive::power_up() {
  objects_.power_up();
  objects_.set({0x608F, 1}, options_.encoder_counts);
  objects_.set({0x6060, 0}, options_.mode);
  objects_.set(save_status, save_word);
  controlword_ = 0;
  torque_demand_ = 0;
  error_ = cause_;
  homed_ = homing_error_ = false;
  mode_ = object(0x6060);
  wire_inputs();
  refresh_settings();
  axis_.redefine(0);  // an incremental encoder counts from 0
  axis_.forget_demand();
  motion_.coast();
  change_state(Cia402State::switch_on_disabled, 0);
  if (error_ != 0) change_state(Cia402State::fault, 0);
}

void LeadshineDrive::restart(Time now) {
  advance(now);
  ++restarts_;
  store_until_.reset();  // a save under way is lost with the power
  boot_until_ = now + options_.boot_time;
  pending_.reset();
  motion_.coast();
  halted_.reset();
  error_ = 0;
  change_state(Cia402State::not_ready_to_switch_on, 0);
  advance(now);
}

bool LeadshineDrive::quiescent() const {
  return !boot_until_ && !store_until_ && !pending_ && !halted_ && motion_.at_rest(axis_) &&
         axis_.demand() == axis_.actual() && !inputs_.active(InputFunction::emergency_stop);
}

void LeadshineDrive::advance(Time now) {
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

void LeadshineDrive::tick(Time at) {
  now_ = at;
  if (boot_until_ && at >= *boot_until_) {
    boot_until_.reset();
    power_up();
  }
  if (store_until_ && at >= *store_until_) {
    store_until_.reset();
    objects_.set(save_trigger, 0);
    objects_.set(save_status, save_word);
    objects_.store(Keep::eeprom);
    ++stores_;
  }
  inputs_.follow(options_.mechanics, axis_.physical());
  if (inputs_.active(InputFunction::emergency_stop) && operating()) obey(Cia402Command::quick_stop, 0);
  follow_torque();
  const Dec before = axis_.speed();
  const Dec speed = motion_.next_speed(axis_, inputs_, settings_);
  axis_.step(speed, motion_.position_loop(), (object(0x607E) & 0x80) != 0 ? -1 : 1);
  last_step_ = axis_.speed() - before;
  if (!boot_until_) {
    follow_motion();
    supervise();
  }
}

// 6071h is followed on the slope of 6087h, in 0.1 % per second (5.7); it counts in millionths, for the slope's sake.
void LeadshineDrive::follow_torque() {
  const bool torque = motion_.task() == Task::torque;
  const std::int64_t most = object(0x6072);
  const std::int64_t wanted = torque ? std::clamp<std::int64_t>(object(0x6071), -most, most) * 1000 : 0;
  const std::int64_t slope = torque ? object(0x6087) : full_torque * 1000;
  torque_demand_ += std::clamp(wanted - torque_demand_, -slope, slope);
  const Dec full = acceleration_dec(options_.mechanics.rps_per_s_at_full_current, options_.encoder_counts);
  settings_.torque_acceleration = full * torque_demand_ / (full_torque * 1000);
}

void LeadshineDrive::follow_motion() {
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
      finish_homing();
      break;
    case HomingRun::Outcome::failed:
      homing_error_ = true;
      break;
  }
  motion_.hold(axis_);
}

// 5012h:04 bits 2 and 3 tell how the offset is applied (3.4).
void LeadshineDrive::finish_homing() {
  const std::int64_t how = object(0x5012, 4) >> 2 & 3;
  const std::int64_t offset = object(0x607C);
  const std::int64_t units = (how & 1) != 0 ? 0 : how == 2 ? -offset : offset;
  axis_.redefine(fine_of(units));
  homed_ = true;
}

void LeadshineDrive::supervise() {
  const std::int64_t error = std::abs(axis_.following_error());
  if (units_of(error * fine_per_count) <= object(0x6065)) inside_following_window_ = now_;
  // Pr0.14, in tenths of a revolution.
  const std::int64_t largest = object(0x2014) * options_.encoder_counts / 10;
  if (operating() && motion_.position_loop() && motion_.task() != Task::homing && largest > 0 && error > largest) {
    raise_fault(following_alarm);
  }
}

void LeadshineDrive::lose_master(MasterLoss, Time now) {
  advance(now);
  if (options_.stops_without_master) raise_fault(heartbeat_alarm);
}

std::uint8_t LeadshineDrive::error_register() const {
  return error_ == 0 ? std::uint8_t{0} : leadshine_alarm(error_).error_register;
}

void LeadshineDrive::inject_fault(std::uint16_t code) {
  cause_ = code;
  if (!boot_until_) raise_fault(code);
}

}  // namespace axisgate::simulated
