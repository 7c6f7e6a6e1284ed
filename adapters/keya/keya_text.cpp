// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_text.hpp"

#include <fmt/format.h>

#include <string_view>

#include "adapters/keya/keya_can_codec.hpp"
#include "adapters/keya/keya_fields.hpp"

namespace axisgate::keya {

namespace {

std::uint16_t u16(Bytes data, std::size_t at) { return load_be16(data, at); }
std::int16_t i16(Bytes data, std::size_t at) { return static_cast<std::int16_t>(load_be16(data, at)); }
std::int8_t i8(Bytes data, std::size_t at) { return static_cast<std::int8_t>(data[at]); }
std::int32_t i32(Bytes data, std::size_t at) { return static_cast<std::int32_t>(load_be(data, at, 4)); }

constexpr std::array<std::string_view, kQueries> kNames{
    "control state", "electrical angle", "speed",  "current", "mechanical angle",
    "voltage",       "temperature",      "faults", "encoder", "version"};

std::string_view name_of(Query query) { return kNames.at(static_cast<std::size_t>(query)); }

/// What the three protocols lay out alike: a pair of 16-bit words.
std::string pair_text(Query query, Bytes data) {
  switch (query) {
    case Query::speed:
      return fmt::format("A {}, B {}", i16(data, 0), i16(data, 2));
    case Query::faults:
      return fmt::format("A 0x{:04X}, B 0x{:04X}", u16(data, 0), u16(data, 2));
    default:
      return fmt::format("A {}, B {}", u16(data, 0), u16(data, 2));
  }
}

std::string temperatures_text(int drive, int a, int b) { return fmt::format("drive {}, A {}, B {}", drive, a, b); }

// --- CAN ------------------------------------------------------------------------------------------------------------

std::string motor_text(std::uint8_t sub) {
  switch (sub) {
    case 0:
      return "";  // other drives of this maker acknowledge so
    case 1:
      return " of motor A";
    case 2:
      return " of motor B";
    default:
      return fmt::format(" of motor {}", sub);
  }
}

std::string command_text(const CanMessage& message) {
  static constexpr std::array<std::string_view, 3> kSetpoints{"speed", "torque", "position"};
  const std::string motor = motor_text(message.sub);
  if (message.index == 0x200D) return "enable" + motor;
  if (message.index == 0x200C) return "disable" + motor;
  const std::size_t setpoint = message.index - 0x2000U;
  const std::string name =
      setpoint < kSetpoints.size() ? std::string(kSetpoints[setpoint]) : fmt::format("command {:04X}", message.index);
  if (message.command == CanMessage::Command::reply) return name + motor;
  return fmt::format("{}{} = {}", name, motor, i32(message.data, 0));
}

std::string query_text(const CanMessage& message) {
  const bool value = message.command == CanMessage::Command::reply;
  const auto with_pair = [&](Query query) {
    return std::string(name_of(query)) + (value ? ": " + pair_text(query, message.data) : "");
  };
  switch (message.index) {
    case 0x2100:
      return with_pair(Query::current);
    case 0x2103:
      return with_pair(Query::speed);
    case 0x2112:
      return with_pair(Query::faults);
    case 0x2104:  // sub-index 2 is motor A
      return fmt::format("encoder {}", message.sub == 2   ? "A"
                                       : message.sub == 3 ? "B"
                                                          : fmt::format("{}", message.sub)) +
             (value ? fmt::format(": {}", i32(message.data, 0)) : "");
    case 0x210D:
      return std::string("voltage") + (value ? fmt::format(": {}", message.data[3]) : "");
    case 0x210F:
      return std::string("temperature") +
             (value ? ": " + temperatures_text(i16(message.data, 0), i8(message.data, 2), i8(message.data, 3)) : "");
    default:
      return fmt::format("{:04X}.{:02X}", message.index, message.sub) +
             (value ? fmt::format(": 0x{:08X}", load_be(message.data, 0, 4)) : "");
  }
}

std::string heartbeat_text(Bytes bytes) {
  return fmt::format("heartbeat: angle A {}, B {}, faults A 0x{:04X}, state 0x{:04X}", u16(bytes, 0), u16(bytes, 2),
                     u16(bytes, 4), u16(bytes, 6));
}

// --- Serial ---------------------------------------------------------------------------------------------------------

std::string control_text(const SerialFrame& frame) {
  const auto on = [&](unsigned bit) { return (frame.code >> bit & 1U) != 0 ? "on" : "off"; };
  return fmt::format("control: A {} {}, B {} {}", on(0), i32(frame.data, 0), on(1), i32(frame.data, 4));
}

std::string serial_value_text(KeyaLine line, Query query, Bytes data) {
  switch (query) {
    case Query::speed:
    case Query::current:
    case Query::faults:
      return pair_text(query, data);
    case Query::voltage:
      return fmt::format("{}", data[0]);
    case Query::temperature:
      return line == KeyaLine::rs232 ? temperatures_text(i16(data, 0), i8(data, 2), i8(data, 3))
                                     : temperatures_text(i16(data, 0), i16(data, 2), i16(data, 4));
    case Query::encoder:
      return fmt::format("A {}, B {}", i32(data, 0), i32(data, 4));
    case Query::version:
      return fmt::format("{}", load_be(data, 0, 4));
    default:
      return hex_text(data);
  }
}

}  // namespace

std::string describe(const can::CanFrame& frame) {
  if (const auto origin = origin_of(frame); origin && origin->kind == CanOrigin::Kind::heartbeat) {
    return frame.bytes().size() == kHeartbeatBytes ? heartbeat_text(frame.bytes()) : "no heartbeat";
  }
  const auto message = decode(frame.bytes());
  if (!message) return "no frame of this protocol";
  const std::string text = is_command(message->index) ? command_text(*message) : query_text(*message);
  switch (message->command) {
    case CanMessage::Command::read:
      return "query " + text;
    case CanMessage::Command::write:
      return text;
    case CanMessage::Command::reply:
      return is_command(message->index) ? "acknowledged: " + text : text;
  }
  return text;
}

std::string describe_request(const SerialFrame& frame) {
  if (frame.start == kControl) return control_text(frame);
  return "query " + std::string(name_of(static_cast<Query>(frame.code)));
}

std::string describe_answer(KeyaLine line, const SerialFrame& frame) {
  if (frame.start == kControl) return control_text(frame);
  if (frame.start == kHeartbeat) {
    return fmt::format("heartbeat: angle A {}, B {}, faults A 0x{:04X}, drive {} degC, {} V{}", u16(frame.data, 0),
                       u16(frame.data, 6), u16(frame.data, 2), i8(frame.data, 4), frame.data[5],
                       frame.sum_as_believed ? "" : "  (odd sum)");
  }
  const auto query = static_cast<Query>(frame.code);
  return std::string(name_of(query)) + ": " + serial_value_text(line, query, Bytes(frame.data).first(data_size(line)));
}

}  // namespace axisgate::keya
