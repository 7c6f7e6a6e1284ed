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

Cia402Facts facts_of(const LeadshineOptions& options) {
  return {.encoder_counts = options.encoder_counts,
          .inputs = 6,  // SI1 to SI6; DI3 to DI6 exist (1)
          .boot_time = options.boot_time,
          .store_time = options.store_time,
          .fault_reset_word = 0x0080,
          .needs_shutdown_first = true,
          .shutdown_leaves_quick_stop = false,  // CiA 402: transitions 12 and 16 alone do
          .stands_released_at_once = true,
          .takes_new_speed_while_on = !options.needs_halt_edge};
}

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
    : Cia402Drive(facts_of(options), options.mechanics,
                  {leadshine_objects(), leadshine_parameters(), OutOfRange::refuse}),
      options_(options) {
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
  Cia402Drive::restart(now);
  error_ = 0;
  advance(now);
}

void LeadshineDrive::store_now() {
  objects_.set(save_trigger, 0);
  objects_.set(save_status, save_word);
  objects_.store(Keep::eeprom);
}

void LeadshineDrive::before_step() {
  if (inputs_.active(InputFunction::emergency_stop) && operating()) obey(Cia402Command::quick_stop, 0);
  follow_torque();
}

// 6071h is followed on the slope of 6087h, in 0.1 % per second (5.7); it counts in millionths, for the slope's sake.
void LeadshineDrive::follow_torque() {
  const bool torque = motion_.task() == Task::torque;
  const std::int64_t most = object(0x6072);
  const std::int64_t wanted = torque ? std::clamp<std::int64_t>(object(0x6071), -most, most) * 1000 : 0;
  const std::int64_t slope = torque ? object(0x6087) : full_torque * 1000;
  torque_demand_ += std::clamp(wanted - torque_demand_, -slope, slope);
  settings_.torque_acceleration = full_acceleration() * torque_demand_ / (full_torque * 1000);
}

// 5012h:04 bits 2 and 3 tell how the offset is applied (3.4).
void LeadshineDrive::finish_homing() {
  const std::int64_t how = object(0x5012, 4) >> 2 & 3;
  const std::int64_t offset = object(0x607C);
  const std::int64_t units = (how & 1) != 0 ? 0 : how == 2 ? -offset : offset;
  axis_.redefine(fine_of(units));
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
  if (!booting()) raise_fault(code);
}

}  // namespace axisgate::simulated
