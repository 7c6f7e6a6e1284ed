// SPDX-License-Identifier: Apache-2.0
// What each row of the register map is, in a few words, for people who look for one in a list.
// Promises words for every register, coil and input (a test looks). Never tells numbers or rules: a row's note does.
#pragma once

#include <string_view>

#include "gateway/image/register_map.hpp"

namespace axisgate::listing {

/// Short enough for a column beside address, type and name on a terminal of 80 columns.
inline constexpr std::size_t kLongestMeaning = 36;

/// Of the overview: as of the axis. Empty: there is no such row.
[[nodiscard]] std::string_view register_meaning(Block block, std::string_view name);
[[nodiscard]] std::string_view coil_meaning(std::string_view name);
[[nodiscard]] std::string_view input_meaning(std::string_view name);

}  // namespace axisgate::listing
