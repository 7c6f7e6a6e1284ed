// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/keya_can.hpp"

#include <utility>

#include "tests/simulated/keya_frame.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::uint8_t write_command = 0x23, read_command = 0x40, answered = 0x60;
constexpr std::uint8_t both_subs[] = {1, 2};

BusFrame extended_frame(std::uint32_t id, CanView bytes) {
  BusFrame frame = bus_frame(id, bytes);
  frame.extended = true;
  return frame;
}

std::array<std::uint8_t, 4> two_words(int first, int second) {
  std::array<std::uint8_t, 4> data{};
  put_big_endian(std::span(data).first(2), first);
  put_big_endian(std::span(data).last(2), second);
  return data;
}

std::array<std::uint8_t, 4> one_number(std::int64_t value) {
  std::array<std::uint8_t, 4> data{};
  put_big_endian(data, value);
  return data;
}

}  // namespace

bool KeyaCan::is_request(const BusFrame& frame) const {
  return frame.extended && !frame.remote && frame.id == keya_can::command + node();
}

BusFrame KeyaCan::life_sign(CanView bytes) const { return extended_frame(keya_can::heartbeat + node(), bytes); }

std::vector<CanOutput> KeyaCan::take_output() { return std::exchange(output_, {}); }

void KeyaCan::advance(Time now) {
  drive_.advance(now);
  if (drive_.booting() || !drive_.obeys(KeyaInterface::can)) {
    next_heartbeat_ = now + one_millisecond;
    was_booting_ = true;
    return;
  }
  if (std::exchange(was_booting_, false)) next_heartbeat_ = now + keya_can::heartbeat_period;
  if (now < next_heartbeat_) return;
  next_heartbeat_ = now + keya_can::heartbeat_period;
  output_.push_back({0, false, life_sign(heartbeat_bytes())});
}

CanBytes KeyaCan::heartbeat_bytes() const {
  CanBytes bytes(longest_can_frame);
  const std::span<std::uint8_t> all(bytes);
  put_big_endian(all.subspan(0, 2), drive_.at(KeyaMotorName::a).electrical_angle());
  put_big_endian(all.subspan(2, 2), drive_.at(KeyaMotorName::b).electrical_angle());
  put_big_endian(all.subspan(4, 2), drive_.faults(KeyaMotorName::a));
  const auto state = drive_.control_state();
  bytes[6] = state[0];
  bytes[7] = state[1];
  return bytes;
}

void KeyaCan::restart(Time now) {
  output_.clear();
  drive_.restart(now);
  advance(now);
}

void KeyaCan::hear(const BusFrame& frame, std::uint64_t tag, Time now) {
  advance(now);
  if (!is_request(frame) || frame.size != longest_can_frame) return;
  if (drive_.booting() || !drive_.obeys(KeyaInterface::can)) return;
  const auto index = static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8);
  const std::uint8_t sub = frame.data[3];
  Data data;
  std::uint8_t told_sub = sub;
  if (frame.data[0] == write_command) {
    data = write(index, sub, static_cast<std::int32_t>(big_endian(std::span(frame.data).last(4))), now);
    if (!drive_.options().echoes_sub) told_sub = 0;
  } else if (frame.data[0] == read_command) {
    data = read(index, sub);
    if (data) drive_.heard_query(now);
  }
  if (!data) return;
  CanBytes reply{answered, frame.data[1], frame.data[2], told_sub};
  reply.insert(reply.end(), data->begin(), data->end());
  output_.push_back({tag, true, extended_frame(keya_can::reply + node(), reply)});
}

KeyaCan::Data KeyaCan::write(std::uint16_t index, std::uint8_t sub, std::int32_t value, Time now) {
  if (sub != both_subs[0] && sub != both_subs[1]) return std::nullopt;
  const KeyaMotorName motor = sub == 1 ? KeyaMotorName::a : KeyaMotorName::b;
  bool done = true;
  switch (index) {
    case 0x200D:
      drive_.enable(motor, std::nullopt, now);
      break;
    case 0x200C:
      drive_.disable(motor, now);
      break;
    case 0x2000:
      done = drive_.set_value(motor, value, KeyaMode::speed, now);
      break;
    case 0x2001:
      done = drive_.set_value(motor, value, KeyaMode::torque, now);
      break;
    case 0x2002:
      done = drive_.set_value(motor, value, KeyaMode::absolute, now);
      break;
    default:
      done = false;
  }
  if (!done) return std::nullopt;
  return std::array<std::uint8_t, 4>{};
}

KeyaCan::Data KeyaCan::read(std::uint16_t index, std::uint8_t sub) const {
  const KeyaMotor& a = drive_.at(KeyaMotorName::a);
  const KeyaMotor& b = drive_.at(KeyaMotorName::b);
  const KeyaMeasured& measured = drive_.measured();
  switch (index << 8 | sub) {
    case 0x210001:
      return two_words(a.current(), b.current());
    case 0x211201:
      return two_words(drive_.faults(KeyaMotorName::a), drive_.faults(KeyaMotorName::b));
    case 0x210301:
      return two_words(a.rpm(), b.rpm());
    case 0x210D02:
      return one_number(measured.voltage);
    case 0x210F01: {
      auto data = two_words(measured.temperature, 0);
      data[2] = static_cast<std::uint8_t>(measured.motor_temperature[0]);
      data[3] = static_cast<std::uint8_t>(measured.motor_temperature[1]);
      return data;
    }
    case 0x210402:
      return one_number(a.count());
    case 0x210403:
      return one_number(b.count());
    default:
      return std::nullopt;
  }
}

}  // namespace axisgate::simulated
