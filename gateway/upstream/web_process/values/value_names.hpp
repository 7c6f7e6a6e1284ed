// SPDX-License-Identifier: Apache-2.0
// What a quantity is called on the web: with its unit in the name, and without what says nothing (`_actual`); and what
// its number is in that unit. Promises one table for answers, limits and series. Never says whether it is valid.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>

#include "gateway/image/quantity.hpp"
#include "gateway/upstream/web_link/records.hpp"

namespace axisgate::web {

/// "velocity_rpm", "position_rev", "mode" for mode_display, "mode_asked" for mode.
[[nodiscard]] std::string_view value_name(Quantity quantity);
[[nodiscard]] std::optional<Quantity> value_named(std::string_view name);
/// A whole number of what is a code; else a decimal in the unit of the name.
[[nodiscard]] nlohmann::ordered_json value_json(Quantity quantity, std::int64_t number, const AxisInfoRecord& axis);

}  // namespace axisgate::web
