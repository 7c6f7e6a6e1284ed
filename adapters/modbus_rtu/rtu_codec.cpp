// SPDX-License-Identifier: Apache-2.0
#include "adapters/modbus_rtu/rtu_codec.hpp"

#include <algorithm>
#include <cassert>

#include "gateway/core/name_table.hpp"
#include "gateway/core/rtu_crc.hpp"

namespace axisgate::modbus_rtu {

namespace {

// Where things stand in a frame; the unit comes first, the function second.
constexpr std::size_t kAddressAt = 2;  // of a request, and of the reply to a write
constexpr std::size_t kCountAt = 4;    // as kAddressAt; of one register: its value
constexpr std::size_t kDataSizeAt = 2;
constexpr std::size_t kDataAt = 3;  // of the reply to a read
constexpr std::size_t kErrorCodeAt = 2;
constexpr std::size_t kWriteReplyFrame = 6;
constexpr std::size_t kWriteDataAt = 7;  // of a request that writes several registers

bool is_read(const bus::Exchange& exchange) { return exchange.access == bus::Access::read; }

Function function_of(const bus::Exchange& exchange) {
  const auto table = static_cast<ModbusTable>(exchange.object.sub);
  if (is_read(exchange)) {
    if (table == ModbusTable::coil) return Function::read_coils;
    if (table == ModbusTable::discrete) return Function::read_discrete_inputs;
    return table == ModbusTable::input ? Function::read_input_registers : Function::read_holding_registers;
  }
  if (table == ModbusTable::coil) return Function::write_single_coil;
  const bool several = exchange.size == 4 || !exchange.more.empty();
  return several ? Function::write_multiple_registers : Function::write_single_register;
}

/// It reads bits, eight in a byte.
bool reads_bits(Function function) {
  return function == Function::read_coils || function == Function::read_discrete_inputs;
}

/// Of a write of one register: the value goes in whole, of one byte in the low half (Kinco JD, 8.2: mode 6 is 00 06).
/// Of a coil: on or off.
std::uint16_t register_of(const bus::Exchange& exchange) {
  constexpr std::uint16_t kOn = 0xFF00;
  if (function_of(exchange) == Function::write_single_coil) return exchange.raw == 0 ? std::uint16_t{0} : kOn;
  return static_cast<std::uint16_t>(exchange.raw & (exchange.size == 1 ? 0xFFU : 0xFFFFU));
}

void push_be16(Frame& frame, std::size_t value) {
  frame.resize(frame.size() + 2);
  store_be16({frame.data(), frame.size()}, frame.size() - 2, static_cast<std::uint16_t>(value));
}

void push_value(Frame& frame, std::uint32_t raw, std::uint8_t size, bool low_word_first) {
  if (size != 4) return push_be16(frame, raw & (size == 1 ? 0xFFU : 0xFFFFU));
  push_be16(frame, low_word_first ? raw & 0xFFFF : raw >> 16);
  push_be16(frame, low_word_first ? raw >> 16 : raw & 0xFFFF);
}

std::uint32_t value_at(Bytes registers, std::size_t first, std::uint8_t size, bool low_word_first) {
  const std::uint32_t word = load_be16(registers, 2 * first);
  if (size == 1) return word & 0xFF;
  if (size != 4) return word;
  const std::uint32_t next = load_be16(registers, 2 * (first + 1));
  return low_word_first ? (next << 16) | word : (word << 16) | next;
}

/// Neither the function nor the register is there. All other codes, unknown ones included, may pass.
bool is_for_ever(std::uint8_t code) { return code == 1 || code == 2; }

bool is_error_of(std::uint8_t function, Function asked, const RtuNode& node) {
  if (function == (static_cast<std::uint8_t>(asked) | kErrorBit)) return true;
  const bool reads = asked <= Function::read_input_registers;
  return reads && std::ranges::find(node.error_functions, function) != node.error_functions.end();
}

bus::ExchangeResult refusal(std::uint8_t code) {
  return {.code = Errc::refused_by_drive, .detail = code, .for_now = !is_for_ever(code)};
}

/// Byte count and length of a read's reply agree.
bool holds_registers(Bytes frame) {
  return frame.size() > kDataAt && frame.size() == kDataAt + frame[kDataSizeAt] && frame[kDataSizeAt] % 2 == 0;
}

/// One byte with one bit in it.
Judgement judge_bit(Bytes frame, const bus::Exchange& exchange) {
  if (frame.size() <= kDataAt || frame.size() != kDataAt + frame[kDataSizeAt]) return NotMine::malformed;
  if (frame.size() != kDataAt + 1) return NotMine::wrong_length;
  bus::ExchangeResult result;
  result.fields.push_back({exchange.object, exchange.size, frame[kDataAt] & 1U});
  return result;
}

Judgement judge_read(Bytes frame, const bus::Exchange& exchange, const RtuNode& node) {
  if (reads_bits(function_of(exchange))) return judge_bit(frame, exchange);
  if (!holds_registers(frame)) return NotMine::malformed;
  const Bytes registers = frame.subspan(kDataAt);
  if (registers.size() != 2 * registers_asked(exchange)) return NotMine::wrong_length;
  bus::ExchangeResult result;
  const auto take = [&](ObjectAddress object, std::uint8_t size) {
    const auto first = static_cast<std::size_t>(object.index - exchange.object.index);
    result.fields.push_back({object, size, value_at(registers, first, size, node.low_word_first)});
  };
  take(exchange.object, exchange.size == 0 ? std::uint8_t{2} : exchange.size);
  for (const bus::Neighbour& neighbour : exchange.more) take(neighbour.object, neighbour.size);
  return result;
}

Judgement judge_write(Bytes frame, const bus::Exchange& exchange) {
  if (frame.size() != kWriteReplyFrame) return NotMine::malformed;
  const bool several = function_of(exchange) == Function::write_multiple_registers;
  const std::size_t echo = several ? registers_asked(exchange) : register_of(exchange);
  const bool same = load_be16(frame, kAddressAt) == exchange.object.index && load_be16(frame, kCountAt) == echo;
  if (!same) return NotMine::wrong_echo;
  return bus::ExchangeResult{};
}

}  // namespace

std::size_t registers_asked(const bus::Exchange& exchange) {
  if (exchange.more.empty()) return registers_of(exchange.size);
  const bus::Neighbour& last = exchange.more.back();
  assert(last.object.index > exchange.object.index);
  return static_cast<std::size_t>(last.object.index - exchange.object.index) + registers_of(last.size);
}

Frame request_of(const bus::Exchange& exchange, const RtuNode& node) {
  const Function function = function_of(exchange);
  Frame frame{exchange.node, static_cast<Byte>(function)};
  push_be16(frame, exchange.object.index);
  if (is_read(exchange)) {
    const std::size_t count = registers_asked(exchange);
    assert(count <= kMaxReadRegisters && exchange.object.index + count <= 0x10000);
    push_be16(frame, count);
    return frame;
  }
  assert(exchange.size == 1 || exchange.size == 2 || exchange.size == 4);
  if (function != Function::write_multiple_registers) {
    push_be16(frame, register_of(exchange));
    return frame;
  }
  const std::size_t count = registers_asked(exchange);
  assert(exchange.object.index + count <= 0x10000);
  push_be16(frame, count);
  frame.push_back(static_cast<Byte>(2 * count));
  push_value(frame, exchange.raw, exchange.size, node.low_word_first);
  for (const bus::Neighbour& each : exchange.more) push_value(frame, each.raw, each.size, node.low_word_first);
  assert(frame.size() == kWriteDataAt + 2 * count);  // no holes: what lies between would be written too
  return frame;
}

std::size_t request_bytes(const bus::Exchange& exchange) { return request_of(exchange, RtuNode{}).size() + kCrcSize; }

std::size_t reply_bytes(const bus::Exchange& exchange) {
  if (reads_bits(function_of(exchange))) return kCrcSize + kDataAt + 1;
  return kCrcSize + (is_read(exchange) ? kDataAt + 2 * registers_asked(exchange) : kWriteReplyFrame);
}

std::string_view text(NotMine reason) {
  static constexpr auto kNames = names_of<NotMine>({
      {NotMine::other_unit, "from another unit"},
      {NotMine::other_function, "another function"},
      {NotMine::wrong_length, "another length"},
      {NotMine::wrong_echo, "another echo"},
      {NotMine::malformed, "malformed"},
  });
  static_assert(kNames.has_all_to(NotMine::malformed));
  return kNames.of(reason);
}

Judgement judge(Bytes frame, const bus::Exchange& exchange, const RtuNode& node) {
  if (frame.size() < kErrorFrame) return NotMine::malformed;
  if (frame[0] != exchange.node) return NotMine::other_unit;
  const Function asked = function_of(exchange);
  if (is_error_of(frame[1], asked, node)) {
    return frame.size() == kErrorFrame ? Judgement(refusal(frame[kErrorCodeAt])) : NotMine::malformed;
  }
  if (frame[1] != static_cast<std::uint8_t>(asked)) return NotMine::other_function;
  return is_read(exchange) ? judge_read(frame, exchange, node) : judge_write(frame, exchange);
}

bool well_formed(Bytes frame) {
  if (frame.size() < kErrorFrame) return false;
  if ((frame[1] & kErrorBit) != 0) return frame.size() == kErrorFrame;
  switch (static_cast<Function>(frame[1])) {
    case Function::read_coils:
    case Function::read_discrete_inputs:
      return frame.size() > kDataAt && frame.size() == kDataAt + frame[kDataSizeAt];
    case Function::read_holding_registers:
    case Function::read_input_registers:
      return holds_registers(frame);
    case Function::write_single_coil:
    case Function::write_single_register:
    case Function::write_multiple_registers:
      return frame.size() == kWriteReplyFrame;
  }
  return false;
}

}  // namespace axisgate::modbus_rtu
