// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/keya_serial.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::uint8_t last_enable_code = 3;

using Place = std::span<std::uint8_t>;

void put_words(Place data, std::initializer_list<std::int64_t> words) {
  for (const std::int64_t word : words) {
    put_big_endian(data.first(2), word);
    data = data.subspan(2);
  }
}

void put_temperatures(Place data, const KeyaMeasured& measured, KeyaWiring wiring) {
  if (wiring == KeyaWiring::rs485) {
    put_words(data, {measured.temperature, measured.motor_temperature[0], measured.motor_temperature[1]});
    return;
  }
  put_words(data, {measured.temperature});
  data[2] = static_cast<std::uint8_t>(measured.motor_temperature[0]);
  data[3] = static_cast<std::uint8_t>(measured.motor_temperature[1]);
}

// False: the reply's layout is not documented, so there is none.
bool put_reply(Place data, const KeyaDrive& drive, KeyaWiring wiring, std::uint8_t code) {
  const KeyaMotor& a = drive.at(KeyaMotorName::a);
  const KeyaMotor& b = drive.at(KeyaMotorName::b);
  const KeyaMeasured& measured = drive.measured();
  switch (code) {
    case 0x00: {
      const auto state = drive.control_state();
      data[0] = state[0];
      data[1] = state[1];
      return true;
    }
    case 0x02:
      put_words(data, {a.rpm(), b.rpm()});
      return true;
    case 0x03:
      put_words(data, {a.current(), b.current()});
      return true;
    case 0x05:
      data[0] = measured.voltage;
      return true;
    case 0x06:
      put_temperatures(data, measured, wiring);
      return true;
    case 0x07:
      put_words(data, {drive.faults(KeyaMotorName::a), drive.faults(KeyaMotorName::b)});
      return true;
    case 0x08:
      put_big_endian(data.first(4), a.count());
      put_big_endian(data.subspan(4, 4), b.count());
      return true;
    case 0x09:
      put_big_endian(data.first(4), measured.version);
      return true;
    default:
      return false;
  }
}

void control(KeyaDrive& drive, KeyaWiring wiring, const KeyaFrame& frame, Time now) {
  const std::uint8_t code = frame[wiring == KeyaWiring::rs485 ? 2 : 1];
  if (!drive.obeys(interface_of(wiring)) || code > last_enable_code) return;
  const auto values = std::span(frame).subspan(wiring == KeyaWiring::rs485 ? 3 : 4, 8);
  drive.set_both(
      code,
      {static_cast<std::int32_t>(big_endian(values.first(4))), static_cast<std::int32_t>(big_endian(values.last(4)))},
      now);
}

}  // namespace

bool keya_hears(const KeyaDrive& drive, KeyaWiring wiring, const KeyaFrame& frame) {
  if (drive.booting()) return false;
  if (wiring == KeyaWiring::rs232) return true;
  return frame.back() == keya_sum(frame) && frame[1] == drive.options().node;
}

std::optional<std::uint8_t> keya_query(KeyaWiring wiring, const KeyaFrame& frame) {
  if (frame[0] != keya_start::query) return std::nullopt;
  return frame[wiring == KeyaWiring::rs485 ? 2 : 1];
}

std::optional<KeyaFrame> keya_answer(KeyaDrive& drive, KeyaWiring wiring, const KeyaFrame& frame, Time now) {
  drive.advance(now);
  if (frame[0] == keya_start::control) {
    control(drive, wiring, frame, now);
    return std::nullopt;
  }
  if (!drive.obeys(interface_of(wiring)) && !drive.options().queries_always) return std::nullopt;
  const bool rs485 = wiring == KeyaWiring::rs485;
  KeyaFrame reply{frame[0], frame[1]};
  if (rs485) reply[2] = frame[2];
  if (!put_reply(std::span(reply).subspan(rs485 ? 3 : 2), drive, wiring, frame[rs485 ? 2 : 1])) return std::nullopt;
  drive.heard_query(now);
  return rs485 ? seal_keya(reply) : reply;
}

KeyaFrame keya_heartbeat(const KeyaDrive& drive) {
  KeyaFrame frame{keya_start::heartbeat};
  const std::span<std::uint8_t> all(frame);
  put_big_endian(all.subspan(1, 2), drive.at(KeyaMotorName::a).electrical_angle());
  put_big_endian(all.subspan(3, 2), drive.faults(KeyaMotorName::a));
  frame[5] = static_cast<std::uint8_t>(drive.measured().temperature);
  frame[6] = drive.measured().voltage;
  put_big_endian(all.subspan(7, 2), drive.at(KeyaMotorName::b).electrical_angle());
  return seal_keya(frame);
}

}  // namespace axisgate::simulated
