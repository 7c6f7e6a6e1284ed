// SPDX-License-Identifier: Apache-2.0
// The listing of the map as one configuration makes it: what `axisgate map` prints (design 3.1).
// Promises the rows that the server answers from, sorted by table and address, and needs no running gateway.
// Never prints an address that a read would refuse.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/image/axis_image.hpp"
#include "gateway/image/register_map.hpp"

namespace axisgate::listing {

struct ListedAxis : Capabilities {
  AxisNumber number = 0;
  std::string name;
  std::string bus;  ///< name of its bus, for headings
  std::string position_unit = "1/10000 rev";
};

struct ListedMap {
  bool low_word_first = false;     ///< of the listener the listing is made for
  bool float_numbers = false;      ///< of the same
  std::vector<ListedAxis> axes;    ///< in ascending order of number
  std::vector<std::string> buses;  ///< names in configuration order
};

struct MapEntry {
  std::string_view table;  ///< "holding" (input registers show the same), "coil", "discrete"
  std::uint16_t address = 0;
  int count = 1;
  std::optional<AxisNumber> axis;
  std::optional<std::string> bus;
  /// In the overview with "overview_" before it, so that axis and name together are one address.
  std::string name;
  std::string_view type;
  std::string unit;
  std::string_view access;  ///< "r" or "rw"
  bool supported = true;
  std::string_view note = {};     ///< what it means, where the name does not say it
  std::string_view meaning = {};  ///< what it is, in a few words
};

/// As Modicon's controllers and many panels count: from 40001 (holding; input registers: 3 in place of the 4), 00001
/// (coils) and 10001 (inputs); with five digits behind the first from 410000, 010000 and 110000 on.
[[nodiscard]] std::string reference_of(const MapEntry& entry);

[[nodiscard]] std::vector<MapEntry> map_entries(const ListedMap& map);
/// As an object of JSON, its note left out.
[[nodiscard]] nlohmann::ordered_json entry_json(const MapEntry& entry);
/// RFC 4180, 2.5 to 2.7.
[[nodiscard]] std::string csv_cell(std::string_view cell);

enum class MapFormat : std::uint8_t { json, csv, markdown, table, structured_text };
/// "json", "csv", "md", "table", "st".
[[nodiscard]] std::optional<MapFormat> map_format_named(std::string_view name);
inline constexpr std::size_t kUsualColumns = 80;
/// Ends with a newline. @param columns of a terminal, for the table; at least kUsualColumns
[[nodiscard]] std::string map_text(const ListedMap& map, MapFormat format, std::size_t columns = kUsualColumns);

/// The entries as tables for people, one for each block.
[[nodiscard]] std::string map_table(const ListedMap& map, const std::vector<MapEntry>& entries, std::size_t columns);

/// The entries as IEC 61131-3 structured text.
[[nodiscard]] std::string map_st(const ListedMap& map, const std::vector<MapEntry>& entries);

/// "1/10000 rev" for units_per_rev 10000, "37/60000 rev" for 60000/37.
[[nodiscard]] std::string position_unit(std::int64_t numerator, std::int64_t denominator);

}  // namespace axisgate::listing
