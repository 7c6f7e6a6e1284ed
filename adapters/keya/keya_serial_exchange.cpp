// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_serial_exchange.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "adapters/keya/keya_fields.hpp"

namespace axisgate::keya {

namespace {

/// The order of the fields of a control frame: on A, on B, value A, value B.
constexpr std::array<ObjectAddress, 4> kFields{{{kOnIndex, 1}, {kOnIndex, 2}, {kValueIndex, 1}, {kValueIndex, 2}}};

/// No value: not among the fields written.
std::optional<bus::Neighbour> written(const bus::Exchange& exchange, const ObjectAddress& object) {
  if (exchange.object == object) return bus::Neighbour{object, exchange.size, exchange.raw};
  const auto found = std::ranges::find(exchange.more, object, &bus::Neighbour::object);
  return found == exchange.more.end() ? std::nullopt : std::optional(*found);
}

std::uint32_t low_bytes(const bus::Neighbour& field) {
  return field.size == 4 ? field.raw : field.raw & ((std::uint32_t{1} << (8 * field.size)) - 1);
}

std::optional<bus::ExchangeResult> refusal_of_read(KeyaLine line, const bus::Exchange& exchange) {
  assert(std::ranges::all_of(exchange.more, [&](const bus::Neighbour& neighbour) {
    return neighbour.object.index == exchange.object.index && neighbour.object.sub == exchange.object.sub;
  }));
  const std::uint16_t index = exchange.object.index;
  if (index < kQueryIndex || index >= kQueryIndex + kQueries || exchange.object.sub != 0) return refused(kNoObject);
  if (!within(exchange, data_size(line))) return refused(kWrongLength);
  return std::nullopt;
}

std::optional<bus::ExchangeResult> refusal_of_serial_write(const bus::Exchange& exchange) {
  if (std::ranges::find(kFields, exchange.object) == kFields.end()) return refused(kNoObject);
  if (exchange.more.size() != kFields.size() - 1 || exchange.bytes) return refused(kUnsupportedAccess);
  for (const ObjectAddress& object : kFields) {
    const auto field = written(exchange, object);
    if (!field) return refused(kUnsupportedAccess);
    const bool on = object.index == kOnIndex;
    const bool width_fits = field->size == 4 || (on && (field->size == 1 || field->size == 2));
    if (!width_fits) return refused(kWrongLength);
    if (on && low_bytes(*field) > 1) return refused(kWrongValue);
  }
  return std::nullopt;
}

}  // namespace

std::optional<bus::ExchangeResult> refusal_of(KeyaLine line, const bus::Exchange& exchange) {
  assert(exchange.access != bus::Access::command);
  return exchange.access == bus::Access::read ? refusal_of_read(line, exchange) : refusal_of_serial_write(exchange);
}

SerialFrame request_of(KeyaLine line, const bus::Exchange& exchange) {
  assert(line == KeyaLine::rs232 || exchange.node != 0);
  SerialFrame frame;
  if (line == KeyaLine::rs485) frame.node = exchange.node;
  if (exchange.access == bus::Access::read) {
    frame.code = static_cast<std::uint8_t>(exchange.object.index - kQueryIndex);
    return frame;
  }
  frame.start = kControl;
  const auto value_of = [&](std::size_t field) { return low_bytes(written(exchange, kFields[field]).value()); };
  frame.code = static_cast<std::uint8_t>(value_of(0) | value_of(1) << 1);
  store_be32(frame.data, 0, value_of(2));
  store_be32(frame.data, 4, value_of(3));
  return frame;
}

bool answers(KeyaLine line, const SerialFrame& frame, const bus::Exchange& exchange) {
  if (exchange.access != bus::Access::read || frame.start != kQuery) return false;
  const bool its_node = line == KeyaLine::rs232 || frame.node == exchange.node;
  return its_node && kQueryIndex + frame.code == exchange.object.index;
}

bus::ExchangeResult result_of(KeyaLine line, const SerialFrame& frame, const bus::Exchange& exchange) {
  bus::ExchangeResult result;
  result.fields = cut(exchange, Bytes(frame.data).first(data_size(line)));
  return result;
}

}  // namespace axisgate::keya
