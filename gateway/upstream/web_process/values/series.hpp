// SPDX-License-Identifier: Apache-2.0
// One line of a scope: a quantity of an axis, or a state of it. Promises that a series' text is that of the API:
// "1.velocity_rpm". Never says whether the axis is there, or has such a value.
#pragma once

#include <compare>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/image/quantity.hpp"
#include "gateway/upstream/web_link/records.hpp"

namespace axisgate::web {

/// States of an axis that are series as well, behind the quantities.
enum class StateSeries : std::uint8_t { axis_state = kQuantityCount, motion_state, link_state, alarms };
inline constexpr std::size_t kSeriesNames = static_cast<std::size_t>(StateSeries::alarms) + 1;

struct Series {
  std::uint16_t axis = 0;
  std::uint8_t name = 0;  ///< below kQuantityCount a Quantity, else a StateSeries
  friend auto operator<=>(const Series&, const Series&) = default;
};

[[nodiscard]] std::string_view series_name(std::uint8_t name);
[[nodiscard]] std::optional<std::uint8_t> series_named(std::string_view name);
/// "1.velocity_rpm" and back.
[[nodiscard]] std::optional<Series> parse_series(std::string_view text);
[[nodiscard]] std::string series_text(Series series);
/// The number that a register or a state has, by its bits.
[[nodiscard]] std::int64_t series_number(std::uint8_t name, std::uint32_t bits);
/// In the unit of its name. @param value register units
[[nodiscard]] nlohmann::ordered_json series_value(std::uint8_t name, std::int64_t value, const AxisInfoRecord& axis);

}  // namespace axisgate::web
