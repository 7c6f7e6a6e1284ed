// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/map_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/listing/map_listing.hpp"
#include "gateway/upstream/web_process/http/response.hpp"

namespace axisgate::web {
namespace {

/// Of all axes, or of one.
listing::ListedMap listed(const Picture& picture, std::optional<std::uint16_t> only) {
  listing::ListedMap out;
  out.low_word_first = picture.hello().low_word_first;
  out.float_numbers = picture.hello().float_numbers;
  for (const auto& [place, bus] : picture.buses()) out.buses.push_back(bus.info.name);
  for (const auto& [number, axis] : picture.axes()) {
    if (only && number != *only) continue;
    const AxisInfoRecord& info = axis.info;
    listing::ListedAxis each;
    each.supported = axis.sample.supported;
    each.writable = info.writable;
    each.supported_commands = info.supported_commands;
    each.number = number;
    each.name = info.name;
    each.position_unit = listing::position_unit(info.units_numerator, info.units_denominator);
    out.axes.push_back(std::move(each));
  }
  return out;
}

std::vector<listing::MapEntry> entries_of(const Picture& picture, std::optional<std::uint16_t> axis) {
  std::vector<listing::MapEntry> out = listing::map_entries(listed(picture, axis));
  if (axis) std::erase_if(out, [&](const listing::MapEntry& entry) { return entry.axis != axis; });
  return out;
}

}  // namespace

std::string map_json(const Picture& picture, std::optional<std::uint16_t> axis) {
  std::string out = "{\"rows\":[";
  for (const listing::MapEntry& entry : entries_of(picture, axis)) {
    nlohmann::ordered_json row = listing::entry_json(entry);
    row["note"] = entry.note;
    if (out.size() > kMaxJson) break;  // it is refused: no more of it is made
    out += (out.back() == '[' ? "" : ",") + row.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  return out + "]}";
}

std::string map_csv(const Picture& picture, std::optional<std::uint16_t> axis) {
  std::string out = "table,address,count,axis,bus,name,type,unit,access,supported,note\r\n";
  for (const listing::MapEntry& entry : entries_of(picture, axis))
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\r\n", entry.table, entry.address, entry.count,
                       entry.axis ? std::to_string(*entry.axis) : "", listing::csv_cell(entry.bus.value_or("")),
                       listing::csv_cell(entry.name), entry.type, listing::csv_cell(entry.unit), entry.access,
                       entry.supported, listing::csv_cell(entry.note));
  return out;
}

}  // namespace axisgate::web
