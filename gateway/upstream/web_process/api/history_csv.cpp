// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/history_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

#include "gateway/image/events.hpp"

namespace axisgate::web {
namespace {

/// Of a series at once.
constexpr std::size_t kPointsRead = 256;

}  // namespace

HistoryCsv::HistoryCsv(CsvRequest request, EachPoint each, const Now& now)
    : request_(std::move(request)), each_(std::move(each)), now_(now), columns_(request_.series.size()) {
  for (Column& column : columns_) column.read = request_.span.from - 1;
  for (EventRecord& event : request_.events) event.at -= event.at % kMicrosecond;
  std::ranges::stable_sort(request_.events, {}, &EventRecord::at);
}

/// More points of a column, where it has none.
void HistoryCsv::read(std::size_t at) {
  Column& column = columns_[at];
  if (!column.points.empty() || column.all_read) return;
  const bool first = column.read < request_.span.from;
  const SteadyNs from = std::max(column.read, request_.span.from);
  bool holds = first;
  column.all_read = true;
  each_(request_.series[at], from, request_.span.to, [&](const Point& point) {
    if (point.at <= column.read) {
      holds = true;
      return true;
    }
    if (column.points.size() >= kPointsRead) {
      column.all_read = false;
      return false;
    }
    // What was to come next was thrown away meanwhile.
    if (!holds) column.points.push_back({column.read + kMicrosecond, 0, false});
    holds = true;
    column.points.push_back(point);
    return true;
  });
  if (!column.points.empty()) column.read = column.points.back().at;
}

std::optional<SteadyNs> HistoryCsv::next_instant() {
  std::optional<SteadyNs> out;
  const auto may_be = [&](SteadyNs at) { out = std::min(out.value_or(at), at); };
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    read(i);
    if (!columns_[i].points.empty()) may_be(columns_[i].points.front().at);
  }
  if (event_ < request_.events.size()) may_be(request_.events[event_].at);
  if (!out && written_ < request_.span.to) may_be(request_.span.to);
  return out;
}

std::string HistoryCsv::next() {
  std::string out;
  if (!head_) {
    head_ = true;
    out = "time";
    for (const Series& series : request_.series) out += request_.signs.separator + series_text(series);
    out += fmt::format("{}event\r\n", request_.signs.separator);
  }
  while (out.size() < kPiece) {
    const auto at = next_instant();
    if (!at) break;
    add_row(out, *at);
    written_ = *at;
  }
  return out;
}

void HistoryCsv::add_row(std::string& out, SteadyNs at) {
  out += utc_text(at, now_);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    Column& column = columns_[i];
    if (!column.points.empty() && column.points.front().at == at) {
      const Point& point = column.points.front();
      column.cell = point.known ? number(i, point.value) : std::string();
      column.points.pop_front();
    }
    out += request_.signs.separator + column.cell;
  }
  out += request_.signs.separator;
  if (event_ < request_.events.size() && request_.events[event_].at == at) {
    out += event_cell(request_.events[event_++]);
  }
  out += "\r\n";
}

std::string HistoryCsv::number(std::size_t column, std::int64_t value) const {
  const nlohmann::ordered_json json = series_value(request_.series[column].name, value, request_.axes[column]);
  if (json.is_number_integer()) return std::to_string(json.get<std::int64_t>());
  constexpr std::size_t kLongest = 64;
  std::array<char, kLongest> digits{};
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), json.get<double>(), std::chars_format::fixed);
  std::string out(digits.data(), end);
  std::ranges::replace(out, '.', request_.signs.decimal);
  return out;
}

/// On one line, and in quotes where it must be.
std::string HistoryCsv::event_cell(const EventRecord& event) const {
  const std::string_view kind = text(static_cast<EventKind>(event.kind));
  const std::string text = event.axis == 0 ? fmt::format("{}: {}", kind, event.text)
                                           : fmt::format("axis {}, {}: {}", event.axis, kind, event.text);
  std::string out;
  for (const char c : text) {
    if (c == '"') out += c;
    out += c == '\r' || c == '\n' ? ' ' : c;
  }
  return out.find_first_of(std::string("\"") + request_.signs.separator) == std::string::npos ? out : '"' + out + '"';
}

}  // namespace axisgate::web
