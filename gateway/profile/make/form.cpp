// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "gateway/profile/eds/eds_lines.hpp"
#include "gateway/profile/make/profile_text.hpp"

namespace axisgate::profile {
namespace {

constexpr std::array kColumns = std::to_array<std::string_view>({"name", "address", "type", "access", "unit", "range"});
using Cells = std::vector<std::string>;

/// One line of a CSV: "a, b" in quotes is one cell, and "" in it a quote.
Cells cells_of(std::string_view line, char separator) {
  Cells out{""};
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      out.back() += line[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      out.emplace_back();
    else
      out.back() += c;
  }
  for (std::string& cell : out) {
    cell.erase(0, std::min(cell.find_first_not_of(" \t\r"), cell.size()));
    cell.erase(cell.find_last_not_of(" \t\r") + 1);
  }
  return out;
}

char separator_of(std::string_view line) {
  const auto count = [&](char c) { return std::ranges::count(line, c); };
  if (count('\t') > 0 && count('\t') >= count(',')) return '\t';
  return count(';') > count(',') ? ';' : ',';
}

/// As manuals call them; none: of no width that a profile has.
std::optional<EdsWidth> width_named(const std::string& text) {
  static const std::map<std::string, EdsWidth> kNames{
      {"u8", {1, false}},     {"uint8", {1, false}},      {"unsigned8", {1, false}}, {"byte", {1, false}},
      {"i8", {1, true}},      {"int8", {1, true}},        {"integer8", {1, true}},   {"u16", {2, false}},
      {"uint16", {2, false}}, {"unsigned16", {2, false}}, {"word", {2, false}},      {"i16", {2, true}},
      {"int16", {2, true}},   {"integer16", {2, true}},   {"int", {2, true}},        {"u32", {4, false}},
      {"uint32", {4, false}}, {"unsigned32", {4, false}}, {"dword", {4, false}},     {"i32", {4, true}},
      {"int32", {4, true}},   {"integer32", {4, true}},   {"dint", {4, true}},       {"s16", {2, true}},
      {"s32", {4, true}},     {"s8", {1, true}}};
  const auto at = kNames.find(eds_lower(text));
  return at == kNames.end() ? std::nullopt : std::optional(at->second);
}

std::optional<std::int64_t> number_of(std::string_view text) {
  const auto number = eds_number(eds_bare(text));
  return number ? std::optional(number->value) : std::nullopt;
}

/// "0x6040", "6040h:01", "6040.01", "6040": canopen's addresses are hexadecimal however they are written.
std::optional<ObjectAddress> object_address(std::string text) {
  text = eds_lower(text);
  if (text.starts_with("0x")) text.erase(0, 2);
  std::erase(text, 'h');
  const std::size_t point = text.find_first_of(".:");
  const auto index = eds_digits(text.substr(0, point), 16);
  const auto sub = point == std::string::npos ? std::optional<std::int64_t>(0) : eds_digits(text.substr(point + 1), 16);
  if (!index || !sub || *index > 0xFFFF || *sub > 0xFF) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

std::optional<ObjectAddress> register_address(const std::string& text) {
  const auto number = number_of(text);
  if (!number || *number < 0 || *number > 0xFFFF) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*number), 0};
}

/// "0-3000", "-5..5", "[1, 10]", "-3000 to 3000"; false: it is no range.
bool read_range(std::string text, FormRow& out) {
  std::erase_if(text, [](char c) { return c == '[' || c == ']' || c == '(' || c == ')'; });
  for (const std::string_view word : {"..", " to ", "~", ","})
    if (const std::size_t at = text.find(word); at != std::string::npos) {
      out.low = number_of(text.substr(0, at));
      out.high = number_of(text.substr(at + word.size()));
      return out.low && out.high && *out.low <= *out.high;
    }
  const std::size_t dash = text.find('-', text.find_first_not_of(" -"));
  if (dash == std::string::npos) return false;
  out.low = number_of(text.substr(0, dash));
  out.high = number_of(text.substr(dash + 1));
  return out.low && out.high && *out.low <= *out.high;
}

class Reader {
 public:
  explicit Reader(FormOf what) : what_(what) {}

  void take(std::string_view line, std::size_t number) {
    if (eds_bare(line).empty() || line.starts_with('#')) return;
    if (columns_.empty()) {
      separator_ = separator_of(line);
      if (take_header(cells_of(line, separator_))) return;
    }
    if (out.rows.size() >= kMaxFormRows) return fault(number, fmt::format("has more than {} rows", kMaxFormRows));
    take_row(cells_of(line, separator_), number);
  }

