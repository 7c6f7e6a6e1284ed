// SPDX-License-Identifier: Apache-2.0
// The PDU codec: what a request asks, and the forms of its answers (MODBUS Application Protocol V1.1b3 section 6).
// Promises that a decoded request has lengths, counts and byte counts that agree, within the limits of its function.
// Never looks at addresses: whether one exists is the register map's to say.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>
#include <variant>

#include "gateway/core/bytes.hpp"
#include "gateway/core/error.hpp"
#include "gateway/upstream/modbus_tcp/wire/general_reference.hpp"
#include "gateway/upstream/modbus_tcp/wire/mbap.hpp"

namespace axisgate::modbus_tcp {

enum class Function : std::uint8_t {
  read_coils = 1,
  read_discrete_inputs = 2,
  read_holding_registers = 3,
  read_input_registers = 4,
  write_single_coil = 5,
  write_single_register = 6,
  diagnostics = 8,
  write_multiple_coils = 15,
  write_multiple_registers = 16,
  mask_write_register = 22,
  read_write_registers = 23,
  encapsulated_interface = 43,
};

inline constexpr std::uint16_t kMaxReadBits = 2000;        ///< 6.1, 6.2
inline constexpr std::uint16_t kMaxReadRegisters = 125;    ///< 6.3, 6.4, 6.17
inline constexpr std::uint16_t kMaxWriteCoils = 1968;      ///< 6.11
inline constexpr std::uint16_t kMaxWriteRegisters = 123;   ///< 6.12
inline constexpr std::uint16_t kMaxExchangeWrites = 121;   ///< 6.17
inline constexpr std::uint8_t kDeviceIdentification = 14;  ///< MEI type, 6.21

struct Request {
  Function function = Function::read_coils;
  // What is read: functions 1 to 4 and 23.
  std::uint16_t read_address = 0;
  std::uint16_t read_count = 0;
  // What is written: functions 5, 6, 15, 16, 22 and 23.
  std::uint16_t write_address = 0;
  std::uint16_t write_count = 0;
  /// Written registers, most significant byte first, or coils, eight a byte from bit 0; of function 8 the data; of
  /// 43/13 what is written.
  boost::container::static_vector<Byte, kMaxPdu> data;
  std::uint16_t and_mask = 0;                   ///< 22
  std::uint16_t or_mask = 0;                    ///< 22
  std::uint16_t sub_function = 0;               ///< 8
  std::uint8_t identification = 0;              ///< 43/14: 1 basic, 2 regular, 3 extended, 4 one object
  std::uint8_t object = 0;                      ///< 43/14: where to begin, or which one
  std::optional<GeneralReference> reference{};  ///< 43/13

  // Of the map; function 43/13 does neither.
  [[nodiscard]] bool reads() const { return read_count != 0; }
  [[nodiscard]] bool writes() const { return write_count != 0; }
  [[nodiscard]] bool writes_coils() const {
    return function == Function::write_single_coil || function == Function::write_multiple_coils;
  }
  [[nodiscard]] std::uint16_t written_register(std::size_t i) const { return load_be16(data, 2 * i); }
  [[nodiscard]] bool written_coil(std::size_t i) const { return ((data[i / 8] >> (i % 8)) & 1) != 0; }
};

/// `pdu`: 1..253 bytes. Exceptions: illegal_function, illegal_data_value for lengths and counts (6.x state diagrams).
[[nodiscard]] std::variant<Request, ModbusException> decode_request(Bytes pdu);

/// Functions 5, 6, 15, 16, 22 and 23, whatever stands behind.
[[nodiscard]] bool is_write_function(std::uint8_t function);

/// `function` as it was in the request, known or not (section 7).
[[nodiscard]] Pdu exception_pdu(std::uint8_t function, ModbusException exception);
/// Answers of functions 5, 6, 15, 16 and 22 repeat the head of the request.
[[nodiscard]] Pdu write_reply(const Request& request);
/// Functions 1 to 4 and 23: function, byte count and so many bytes, all 0, for the reader to fill.
[[nodiscard]] Pdu read_reply(Function function, std::size_t data_bytes);
inline constexpr std::size_t kReadReplyHead = 2;

}  // namespace axisgate::modbus_tcp
