// SPDX-License-Identifier: Apache-2.0
// Reads and writes of LeadshineDrive's objects, its units (4), and what a write leads to.
#include <algorithm>

#include "tests/simulated/leadshine_drive.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::int64_t milliseconds_per_second = 1000;

}  // namespace

// 4.1: Pr0.08, the feed constant, or the gear.
std::int64_t LeadshineDrive::units_per_revolution() const {
  const std::int64_t encoder = options_.encoder_counts;
  if (object(0x2008) != 0) return object(0x2008);
  if (object(0x6092, 1) != encoder) return object(0x6092, 1);
  return std::max<std::int64_t>(encoder * object(0x6091, 2) / object(0x6091, 1), 1);
}

FinePosition LeadshineDrive::fine_of(std::int64_t units) const {
  const std::int64_t encoder = options_.encoder_counts;
  return divide_rounded(units * encoder * fine_per_count, units_per_revolution());
}

std::int64_t LeadshineDrive::units_of(FinePosition position) const {
  const std::int64_t encoder = options_.encoder_counts;
  return divide_rounded(position * units_per_revolution(), encoder * fine_per_count);
}

Dec LeadshineDrive::speed_of(std::int64_t units_per_s) const {
  const std::int64_t encoder = options_.encoder_counts;
  return divide_rounded(units_per_s * encoder * fine_per_count, units_per_revolution() * milliseconds_per_second);
}

Dec LeadshineDrive::acceleration_of(std::int64_t units_per_s2) const {
  const std::int64_t encoder = options_.encoder_counts;
  const std::int64_t per_ms2 = milliseconds_per_second * milliseconds_per_second;
  return std::max<Dec>(divide_rounded(units_per_s2 * encoder * fine_per_count, units_per_revolution() * per_ms2), 1);
}

std::int64_t LeadshineDrive::units_per_s_of(Dec speed) const {
  const std::int64_t encoder = options_.encoder_counts;
  return divide_rounded(speed * units_per_revolution() * milliseconds_per_second, encoder * fine_per_count);
}

void LeadshineDrive::refresh_settings() {
  const Dec fastest = speed_dec(object(0x6080), options_.encoder_counts);
  settings_.profile_velocity = speed_of(std::min(object(0x6081), object(0x607F)));
  settings_.acceleration = acceleration_of(std::min(object(0x6083), object(0x60C5)));
  settings_.deceleration = acceleration_of(std::min(object(0x6084), object(0x60C6)));
  settings_.limit_deceleration = acceleration_of(object(0x6085));
  settings_.maximum_speed = fastest;
  settings_.full_acceleration = full_acceleration();
  settings_.coasting = acceleration_dec(options_.mechanics.coasting_rps_per_s, options_.encoder_counts);
  settings_.software_maximum.reset();
  settings_.software_minimum.reset();
  // Whether 0 and 0 means "none" is not said; it can mean nothing else.
  if (object(0x607D, 2) > object(0x607D, 1)) {
    settings_.software_minimum = fine_of(object(0x607D, 1));
    settings_.software_maximum = fine_of(object(0x607D, 2));
  }
}

std::uint8_t LeadshineDrive::highest_sub(std::uint16_t index) const {
  std::uint8_t highest = 0;
  for (unsigned sub = 1; sub <= 0xFF; ++sub) {
    if (objects_.find({index, static_cast<std::uint8_t>(sub)}) != nullptr) highest = static_cast<std::uint8_t>(sub);
  }
  return highest;
}

ObjectReply LeadshineDrive::read(ObjectKey key, Time now) {
  advance(now);
  if (const auto more = options_.more.find(key); more != options_.more.end())
    return {0, little_endian(more->second, 4)};
  const ObjectEntry* entry = objects_.find(key);
  if (entry == nullptr) {
    if (!objects_.has_index(key.index)) return {abort_of(Refusal::no_such_object)};
    if (key.sub == 0) return {0, {highest_sub(key.index)}};
    return {sdo_abort::no_such_sub};
  }
  const auto width = static_cast<std::size_t>(simulated::bytes_of(entry->type));
  return {0, little_endian(static_cast<std::uint32_t>(value_of(*entry)), width)};
}

std::optional<std::uint32_t> LeadshineDrive::mapped(ObjectKey key, Time now) {
  advance(now);
  const ObjectEntry* entry = options_.more.contains(key) ? nullptr : objects_.find(key);
  return entry == nullptr ? CanDevice::mapped(key, now) : static_cast<std::uint32_t>(value_of(*entry));
}

std::uint32_t LeadshineDrive::write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) {
  advance(now);
  if (objects_.find(key) == nullptr && objects_.has_index(key.index)) {
    return key.sub == 0 ? abort_of(Refusal::read_only) : sdo_abort::no_such_sub;
  }
  const Refusal refusal = take_write(key, static_cast<int>(bytes.size()), little_endian(bytes), tag, true);
  return refusal == Refusal::wrong_width ? options_.mismatch_abort : abort_of(refusal);
}

bool LeadshineDrive::may_be_mapped(ObjectKey key, PdoDirection direction) const {
  const ObjectEntry* entry = objects_.find(key);
  if (entry == nullptr || options_.unmappable.contains(key)) return false;
  if (key.index == 0x605A || key.index == 0x605D || key.index == 0x605E) return false;  // printed so (2.7)
  if (direction == PdoDirection::to_drive && entry->access == Access::ro) return false;
  return key.index >= 0x6000 || key.index == 0x3010;
}

Refusal LeadshineDrive::take_write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, bool counted) {
  std::int64_t value = 0;
  const Refusal refusal = objects_.check_write(key, width, raw, value);
  if (refusal != Refusal::none) return refusal;
  if (key == ObjectKey{0x3002, 0} && value != save_word) return Refusal::value_range;
  // The feed constant acts when disabled (4.1).
  if (key == ObjectKey{0x6092, 1} && state_ == Cia402State::operation_enabled) return Refusal::device_state;
  if (counted) objects_.count_write(key);
  objects_.set(key, value);
  written(key, value, tag);
  return Refusal::none;
}

void LeadshineDrive::written(ObjectKey key, std::int64_t value, std::uint64_t tag) {
  refresh_settings();
  switch (key.index) {
    case 0x6040:
      take_controlword(static_cast<std::uint16_t>(value), tag);
      break;
    case 0x6060:
      set_mode(value);
      break;
    case 0x60FF:
      take_target_speed();
      break;
    case 0x3002:
      objects_.set({0x3003, 0}, 0);
      begin_store();
      break;
    case 0x4000:
      if (value == 1) reset_fault(tag);
      objects_.set(key, 0);
      break;
    default:
      break;
  }
}

}  // namespace axisgate::simulated
