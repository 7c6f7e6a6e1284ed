// SPDX-License-Identifier: Apache-2.0
// Power, time, reads, writes and units of EdsDrive.
#include "tests/simulated/eds_drive.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace axisgate::simulated {
namespace {

constexpr int positive_limit_input = 1, negative_limit_input = 2, home_input = 3;
constexpr ObjectKey store_parameters{0x1010, 1};
constexpr std::int64_t save_word = 0x65766173;  // "save", as CiA 301 has it
constexpr std::uint16_t heartbeat_error = 0x8130;
constexpr std::int64_t milliseconds_per_second = 1000;
constexpr std::int64_t fastest_rpm = 6000;  // of the motor on the bench

Cia402Facts facts_of(const EdsDriveOptions& options) {
  return {.encoder_counts = options.type->encoder_counts,
          .inputs = 4,
          .boot_time = options.boot_time,
          .store_time = options.store_time,
          .fault_reset_word = 0x0080,
          .needs_shutdown_first = true,
          .shutdown_leaves_quick_stop = false,  // CiA 402: transitions 12 and 16 alone do
          .stands_released_at_once = true,
          .takes_new_speed_while_on = true};
}

std::int64_t times(std::int64_t value, EdsUnit factor) { return divide_rounded(value * factor.of, factor.per); }

constexpr EdsUnit inverse(EdsUnit factor) { return {factor.per, factor.of}; }

// From one of its units to counts of the simulation; reduced, so that 64 bits are enough.
EdsUnit fine_per(EdsUnit unit, std::int64_t encoder_counts, std::int64_t periods) {
  const EdsUnit turn = EdsUnit{encoder_counts * fine_per_count, unit.of}.reduced();
  return EdsUnit{turn.of * unit.per, turn.per * periods}.reduced();
}

}  // namespace

CommunicationFacts communication_of(const EdsDriveOptions& options) {
  const EdsDriveType& type = *options.type;
  CommunicationFacts facts;
  facts.sdo.segmented = true;
  facts.sdo.block = false;
  facts.pdo.event_timer = type.event_timer;
  facts.pdo.type = 255;
  facts.pdo.entries = std::min<std::size_t>(type.mapped_most, CanPdos::longest_map);
  facts.consumers = type.consumers;
  facts.guarding_objects = type.guarding;
  facts.drive_minds_guarding = type.guarding;
  facts.sends_emergencies = true;
  facts.device_type = type.device_type;
  facts.identity = type.identity;
  facts.name = type.device_name;
  facts.hardware = "1.0";
  facts.software = "1.0";
  constexpr std::uint16_t first_tpdo = 0x1800, tpdos = 4;
  constexpr std::uint8_t inhibit = 3;
  for (std::uint16_t i = 0; i < tpdos && !type.inhibit_time; ++i) {
    facts.lacks.insert({static_cast<std::uint16_t>(first_tpdo + i), inhibit});
  }
  return facts;
}

EdsDrive::EdsDrive(const EdsDriveOptions& options)
    : Cia402Drive(facts_of(options), options.mechanics, {options.type->objects, {}, OutOfRange::refuse}),
      options_(options) {
  for (const auto& [key, value] : options_.stored) objects_.set_stored(key, value);
  power_up();
}

std::string EdsDrive::describe() const { return std::string(type().name) + '@' + std::to_string(options_.node); }

void EdsDrive::wire_inputs() {
  const Mechanics& wired = options_.mechanics;
  const auto wire = [this](int input, InputFunction function, bool there) {
    inputs_.assign(input, there ? static_cast<std::uint16_t>(function) : std::uint16_t{0});
  };
  wire(positive_limit_input, InputFunction::positive_limit, wired.positive_limit.has_value());
  wire(negative_limit_input, InputFunction::negative_limit, wired.negative_limit.has_value());
  wire(home_input, InputFunction::home_switch, wired.home_from || wired.home_to);
  inputs_.follow(wired, axis_.physical());
}

