// SPDX-License-Identifier: Apache-2.0
#include "adapters/modbus_rtu/rtu_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "gateway/core/name_table.hpp"

namespace axisgate::modbus_rtu {

namespace {

std::string place(Bytes frame, std::size_t at) {
  const std::uint16_t number = load_be16(frame, at);
  return fmt::format("{} (0x{:04X})", number, number);
}

std::string registers(std::size_t count) { return fmt::format("{} register{}", count, count == 1 ? "" : "s"); }

std::string words(Bytes data) {
  std::string out = " =";
  for (std::size_t at = 0; at + 2 <= data.size(); at += 2) out += fmt::format(" 0x{:04X}", load_be16(data, at));
  return out;
}

/// V1.1b3, 7.
std::string_view exception_name(std::uint8_t code) {
  static constexpr auto kNames = names_of<std::uint8_t>({
      {0x01, "illegal function"},
      {0x02, "illegal data address"},
      {0x03, "illegal data value"},
      {0x04, "device failure"},
      {0x05, "acknowledged, it takes long"},
      {0x06, "device busy"},
      {0x07, "not acknowledged"},
      {0x08, "memory parity error"},
      {0x0A, "gateway path unavailable"},
      {0x0B, "gateway target does not respond"},
  });
  return kNames.of(code, "unknown code");
}

std::string unnamed(Bytes frame) {
  if (frame.size() < 2) return fmt::format("{} bytes", frame.size());
  return fmt::format("unit {}: function 0x{:02X}, {} bytes", frame[0], frame[1], frame.size());
}

}  // namespace

std::string describe_request(Bytes frame) {
  if (frame.size() < 6) return unnamed(frame);
  const std::string unit = fmt::format("unit {}: ", frame[0]);
  switch (static_cast<Function>(frame[1])) {
    case Function::read_coils:
      return unit + "read coil " + place(frame, 2);
    case Function::read_discrete_inputs:
      return unit + "read discrete input " + place(frame, 2);
    case Function::read_holding_registers:
      return unit + "read " + registers(load_be16(frame, 4)) + " at " + place(frame, 2);
    case Function::read_input_registers:
      return unit + "read input " + registers(load_be16(frame, 4)) + " at " + place(frame, 2);
    case Function::write_single_coil:
      return unit + "write coil " + place(frame, 2) + words(frame.subspan(4));
    case Function::write_single_register:
      return unit + "write " + place(frame, 2) + words(frame.subspan(4));
    case Function::write_multiple_registers:
      return unit + "write " + place(frame, 2) + words(frame.subspan(std::min<std::size_t>(7, frame.size())));
  }
  return unnamed(frame);
}

std::string describe_reply(Bytes frame) {
  if (!well_formed(frame)) return unnamed(frame);
  const std::string unit = fmt::format("unit {}: ", frame[0]);
  if ((frame[1] & kErrorBit) != 0) {
    return unit + fmt::format("error 0x{:02X}: {} (0x{:02X})", frame[1], exception_name(frame[2]), frame[2]);
  }
  switch (static_cast<Function>(frame[1])) {
    case Function::read_coils:
    case Function::read_discrete_inputs:
      return unit + fmt::format("bits = 0x{:02X}", frame[3]);
    case Function::read_holding_registers:
    case Function::read_input_registers:
      return unit + registers((frame.size() - 3) / 2) + words(frame.subspan(3));
    case Function::write_single_coil:
      return unit + "written coil " + place(frame, 2) + words(frame.subspan(4));
    case Function::write_single_register:
      return unit + "written " + place(frame, 2) + words(frame.subspan(4));
    case Function::write_multiple_registers:
      return unit + "written " + registers(load_be16(frame, 4)) + " at " + place(frame, 2);
  }
  return unnamed(frame);
}

}  // namespace axisgate::modbus_rtu
