// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "gateway/core/name_table.hpp"
#include "gateway/listing/map_listing.hpp"

namespace axisgate::listing {
namespace {

constexpr std::array<std::string_view, 12> kColumns{"table", "address", "count",  "axis",      "bus",       "name",
                                                    "type",  "unit",    "access", "supported", "reference", "meaning"};
using Cells = std::array<std::string, kColumns.size()>;

Cells cells_of(const MapEntry& entry) {
  return {std::string(entry.table),    std::to_string(entry.address),
          std::to_string(entry.count), entry.axis ? std::to_string(*entry.axis) : "",
          entry.bus.value_or(""),      entry.name,
          std::string(entry.type),     entry.unit,
          std::string(entry.access),   entry.supported ? "true" : "false",
          reference_of(entry),         std::string(entry.meaning)};
}

/// One entry a line: readable for people, and lines can be compared between two versions of a configuration.
std::string json_text(const ListedMap& map, const std::vector<MapEntry>& entries) {
  std::string out = "{\"map_version\": " + std::to_string(kMapVersion) + ", \"word_order\": \"" +
                    (map.low_word_first ? "low-first" : "high-first") +
                    (map.float_numbers ? "\", \"numbers\": \"float" : "") + "\", \"entries\": [";
  const char* separator = "\n  ";
  for (const MapEntry& entry : entries) {
    out += separator + entry_json(entry).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    separator = ",\n  ";
  }
  return out + "\n]}\n";
}

std::string csv_line(const Cells& cells) {
  std::string line;
  for (const std::string& cell : cells) line += (line.empty() ? "" : ",") + csv_cell(cell);
  return line + "\n";
}

std::string markdown_line(const Cells& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) {
    line += ' ';
    for (const char each : cell) line += each == '|' ? std::string("\\|") : std::string(1, each);
    line += " |";
  }
  return line + "\n";
}

Cells heading() {
  Cells cells;
  std::copy(kColumns.begin(), kColumns.end(), cells.begin());
  return cells;
}

}  // namespace

nlohmann::ordered_json entry_json(const MapEntry& entry) {
  nlohmann::ordered_json out;
  out["table"] = entry.table;
  out["address"] = entry.address;
  out["count"] = entry.count;
  out["axis"] = entry.axis ? nlohmann::ordered_json(*entry.axis) : nlohmann::ordered_json();
  out["bus"] = entry.bus ? nlohmann::ordered_json(*entry.bus) : nlohmann::ordered_json();
  out["name"] = entry.name;
  out["type"] = entry.type;
  out["unit"] = entry.unit;
  out["access"] = entry.access;
  out["supported"] = entry.supported;
  return out;
}

std::string csv_cell(std::string_view cell) {
  if (cell.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(cell);
  std::string quoted = "\"";
  for (const char each : cell) quoted += each == '"' ? std::string("\"\"") : std::string(1, each);
  return quoted + "\"";
}

std::optional<MapFormat> map_format_named(std::string_view name) {
  using enum MapFormat;
  static constexpr auto kNames =
      names_of<MapFormat>({{json, "json"}, {csv, "csv"}, {markdown, "md"}, {table, "table"}, {structured_text, "st"}});
  return kNames.named(name);
}

std::string map_text(const ListedMap& map, MapFormat format, std::size_t columns) {
  const std::vector<MapEntry> entries = map_entries(map);
  switch (format) {
    case MapFormat::json:
      return json_text(map, entries);
    case MapFormat::table:
      return map_table(map, entries, columns);
    case MapFormat::structured_text:
      return map_st(map, entries);
    case MapFormat::csv: {
      std::string out = csv_line(heading());
      for (const MapEntry& entry : entries) out += csv_line(cells_of(entry));
      return out;
    }
    case MapFormat::markdown: {
      std::string out = markdown_line(heading()) + "|---|---:|---:|---:|---|---|---|---|---|---|---|---|\n";
      for (const MapEntry& entry : entries) out += markdown_line(cells_of(entry));
      return out;
    }
  }
  return {};
}

}  // namespace axisgate::listing
