// SPDX-License-Identifier: Apache-2.0
// How an exchange is said in Modbus RTU frames, and which frame answers it (Modbus application protocol V1.1b3, 6.1
// to 6.6, 6.12 and 7). Promises that a frame is taken for the answer only if all it says fits: unit, function, length,
// and of a write the echo of what was asked. Never looks at anything but its arguments; the CRC is the link's.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "adapters/modbus_rtu/rtu_link.hpp"

namespace axisgate::modbus_rtu {

enum class Function : std::uint8_t {
  read_coils = 0x01,
  read_discrete_inputs = 0x02,
  read_holding_registers = 0x03,
  read_input_registers = 0x04,
  write_single_coil = 0x05,
  write_single_register = 0x06,
  write_multiple_registers = 0x10,
};
/// Added to the function of a request, it makes the function of its error reply.
inline constexpr std::uint8_t kErrorBit = 0x80;
/// Bytes of an error reply: unit, function, exception code.
inline constexpr std::size_t kErrorFrame = 3;
/// Registers that one read may ask for.
inline constexpr std::size_t kMaxReadRegisters = 125;

/// What is particular to one drive.
struct RtuNode {
  std::uint8_t node = 1;
  bool low_word_first = false;  ///< of a 32-bit value: which half stands in the lower register
  /// Function bytes that mean an error reply of a read although they are not the function + 0x80 (0x81 on Kinco: its
  /// writes keep to the standard).
  std::vector<std::uint8_t> error_functions{};
  Duration worst_reply = std::chrono::milliseconds(500);  ///< it answers by then, or not at all
  std::optional<std::uint8_t> broadcast{};  ///< a unit that all drives of its type obey, beside the standard's 0
};

/// Unit and PDU.
using Frame = boost::container::static_vector<Byte, kMaxFrame>;

/// Registers that an object of `size` bytes takes.
[[nodiscard]] constexpr std::size_t registers_of(std::uint8_t size) { return size == 4 ? 2 : 1; }
/// Registers that it reads or writes, from the first of `object` to the last of the last of `more`.
[[nodiscard]] std::size_t registers_asked(const bus::Exchange& exchange);

/// A read of at most kMaxReadRegisters; a write of 1 or 2 bytes as one register, of 4 as two at once, never a half; of
/// several objects all of them at once.
[[nodiscard]] Frame request_of(const bus::Exchange& exchange, const RtuNode& node);

/// Bytes on the wire, CRC included, of the request and of the answer that is no error.
[[nodiscard]] std::size_t request_bytes(const bus::Exchange& exchange);
[[nodiscard]] std::size_t reply_bytes(const bus::Exchange& exchange);

/// Why a frame does not answer the exchange.
enum class NotMine : std::uint8_t { other_unit, other_function, wrong_length, wrong_echo, malformed };
[[nodiscard]] std::string_view text(NotMine reason);

using Judgement = std::variant<bus::ExchangeResult, NotMine>;
/// `exchange` is one that is answered, no broadcast. Of a read the fields come in order of their registers.
[[nodiscard]] Judgement judge(Bytes frame, const bus::Exchange& exchange, const RtuNode& node);

/// Whether it can be a reply to any request of ours.
[[nodiscard]] bool well_formed(Bytes frame);

}  // namespace axisgate::modbus_rtu
