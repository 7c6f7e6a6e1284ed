// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_fields.hpp"

#include <algorithm>

namespace axisgate::keya {

namespace {

constexpr std::uint8_t kWhole = 4;

std::uint8_t width(std::uint8_t size) { return size == 0 ? kWhole : size; }

bool lies_within(const ObjectAddress& object, std::uint8_t size, std::size_t available) {
  const std::uint8_t bytes = width(size);
  return (bytes == 1 || bytes == 2 || bytes == 4) && std::size_t{object.byte} + bytes <= available;
}

bus::ReplyField field(const ObjectAddress& object, std::uint8_t size, Bytes data) {
  return {object, width(size), load_be(data, object.byte, width(size))};
}

}  // namespace

bus::ExchangeResult refused(std::uint32_t detail) {
  bus::ExchangeResult result;
  result.code = Errc::refused_by_drive;
  result.detail = detail;
  return result;
}

std::uint32_t load_be(Bytes from, std::size_t at, std::size_t size) {
  assert(size >= 1 && size <= 4 && at + size <= from.size());
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = (value << 8) | from[at + i];
  return value;
}

void store_be32(std::span<Byte> to, std::size_t at, std::uint32_t value) {
  store_be16(to, at, static_cast<std::uint16_t>(value >> 16));
  store_be16(to, at + 2, static_cast<std::uint16_t>(value & 0xFFFF));
}

bool within(const bus::Exchange& read, std::size_t available) {
  return lies_within(read.object, read.size, available) &&
         std::ranges::all_of(read.more, [available](const bus::Neighbour& neighbour) {
           return lies_within(neighbour.object, neighbour.size, available);
         });
}

bus::ReplyFields cut(const bus::Exchange& read, Bytes data) {
  bus::ReplyFields fields;
  fields.push_back(field(read.object, read.size, data));
  for (const bus::Neighbour& neighbour : read.more) fields.push_back(field(neighbour.object, neighbour.size, data));
  return fields;
}

}  // namespace axisgate::keya
