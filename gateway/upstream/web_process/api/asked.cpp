// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/asked.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace axisgate::web {
namespace {

/// "-10", "-0.25", "0": so many seconds before now.
std::optional<SteadyNs> seconds_before(std::string_view text, const Now& now) {
  constexpr std::size_t kDigits = 9;
  constexpr std::uint64_t kMost = 1'000'000'000;
  if (!text.starts_with('-')) return text == "0" ? std::optional(now.at) : std::nullopt;
  text.remove_prefix(1);
  const std::size_t point = std::min(text.find('.'), text.size());
  const auto whole = whole_number(text.substr(0, point), 0, kMost);
  std::string fraction(point == text.size() ? "0" : text.substr(point + 1));
  if (!whole || fraction.empty() || fraction.size() > kDigits) return std::nullopt;
  fraction.resize(kDigits, '0');
  const auto part = whole_number(fraction, 0, kMost);
  if (!part) return std::nullopt;
  return now.at - static_cast<SteadyNs>(*whole) * kSecond - static_cast<SteadyNs>(*part);
}

SteadyNs time_asked(Query& query, const char* name, SteadyNs otherwise, const Now& now) {
  const auto given = query.text(name);
  if (!given) return otherwise;
  auto out = seconds_before(*given, now);
  if (!out) out = parse_utc(*given, now);
  if (!out)
    throw ParameterFault{fmt::format(
        "{}: '{}' is no time: UTC of the years 1971 to 2199 as 2026-11-28T20:40:00.5Z, or seconds before now as -10",
        name, *given)};
  return *out;
}

}  // namespace

Answer refuse(Refusal refusal) { return {problem(refusal), refusal}; }
Answer refuse(Refusal refusal, const std::string& detail) { return {problem(refusal, detail), refusal}; }

Answer text_answer(std::string text, unsigned status) {
  if (text.size() > kMaxJson) return refuse(Refusal::large_answer);
  return {json_response(std::move(text), status)};
}

std::string axes_text(const Picture& picture) {
  std::vector<std::uint16_t> numbers;
  for (const auto& [number, axis] : picture.axes()) numbers.push_back(number);
  return fmt::format("{}", fmt::join(numbers, ", "));
}

std::vector<Series> series_asked(Query& query, const NotThere& not_there) {
  const auto given = query.text("series");
  if (!given) return {};
  const auto parts = parts_of(*given, ',');
  if (parts.size() > kMostSeries) throw ParameterFault{fmt::format("series: at most {}", kMostSeries)};
  std::vector<Series> out;
  for (const std::string_view part : parts) {
    const auto series = parse_series(part);
    if (!series)
      throw ParameterFault{fmt::format(
          "series: '{}' is none: an axis's number, a point and a name of its `values`, or axis_state, motion_state, "
          "link_state, alarms: 1.velocity_rpm",
          part)};
    if (const std::string why = not_there(series->axis); !why.empty())
      throw ParameterFault{fmt::format("series: '{}': {}", part, why)};
    if (std::ranges::find(out, *series) != out.end())
      throw ParameterFault{fmt::format("series: '{}' is given twice", part)};
    out.push_back(*series);
  }
  return out;
}

std::vector<Series> series_asked(Query& query, const Picture& picture) {
  return series_asked(query, [&](std::uint16_t axis) {
    return picture.find(axis) != nullptr ? std::string()
                                         : fmt::format("there is no axis {}; there are: {}", axis, axes_text(picture));
  });
}

Span span_asked(Query& query, const Now& now) {
  constexpr SteadyNs kMinute = 60 * kSecond;
  Span out;
  out.from = time_asked(query, "from", now.at - kMinute, now);
  out.to = std::min(time_asked(query, "to", now.at, now), now.at);
  if (out.from >= out.to) throw ParameterFault{"from: it must lie before `to`, and before now"};
  // As times are written.
  out.from -= out.from % kMicrosecond;
  return out;
}

std::size_t points_asked(Query& query) {
  return static_cast<std::size_t>(query.number("points", kLeastPoints, kMostPoints).value_or(kPoints));
}

CsvSigns signs_asked(Query& query) {
  CsvSigns out;
  const auto take = [&](const char* name, std::string_view may_be, const char* in_words, char& into) {
    const auto given = query.text(name);
    if (!given) return;
    if (given->size() != 1 || may_be.find(given->front()) == std::string_view::npos)
      throw ParameterFault{fmt::format("{}: '{}' is none; there are: {}", name, *given, in_words)};
    into = given->front();
  };
  take("separator", ",;\t", "a comma, ;, a tab (%09)", out.separator);
  take("decimal", ".,", "a point, a comma", out.decimal);
  if (out.separator == out.decimal)
    throw ParameterFault{"decimal: it must be another sign than `separator`: separator=; with decimal=,"};
  return out;
}

}  // namespace axisgate::web
