// SPDX-License-Identifier: Apache-2.0
#include "gateway/listing/map_listing.hpp"

#include <fmt/format.h>

#include "gateway/image/float_rows.hpp"
#include "gateway/listing/row_meanings.hpp"

namespace axisgate::listing {
namespace {

using namespace std::string_literals;

/// What the drive does not have keeps the access of the map: `supported` says enough.
bool can_write(const RegisterRow& row, const ListedAxis& axis) {
  return takes(axis, row) || (row.writable && !supports(axis, row));
}

MapEntry holding(const RegisterRow& row, Block block, std::uint16_t number) {
  MapEntry entry;
  entry.table = "holding";
  entry.address = static_cast<std::uint16_t>(address_of(block, number) + row.offset);
  entry.count = row.registers();
  entry.name = row.name;
  entry.type = text(row.type);
  entry.unit = unit_of(row, "");
  entry.access = row.writable ? "rw" : "r";
  entry.note = row.note;
  entry.meaning = register_meaning(block, row.name);
  return entry;
}

void list_axis(std::vector<MapEntry>& entries, Block block, const std::string& prefix, const ListedAxis& axis,
               bool float_numbers) {
  for (const RegisterRow& row : register_table(block).rows()) {
    MapEntry& entry = entries.emplace_back(holding(row, block, axis.number));
    entry.axis = axis.number;
    entry.name = prefix + entry.name;
    entry.unit = unit_of(row, axis.position_unit);
    if (float_numbers && is_float_row(row)) {
      entry.type = "f32";
      entry.unit = float_unit(row);
    }
    entry.access = can_write(row, axis) ? "rw" : "r";
    entry.supported = supports(axis, row);
  }
}

MapEntry one_bit(std::string_view table, const ListedAxis& axis, std::uint16_t offset, std::string_view name,
                 std::string_view meaning) {
  MapEntry entry;
  entry.table = table;
  entry.address = static_cast<std::uint16_t>(kAxisBlock * axis.number + offset);
  entry.axis = axis.number;
  entry.name = name;
  entry.type = "bool";
  entry.access = "r";
  entry.meaning = meaning;
  return entry;
}

}  // namespace

std::vector<MapEntry> map_entries(const ListedMap& map) {
  std::vector<MapEntry> entries;
  for (const RegisterRow& row : register_table(Block::gateway).rows())
    entries.push_back(holding(row, Block::gateway, 0));
  for (const ListedAxis& axis : map.axes) list_axis(entries, Block::axis, "", axis, map.float_numbers);
  for (std::size_t b = 0; b < map.buses.size(); ++b) {
    for (const RegisterRow& row : register_table(Block::bus).rows()) {
      entries.push_back(holding(row, Block::bus, static_cast<std::uint16_t>(b)));
      entries.back().bus = map.buses[b];
    }
  }
  for (const ListedAxis& axis : map.axes) list_axis(entries, Block::overview, "overview_", axis, map.float_numbers);
  for (const ListedAxis& axis : map.axes) {
    for (const CoilRow& coil : coil_rows()) {
      entries.push_back(one_bit("coil", axis, coil.offset, coil.name, coil_meaning(coil.name)));
      entries.back().access = "rw";
      entries.back().supported = supports(axis, coil);
    }
  }
  for (const ListedAxis& axis : map.axes)
    for (const InputRow& input : input_rows())
      entries.push_back(one_bit("discrete", axis, input.offset, input.name, input_meaning(input.name)));
  return entries;
}

std::string reference_of(const MapEntry& entry) {
  const char kind = entry.table == "coil" ? '0' : entry.table == "discrete" ? '1' : '4';
  return fmt::format("{}{:04}", kind, entry.address + 1);
}

std::string position_unit(std::int64_t numerator, std::int64_t denominator) {
  return std::to_string(denominator) + "/" + std::to_string(numerator) + " rev";
}

}  // namespace axisgate::listing
