// SPDX-License-Identifier: Apache-2.0
// The listing as tables for people: one for each block of registers, coils or inputs, as wide as the terminal.
#include <fmt/format.h>

#include <algorithm>

#include "gateway/listing/map_listing.hpp"

namespace axisgate::listing {
namespace {

/// Words on lines of at most `width`; the lines behind the first begin with `indent` blanks, which count.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  std::string out;
  std::size_t at = indent;  // the first line begins where the others do
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const bool first = at == indent;
    if (!first && at + 1 + end > width) {
      out += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (!first) {
      out += ' ';
      ++at;
    }
    out += text.substr(0, end);
    at += end;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string titles(const ListedMap& map, std::size_t columns) {
  std::string out =
      wrapped(fmt::format("map version {}, 32-bit values {} word first{}", kMapVersion,
                          map.low_word_first ? "low" : "high", map.float_numbers ? ", f32: IEEE 754" : ""),
              columns, 0) +
      "\n" +
      wrapped(
          "address counts from 0, ref from 40001 (registers; input registers show the same, from 30001), "
          "00001 (coils) or 10001 (inputs), with a digit more above 9999",
          columns, 0) +
      "\n";
  for (const ListedAxis& axis : map.axes)
    out += fmt::format("axis {}: {}{}\n", axis.number, axis.name, axis.bus.empty() ? "" : ", on " + axis.bus);
  return out;
}

/// Of the block that a row stands in; neighbours with the same one are one table.
std::string heading(const ListedMap& map, const MapEntry& entry) {
  if (entry.bus) return fmt::format("bus {} {}", (entry.address - kBusBlocks) / kBusBlock, *entry.bus);
  if (!entry.axis) return "gateway";
  const auto axis = std::ranges::find(map.axes, *entry.axis, &ListedAxis::number);
  const std::string_view kind = entry.table == "coil"              ? "coils"
                                : entry.table == "discrete"        ? "discrete inputs"
                                : entry.address >= kOverviewBlocks ? "overview"
                                                                   : "registers";
  return fmt::format("axis {} {}: {}", *entry.axis, axis == map.axes.end() ? "" : axis->name, kind);
}

std::string line(const MapEntry& entry, std::size_t name_width, std::size_t columns) {
  const std::string front = fmt::format("{:>7}  {:>6}  {:<4} {:<2}  {:<{}}  ", entry.address, reference_of(entry),
                                        entry.type, entry.access, entry.name, name_width);
  std::string meaning(entry.meaning);
  if (!entry.unit.empty()) meaning += ", " + entry.unit;
  if (!entry.supported) meaning += " (not on this drive)";
  return front + wrapped(meaning, columns, front.size()) + "\n";
}

}  // namespace

std::string map_table(const ListedMap& map, const std::vector<MapEntry>& entries, std::size_t columns) {
  columns = std::max(columns, kUsualColumns);
  std::size_t name_width = 0;
  for (const MapEntry& entry : entries) name_width = std::max(name_width, entry.name.size());
  std::string out = titles(map, columns);
  std::string block;
  for (const MapEntry& entry : entries) {
    if (const std::string of = heading(map, entry); of != block) {
      block = of;
      out +=
          fmt::format("\n{}\n{:>7}  {:>6}  {:<7}  {:<{}}  meaning\n", of, "address", "ref", "type", "name", name_width);
    }
    out += line(entry, name_width, columns);
  }
  return out;
}

}  // namespace axisgate::listing
