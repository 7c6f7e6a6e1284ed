// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/wire/diagnostics.hpp"

#include <algorithm>
#include <initializer_list>

namespace axisgate::modbus_tcp {
namespace {

constexpr std::uint16_t kReturnQueryData = 0;
constexpr std::uint16_t kClearCounters = 10;

/// nullptr where the sub-function shows no counter.
const std::uint32_t* counter(const DiagnosticCounters& counters, std::uint16_t sub_function) {
  switch (sub_function) {
    case 11:
      return &counters.messages;
    case 12:
      return &counters.malformed;
    case 13:
      return &counters.exceptions;
    case 14:
      return &counters.server_messages;
    case 15:
      return &counters.unanswered;
    default:
      return nullptr;
  }
}

}  // namespace

Pdu answer_diagnostics(const Request& request, Role role, DiagnosticCounters& counters) {
  const auto refuse = [&](ModbusException why) { return exception_pdu(static_cast<Byte>(request.function), why); };
  const std::uint16_t sub = request.sub_function;
  const std::uint32_t* shown = counter(counters, sub);
  const bool known = sub == kReturnQueryData || sub == kClearCounters || shown != nullptr;
  const Role needed = sub == kClearCounters ? Role::engineer : Role::viewer;
  if (!known || role < needed) return refuse(ModbusException::illegal_function);
  // 6.8.1: but for sub-function 0 the request's data field is one word, 0.
  const bool zero_word = request.data.size() == 2 && request.data[0] == 0 && request.data[1] == 0;
  if (sub != kReturnQueryData && !zero_word) return refuse(ModbusException::illegal_data_value);

  Pdu pdu{static_cast<Byte>(request.function), static_cast<Byte>(sub >> 8), static_cast<Byte>(sub & 0xFF)};
  pdu.insert(pdu.end(), request.data.begin(), request.data.end());
  if (shown != nullptr) store_be16(pdu, 3, static_cast<std::uint16_t>(*shown & 0xFFFF));
  if (sub == kClearCounters) counters = {};
  return pdu;
}

}  // namespace axisgate::modbus_tcp
