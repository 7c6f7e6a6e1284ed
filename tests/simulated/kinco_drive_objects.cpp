// SPDX-License-Identifier: Apache-2.0
// Reads and writes of KincoDrive's objects, and what a write leads to (JD 2.1, JD 4, MD 2.2, MD 6).
#include <algorithm>
#include <array>

#include "tests/simulated/kinco_drive.hpp"

namespace axisgate::simulated {
namespace {

constexpr ObjectKey mode_of_operation{0x6060, 0};
constexpr ObjectKey password{0x2FFD, 0};

int width_of(FrameCommand command) {
  switch (command) {
    case FrameCommand::write_4:
      return 4;
    case FrameCommand::write_2:
      return 2;
    case FrameCommand::write_1:
      return 1;
    default:
      return 0;
  }
}

std::uint32_t mask_of(int width) { return width == 4 ? 0xFFFFFFFFU : (1U << (8 * width)) - 1U; }

FrameCommand read_reply(int width) {
  if (width == 4) return FrameCommand::read_4;
  return width == 2 ? FrameCommand::read_2 : FrameCommand::read_1;
}

bool known_mode(std::int64_t mode) {
  constexpr std::array<std::int64_t, 7> modes{-4, -3, 1, 3, 4, 6, 7};
  return std::find(modes.begin(), modes.end(), mode) != modes.end();
}

}  // namespace

std::optional<TenByteFrame> KincoDrive::answer(const TenByteFrame& request, std::uint64_t tag, Time now) {
  advance(now);
  const FrameCommand command = command_of(request);
  const ObjectKey key{index_of(request), sub_of(request)};
  const auto reply = [&](FrameCommand answer, std::uint32_t data) {
    return seal(station_of(request), answer, key.index, key.sub, data);
  };
  if (command == FrameCommand::read) {
    const auto value = peek(key);
    if (!value) return reply(FrameCommand::error, static_cast<std::uint32_t>(Refusal::no_such_object));
    const int width = bytes_of(objects_.find(key)->type);
    const std::uint32_t filling = 0x01010101U * options_.unused_bytes;
    const std::uint32_t mask = mask_of(width);
    return reply(read_reply(width), (static_cast<std::uint32_t>(*value) & mask) | (filling & ~mask));
  }
  const int width = width_of(command);
  if (width == 0) return std::nullopt;  // no request: another drive's reply on a shared line
  const Refusal refusal = take_write(key, width, data_of(request), tag, true);
  if (refusal != Refusal::none) return reply(FrameCommand::error, static_cast<std::uint32_t>(refusal));
  return reply(FrameCommand::write_done, options_.echo_written_value ? data_of(request) & mask_of(width) : 0);
}

std::optional<std::int64_t> KincoDrive::read(ObjectKey key, Time now) {
  advance(now);
  return peek(key);
}

Refusal KincoDrive::write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, Time now) {
  advance(now);
  return take_write(key, width, raw, tag, true);
}

Refusal KincoDrive::may_write(ObjectKey key, std::int64_t value) const {
  if (key == mode_of_operation && !known_mode(value)) return Refusal::value_range;
  // MD H: the smoothing filter only while disabled.
  if (model_.type == KincoType::md && key == ObjectKey{0x60FB, 0x05} && state_ == Cia402State::operation_enabled) {
    return Refusal::device_state;
  }
  // JD 1.4 point 6: no parameter until the password is given.
  if (locked_ && objects_.find(key)->keep != Keep::ram && (key != password || value != object(0x2FFD))) {
    return Refusal::device_state;
  }
  return Refusal::none;
}

Refusal KincoDrive::take_write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, bool counted) {
  if (entry(key) == nullptr) return Refusal::no_such_object;
  std::int64_t value = 0;
  Refusal refusal = objects_.check_write(key, width, raw, value);
  if (refusal == Refusal::none) refusal = may_write(key, value);
  if (refusal != Refusal::none) return refusal;
  if (counted) objects_.count_write(key);
  if (key == password) locked_ = false;
  // While an input has the mode-control or enable function, the write is acknowledged without effect (JD 1.4, MD 4).
  if (key == mode_of_operation && inputs_.has(InputFunction::mode_control)) return Refusal::none;
  if (key == controlword && inputs_.has(InputFunction::drive_enable)) return Refusal::none;
  // DIP switches other than 0 win over 100B.00 (MD 1).
  if (model_.type == KincoType::md && key == ObjectKey{0x100B, 0} && options_.station <= 7) return Refusal::none;
  objects_.set(key, value);
  written(key, value, tag);
  return Refusal::none;
}

