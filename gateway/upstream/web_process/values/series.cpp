// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/values/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <nlohmann/json.hpp>

#include "gateway/core/numbers.hpp"
#include "gateway/upstream/web_process/values/value_names.hpp"

namespace axisgate::web {
namespace {

constexpr std::array<std::string_view, kSeriesNames - kQuantityCount> kStateNames{"axis_state", "motion_state",
                                                                                  "link_state", "alarms"};

}  // namespace

std::string_view series_name(std::uint8_t name) {
  return name < kQuantityCount ? value_name(static_cast<Quantity>(name)) : kStateNames.at(name - kQuantityCount);
}

std::optional<std::uint8_t> series_named(std::string_view name) {
  if (const auto quantity = value_named(name)) return static_cast<std::uint8_t>(*quantity);
  const auto found = std::ranges::find(kStateNames, name);
  if (found == kStateNames.end()) return std::nullopt;
  return static_cast<std::uint8_t>(kQuantityCount + static_cast<std::size_t>(found - kStateNames.begin()));
}

std::optional<Series> parse_series(std::string_view text) {
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos) return std::nullopt;
  Series out;
  const char* const end_of_number = text.data() + point;
  const auto [end, error] = std::from_chars(text.data(), end_of_number, out.axis);
  const auto name = series_named(text.substr(point + 1));
  if (error != std::errc() || end != end_of_number || !name) return std::nullopt;
  out.name = *name;
  return out;
}

std::string series_text(Series series) { return fmt::format("{}.{}", series.axis, series_name(series.name)); }

std::int64_t series_number(std::uint8_t name, std::uint32_t bits) {
  if (name >= kQuantityCount || row(static_cast<Quantity>(name)).type == RegisterType::u32) return bits;
  return std::bit_cast<std::int32_t>(bits);
}

nlohmann::ordered_json series_value(std::uint8_t name, std::int64_t value, const AxisInfoRecord& axis) {
  if (name >= kQuantityCount) return value;
  return value_json(static_cast<Quantity>(name), value, axis);
}

}  // namespace axisgate::web
