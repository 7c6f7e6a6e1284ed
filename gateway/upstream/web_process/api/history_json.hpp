// SPDX-License-Identifier: Apache-2.0
// Lines as the web shows them: slices of a span of time, in the units of their names.
// Promises text that is no longer than it says, or nothing. Never knows where the points come from.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/upstream/web_process/history/history.hpp"

namespace axisgate::web {

inline constexpr std::uint64_t kLeastPoints = 16, kMostPoints = 4000, kPoints = 1000;

struct Span {
  SteadyNs from = 0;
  SteadyNs to = 0;  ///< behind `from`
};
/// What the units of an axis are; nullptr: it is not known, and its series have no values.
using InfoOf = std::function<const AxisInfoRecord*(std::uint16_t axis)>;

/// {"1.velocity_rpm":[[t,low,high],...], ...}. None: it would be longer than kMaxJson. @param points slices
[[nodiscard]] std::optional<std::string> series_json(const EachPoint& each, const std::vector<Series>& series,
                                                     const Span& span, std::size_t points, const InfoOf& info,
                                                     const Now& now);

}  // namespace axisgate::web