void EdsDrive::power_up() {
  objects_.power_up();
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

void EdsDrive::restart(Time now) {
  Cia402Drive::restart(now);
  error_ = 0;
  advance(now);
}

void EdsDrive::before_step() {
  const std::int64_t most = object_or(0x6072, full_torque);
  const bool torque = motion_.task() == Task::torque;
  torque_demand_ = torque ? std::clamp(object_or(0x6071, 0), -most, most) : 0;
  settings_.torque_acceleration = full_acceleration() * torque_demand_ / full_torque;
}

void EdsDrive::finish_homing() { axis_.redefine(fine_of(object_or(0x607C, 0))); }

void EdsDrive::lose_master(MasterLoss, Time now) {
  advance(now);
  switch (object_or(0x6007, type().master_lost)) {
    case 1:
      return raise_fault(heartbeat_error);
    case 2:
      return obey(Cia402Command::disable_voltage, 0);
    case 3:
      return obey(Cia402Command::quick_stop, 0);
    default:
      return;
  }
}

void EdsDrive::inject_fault(std::uint16_t code) {
  cause_ = code;
  if (!booting()) raise_fault(code);
}

std::int32_t EdsDrive::position() const { return static_cast<std::int32_t>(raw_of(axis_.actual())); }

std::int64_t EdsDrive::object_or(std::uint16_t index, std::int64_t otherwise, std::uint8_t sub) const {
  return objects_.find({index, sub}) == nullptr ? otherwise : object(index, sub);
}

FinePosition EdsDrive::fine_of(std::int64_t raw) const {
  return times(raw, fine_per(units_.position, encoder_counts(), 1));
}

std::int64_t EdsDrive::raw_of(FinePosition position) const {
  return times(position, inverse(fine_per(units_.position, encoder_counts(), 1)));
}

std::int64_t EdsDrive::amount_of(std::int64_t raw) const {
  if (!type().real_speeds) return raw;
  return std::llround(std::bit_cast<float>(static_cast<std::uint32_t>(raw)) * 1000.0F);
}

Dec EdsDrive::speed_of(std::int64_t raw) const {
  return times(amount_of(raw), fine_per(units_.speed, encoder_counts(), milliseconds_per_second));
}

std::int64_t EdsDrive::raw_speed_of(Dec speed) const {
  const std::int64_t amount = times(speed, inverse(fine_per(units_.speed, encoder_counts(), milliseconds_per_second)));
  if (!type().real_speeds) return amount;
  return std::bit_cast<std::uint32_t>(no_number_ ? NAN : static_cast<float>(amount) / 1000.0F);
}

Dec EdsDrive::acceleration_of(std::int64_t raw) const {
  constexpr std::int64_t per_ms2 = milliseconds_per_second * milliseconds_per_second;
  return std::max<Dec>(times(amount_of(raw), fine_per(units_.acceleration, encoder_counts(), per_ms2)), 1);
}

// 6048h and 6049h: so many rpm in so many seconds.
Dec EdsDrive::vl_ramp(std::uint16_t index) const {
  const std::int64_t seconds = std::max<std::int64_t>(object(index, 2), 1);
  return std::max<Dec>(speed_dec(object(index, 1), encoder_counts()) / (seconds * milliseconds_per_second), 1);
}

void EdsDrive::refresh_settings() {
  units_ = type().units(objects_, encoder_counts());
  const std::int64_t fastest = object_or(0x607F, 0);  // 0: no file says how it is delivered, and none limits
  settings_.profile_velocity = speed_of(fastest > 0 ? std::min(object(0x6081), fastest) : object(0x6081));
  settings_.acceleration = acceleration_of(object(0x6083));
  settings_.deceleration = acceleration_of(object_or(0x6084, object(0x6083)));
  if (mode_ == vl_mode) {
    settings_.acceleration = vl_ramp(0x6048);
    settings_.deceleration = vl_ramp(0x6049);
  }
  settings_.limit_deceleration = acceleration_of(object(0x6085));
  settings_.maximum_speed = speed_dec(fastest_rpm, encoder_counts());
  settings_.full_acceleration = full_acceleration();
  settings_.coasting = acceleration_dec(options_.mechanics.coasting_rps_per_s, encoder_counts());
  settings_.software_maximum.reset();
  settings_.software_minimum.reset();
  const std::int64_t lowest = object_or(0x607D, 0, 1), highest = object_or(0x607D, 0, 2);
  if (highest > lowest) {
    settings_.software_minimum = fine_of(lowest);
    settings_.software_maximum = fine_of(highest);
  }
}

ObjectReply EdsDrive::read(ObjectKey key, Time now) {
  advance(now);
  const ObjectEntry* entry = objects_.find(key);
  if (entry == nullptr) {
    if (!objects_.has_index(key.index)) return {abort_of(Refusal::no_such_object)};
    if (key.sub != 0) return {sdo_abort::no_such_sub};
    std::uint8_t highest = 0;
    for (const ObjectEntry& row : type().objects) {
      if (row.index == key.index) highest = std::max(highest, row.sub);
    }
    return {0, {highest}};
  }
  const auto width = static_cast<std::size_t>(simulated::bytes_of(entry->type));
  return {0, little_endian(static_cast<std::uint32_t>(value_of(*entry)), width)};
}

std::optional<std::uint32_t> EdsDrive::mapped(ObjectKey key, Time now) {
  advance(now);
  const ObjectEntry* entry = objects_.find(key);
  return entry == nullptr ? CanDevice::mapped(key, now) : static_cast<std::uint32_t>(value_of(*entry));
}

std::uint32_t EdsDrive::write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) {
  advance(now);
  if (objects_.find(key) == nullptr && objects_.has_index(key.index)) {
    return key.sub == 0 ? abort_of(Refusal::read_only) : sdo_abort::no_such_sub;
  }
  return abort_of(take_write(key, static_cast<int>(bytes.size()), little_endian(bytes), tag, true));
}

bool EdsDrive::may_be_mapped(ObjectKey key, PdoDirection direction) const {
  const ObjectEntry* entry = objects_.find(key);
  if (entry == nullptr || key.index < 0x6000 || std::ranges::count(type().unmappable, key) > 0) return false;
  return direction == PdoDirection::from_drive || entry->access == Access::rw;
}

Refusal EdsDrive::take_write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, bool counted) {
  std::int64_t value = 0;
  const Refusal refusal = objects_.check_write(key, width, raw, value);
  if (refusal != Refusal::none) return refusal;
  if (key == store_parameters && value != save_word) return Refusal::device_state;
  if (counted) objects_.count_write(key);
  if (key == store_parameters) {
    begin_store();
    return Refusal::none;
  }
  objects_.set(key, value);
  written(key, value, tag);
  return Refusal::none;
}

void EdsDrive::written(ObjectKey key, std::int64_t value, std::uint64_t tag) {
  if (key.index == 0x6040) take_controlword(static_cast<std::uint16_t>(value), tag);
  if (key.index == 0x6060) set_mode(value);
  refresh_settings();
  const bool tells_vl = mode_ == vl_mode && (key.index == 0x6040 || key.index == 0x6042);
  if (key.index == 0x60FF || tells_vl) take_target_speed();
}

}  // namespace axisgate::simulated
