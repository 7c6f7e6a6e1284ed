// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

#include <optional>

namespace axisgate::modbus_tcp {
namespace {

using Checked = std::optional<ModbusException>;
constexpr ModbusException kBad = ModbusException::illegal_data_value;
constexpr std::uint16_t kCoilOn = 0xFF00;

[[nodiscard]] bool counted(std::uint16_t count, std::uint16_t most) { return count >= 1 && count <= most; }

Checked read_part(Bytes pdu, Request& request, std::uint16_t most) {
  if (pdu.size() != 5) return kBad;
  request.read_address = load_be16(pdu, 1);
  request.read_count = load_be16(pdu, 3);
  return counted(request.read_count, most) ? Checked{} : kBad;
}

Checked single_write(Bytes pdu, Request& request) {
  if (pdu.size() != 5) return kBad;
  request.write_address = load_be16(pdu, 1);
  request.write_count = 1;
  const std::uint16_t value = load_be16(pdu, 3);
  if (request.function == Function::write_single_coil) {
    if (value != 0 && value != kCoilOn) return kBad;
    request.data.push_back(value == kCoilOn ? 1 : 0);
  } else {
    request.data.assign(pdu.begin() + 3, pdu.end());
  }
  return {};
}

Checked several_writes(Bytes pdu, Request& request, std::size_t head, std::uint16_t most, bool coils) {
  if (pdu.size() < head + 5) return kBad;
  request.write_address = load_be16(pdu, head);
  request.write_count = load_be16(pdu, head + 2);
  const std::size_t bytes = pdu[head + 4];
  const std::size_t wanted = coils ? (request.write_count + 7U) / 8U : 2U * request.write_count;
  if (!counted(request.write_count, most) || bytes != wanted || pdu.size() != head + 5 + bytes) return kBad;
  const Bytes data = pdu.subspan(head + 5);
  request.data.assign(data.begin(), data.end());
  return {};
}

Checked mask_write(Bytes pdu, Request& request) {
  if (pdu.size() != 7) return kBad;
  request.write_address = load_be16(pdu, 1);
  request.write_count = 1;
  request.and_mask = load_be16(pdu, 3);
  request.or_mask = load_be16(pdu, 5);
  return {};
}

Checked read_and_write(Bytes pdu, Request& request) {
  if (pdu.size() < 10) return kBad;
  request.read_address = load_be16(pdu, 1);
  request.read_count = load_be16(pdu, 3);
  if (!counted(request.read_count, kMaxReadRegisters)) return kBad;
  return several_writes(pdu, request, 5, kMaxExchangeWrites, false);
}

Checked diagnostics(Bytes pdu, Request& request) {
  // Sub-function and N x 2 bytes of data (6.8); which sub-functions exist is looked up where they are carried out.
  if (pdu.size() < 5 || pdu.size() % 2 == 0) return kBad;
  request.sub_function = load_be16(pdu, 1);
  request.data.assign(pdu.begin() + 3, pdu.end());
  return {};
}

Checked general_reference(Bytes pdu, Request& request) {
  request.reference = decode_reference(pdu);
  if (!request.reference) return kBad;
  const Bytes data = pdu.subspan(request.reference->data_at());
  request.data.assign(data.begin(), data.end());
  return {};
}

Checked encapsulated(Bytes pdu, Request& request) {
  if (pdu.size() < 2) return kBad;
  if (pdu[1] == kGeneralReference) return general_reference(pdu, request);
  if (pdu[1] != kDeviceIdentification) return ModbusException::illegal_function;
  if (pdu.size() != 4 || pdu[2] < 1 || pdu[2] > 4) return kBad;
  request.identification = pdu[2];
  request.object = pdu[3];
  return {};
}

Checked decode_into(Bytes pdu, Request& request) {
  request.function = Function{pdu[0]};
  switch (request.function) {
    case Function::read_coils:
    case Function::read_discrete_inputs:
      return read_part(pdu, request, kMaxReadBits);
    case Function::read_holding_registers:
    case Function::read_input_registers:
      return read_part(pdu, request, kMaxReadRegisters);
    case Function::write_single_coil:
    case Function::write_single_register:
      return single_write(pdu, request);
    case Function::diagnostics:
      return diagnostics(pdu, request);
    case Function::write_multiple_coils:
      return several_writes(pdu, request, 1, kMaxWriteCoils, true);
    case Function::write_multiple_registers:
      return several_writes(pdu, request, 1, kMaxWriteRegisters, false);
    case Function::mask_write_register:
      return mask_write(pdu, request);
    case Function::read_write_registers:
      return read_and_write(pdu, request);
    case Function::encapsulated_interface:
      return encapsulated(pdu, request);
  }
  return ModbusException::illegal_function;
}

void put_be16(Pdu& pdu, std::uint16_t value) {
  pdu.push_back(static_cast<Byte>(value >> 8));
  pdu.push_back(static_cast<Byte>(value & 0xFF));
}

}  // namespace

std::variant<Request, ModbusException> decode_request(Bytes pdu) {
  std::variant<Request, ModbusException> decoded;
  if (const Checked wrong = decode_into(pdu, std::get<Request>(decoded))) decoded = *wrong;
  return decoded;
}

bool is_write_function(std::uint8_t function) {
  switch (Function{function}) {
    case Function::write_single_coil:
    case Function::write_single_register:
    case Function::write_multiple_coils:
    case Function::write_multiple_registers:
    case Function::mask_write_register:
    case Function::read_write_registers:
      return true;
    default:
      return false;
  }
}

Pdu exception_pdu(std::uint8_t function, ModbusException exception) {
  return {static_cast<Byte>(function | 0x80U), static_cast<Byte>(exception)};
}

Pdu write_reply(const Request& request) {
  Pdu pdu{static_cast<Byte>(request.function)};
  put_be16(pdu, request.write_address);
  switch (request.function) {
    case Function::write_single_coil:
      put_be16(pdu, request.data[0] != 0 ? kCoilOn : std::uint16_t{0});
      break;
    case Function::write_single_register:
      put_be16(pdu, request.written_register(0));
      break;
    case Function::mask_write_register:
      put_be16(pdu, request.and_mask);
      put_be16(pdu, request.or_mask);
      break;
    default:
      put_be16(pdu, request.write_count);
      break;
  }
  return pdu;
}

Pdu read_reply(Function function, std::size_t data_bytes) {
  Pdu pdu(kReadReplyHead + data_bytes, Byte{0});
  pdu[0] = static_cast<Byte>(function);
  pdu[1] = static_cast<Byte>(data_bytes);
  return pdu;
}

}  // namespace axisgate::modbus_tcp