void KincoDrive::written(ObjectKey key, std::int64_t value, std::uint64_t tag) {
  if (key.index == 0x2010) inputs_.configure(objects_);
  couple(key, value);
  refresh_settings();
  switch (key.index) {
    case 0x6040:
      take_controlword(static_cast<std::uint16_t>(value), tag);
      break;
    case 0x6060:
      set_mode(value);
      break;
    case 0x607A:
      if (operating() && follows_target()) start_move(controlword_);
      break;
    case 0x60FF:
      take_target_speed();
      break;
    case 0x2FF0:
      if (key.sub == 0x01 && value == 1) begin_store(Keep::eeprom);
      if (key.sub == 0x03 && value == 1) begin_store(Keep::motor);
      if (key.sub == 0x01 && value == 10) {
        objects_.restore_defaults();
        objects_.set(key, 0);
        inputs_.configure(objects_);
        refresh_settings();
      }
      if (key.sub == 0x09) take_target_speed();
      if (key.sub == 0x05 && !inputs_.has(InputFunction::drive_enable)) {
        if (value == 0x10) {
          reset_fault(tag);
        } else {
          take_controlword(value == 1 ? 0x000F : 0x0006, tag);  // JD 6.1: 0 releases, 1 locks
        }
      }
      break;
    default:
      break;
  }
}

// Simplified objects of the JD's panel are other views of the same values (JD 4.3, 4.5).
void KincoDrive::couple(ObjectKey key, std::int64_t value) {
  if (key == ObjectKey{0x6071, 0}) {
    // Current on the JD; percent of rated torque on the MD (C17), a third of the peak (MD 1, torque rated/max).
    torque_command_ = model_.torque_object_is_current ? value : divide_rounded(value * 2048, 300);
  }
  if (key == ObjectKey{0x60F6, 0x08}) torque_command_ = value;
  if (objects_.find({0x2FF0, 0x06}) == nullptr) return;
  const auto mirror = [&](ObjectKey from, ObjectKey to, auto convert) {
    if (key == from) objects_.set(to, convert(value));
  };
  const std::int64_t enc = encoder_counts_;
  mirror({0x2FF0, 0x06}, {0x6083, 0}, [enc](std::int64_t v) { return acceleration_dec(v, enc); });
  mirror({0x2FF0, 0x07}, {0x6084, 0}, [enc](std::int64_t v) { return acceleration_dec(v, enc); });
  mirror({0x2FF0, 0x09}, {0x60FF, 0}, [enc](std::int64_t v) { return speed_dec(v, enc); });
  mirror({0x2FF0, 0x0E}, {0x6065, 0}, [](std::int64_t v) { return v * 100; });
  mirror({0x6083, 0}, {0x2FF0, 0x06}, [enc](std::int64_t v) { return rps_per_s_of(v, enc) & 0xFFFF; });
  mirror({0x6084, 0}, {0x2FF0, 0x07}, [enc](std::int64_t v) { return rps_per_s_of(v, enc) & 0xFFFF; });
  mirror({0x60FF, 0}, {0x2FF0, 0x09}, [enc](std::int64_t v) { return rpm_of(v, enc); });
  mirror({0x6065, 0}, {0x2FF0, 0x0E}, [](std::int64_t v) { return std::min<std::int64_t>(v / 100, 0xFFFF); });
}

void KincoDrive::refresh_settings() {
  const Dec full = full_acceleration();
  const std::int64_t most = std::min<std::int64_t>(object(0x6073), 2048);
  settings_.profile_velocity = object(0x6081);
  settings_.acceleration = object(0x6083);
  settings_.deceleration = object(0x6084);
  settings_.limit_deceleration = option_deceleration(object(0x605A));
  settings_.maximum_speed = speed_dec(object(0x6080), encoder_counts_);
  settings_.full_acceleration = full * most / 2048;
  settings_.torque_acceleration = full * std::clamp<Dec>(torque_command_, -most, most) / 2048;
  settings_.coasting = acceleration_dec(options_.mechanics.coasting_rps_per_s, encoder_counts_);
  settings_.software_maximum.reset();
  settings_.software_minimum.reset();
  // Delivered as 0 and 0, which can only mean "none" (the sheets give no default).
  if (object(0x607D, 0x01) > object(0x607D, 0x02)) {
    settings_.software_maximum = object(0x607D, 0x01) * fine_per_count;
    settings_.software_minimum = object(0x607D, 0x02) * fine_per_count;
  }
}

}  // namespace axisgate::simulated
