// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_can_exchange.hpp"

#include <algorithm>
#include <cassert>

#include "adapters/keya/keya_fields.hpp"

namespace axisgate::keya {

namespace {

constexpr std::uint8_t kMotors = 2;

std::optional<bus::ExchangeResult> refusal_of_read(const bus::Exchange& exchange) {
  assert(std::ranges::all_of(exchange.more, [&](const bus::Neighbour& neighbour) {
    return neighbour.object.index == exchange.object.index && neighbour.object.sub == exchange.object.sub;
  }));
  if (is_command(exchange.object.index)) return refused(kWriteOnly);
  if (!within(exchange, std::tuple_size_v<decltype(CanMessage::data)>)) return refused(kWrongLength);
  return std::nullopt;
}

std::optional<bus::ExchangeResult> refusal_of_can_write(const bus::Exchange& exchange) {
  if (!is_command(exchange.object.index)) return refused(kReadOnly);
  if (exchange.object.sub == 0 || exchange.object.sub > kMotors) return refused(kNoSubIndex);
  if (exchange.size != 4 || exchange.object.byte != 0 || !exchange.more.empty() || exchange.bytes)
    return refused(kWrongLength);
  return std::nullopt;
}

}  // namespace

std::optional<bus::ExchangeResult> refusal_of(const bus::Exchange& exchange) {
  assert(exchange.access != bus::Access::command);
  return exchange.access == bus::Access::read ? refusal_of_read(exchange) : refusal_of_can_write(exchange);
}

CanMessage request_of(const bus::Exchange& exchange) {
  CanMessage message{.index = exchange.object.index, .sub = exchange.object.sub};
  if (exchange.access == bus::Access::read) return message;
  message.command = CanMessage::Command::write;
  store_be32(message.data, 0, exchange.raw);
  return message;
}

bool answers(const CanMessage& message, const bus::Exchange& exchange) {
  if (message.command != CanMessage::Command::reply || message.index != exchange.object.index) return false;
  if (message.sub == exchange.object.sub) return true;
  return exchange.access == bus::Access::write && message.sub == 0;
}

bus::ExchangeResult result_of(const CanMessage& message, const bus::Exchange& exchange) {
  bus::ExchangeResult result;
  if (exchange.access == bus::Access::read) result.fields = cut(exchange, message.data);
  return result;
}

}  // namespace axisgate::keya