  Form out;

 private:
  bool take_header(const Cells& cells) {
    for (std::size_t i = 0; i < kColumns.size(); ++i) columns_[std::string(kColumns[i])] = i;
    const auto is_address = [](const std::string& cell) { return eds_lower(cell) == "address"; };
    if (eds_lower(cells[0]) != "name" && std::ranges::none_of(cells, is_address)) return false;
    columns_.clear();
    for (std::size_t i = 0; i < cells.size(); ++i) columns_[eds_lower(cells[i])] = i;
    return true;
  }

  [[nodiscard]] std::string cell(const Cells& cells, const std::string& column) const {
    const auto at = columns_.find(column);
    return at == columns_.end() || at->second >= cells.size() ? std::string() : cells[at->second];
  }

  void take_row(const Cells& cells, std::size_t number) {
    FormRow row;
    row.line = number;
    row.name = object_name(cell(cells, "name"));
    const std::string address = cell(cells, "address"), type = cell(cells, "type"), range = cell(cells, "range");
    const auto place = what_ == FormOf::canopen ? object_address(address) : register_address(address);
    const auto width = width_named(type);
    if (row.name.empty()) return fault(number, "has no name");
    if (!place) return fault(number, fmt::format("\"{}\" is no address", eds_shown(address)));
    if (!width) return fault(number, fmt::format("\"{}\" is no type: u8, i8, u16, i16, u32 or i32", eds_shown(type)));
    row.address = *place;
    row.width = *width;
    read_access(eds_lower(cell(cells, "access")), row);
    row.unit = plain_text(cell(cells, "unit"), 40);
    if (!range.empty() && !read_range(range, row))
      return fault(number, fmt::format("\"{}\" is no range: 0..3000", eds_shown(range)));
    if (const auto [at, first] = names_.emplace(row.name, number); !first)
      return fault(number, fmt::format("name {} is that of line {} as well", row.name, at->second));
    take_place(row);
  }

  void take_place(const FormRow& row) {
    const int count = what_ == FormOf::canopen ? 1 : row.registers();
    for (int i = 0; i < count; ++i) {
      const auto key = std::pair(row.address.index + i, int{row.address.sub});
      if (const auto [at, first] = places_.emplace(key, row.line); !first)
        return fault(row.line, fmt::format("its address is taken by line {}", at->second));
    }
    out.rows.push_back(row);
  }

  static void read_access(const std::string& access, FormRow& out) {
    out.writes = access.find('w') != std::string::npos;
    out.reads = access.find('r') != std::string::npos || !out.writes;
  }

  void fault(std::size_t line, std::string message) { out.faults.push_back({line, std::move(message)}); }

  FormOf what_;
  char separator_ = ',';
  std::map<std::string, std::size_t> columns_;
  std::map<std::string, std::size_t> names_;
  std::map<std::pair<int, int>, std::size_t> places_;
};

}  // namespace

std::string FormRow::type() const { return fmt::format("{}{}", width.is_signed ? 'i' : 'u', 8 * width.size); }

Form parse_form(std::string_view csv, FormOf what) {
  Reader reader(what);
  if (csv.size() > kMaxFormBytes) {
    reader.out.faults.push_back({0, "is longer than 1 MiB: is this a table of registers?"});
    return std::move(reader.out);
  }
  if (csv.starts_with("\xEF\xBB\xBF")) csv.remove_prefix(3);
  std::size_t line = 0;
  while (!csv.empty()) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    reader.take(csv.substr(0, end), ++line);
    csv.remove_prefix(std::min(end + 1, csv.size()));
  }
  if (reader.out.rows.empty() && reader.out.faults.empty())
    reader.out.faults.push_back({0, "has no row: name,address,type,access,unit,range"});
  std::ranges::sort(reader.out.rows, {}, &FormRow::address);
  return std::move(reader.out);
}

std::string object_name(std::string_view text) {
  text = text.substr(0, text.find('('));
  std::string out = profile_name(text);
  if (text.empty() || out == "drive") return eds_lower(text).find("drive") == std::string::npos ? "" : out;
  std::ranges::replace(out, '-', '_');
  return out.front() >= 'a' && out.front() <= 'z' ? out : "object_" + out.substr(0, 40);
}

}  // namespace axisgate::profile
