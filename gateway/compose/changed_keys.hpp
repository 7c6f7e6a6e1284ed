// SPDX-License-Identifier: Apache-2.0
// Which keys of two JSON texts differ, for whoever changed one of them: each with its old and its new value. Pure.
// Promises a bounded number of lines of bounded length, and entries of a list that moved by one that was put before
// them not to be called changed. Never shows the value of a key that names a certificate or a key.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace axisgate::compose {

inline constexpr std::size_t kMostChangedKeys = 20;  ///< that are named of one bus or listener; the others are counted
inline constexpr std::size_t kLongestShownValue = 60;  ///< bytes of a value; of a longer one its beginning is shown

/// "drives/0/axes/0/limits/velocity 3000000 -> 1500000"; a value that is not there is "(not given)". All of them.
[[nodiscard]] std::vector<std::string> changed_keys(const nlohmann::json& before, const nlohmann::json& after);
/// The first kMostChangedKeys of them, and "and 3 more".
[[nodiscard]] std::vector<std::string> bounded(std::vector<std::string> keys);

}  // namespace axisgate::compose
