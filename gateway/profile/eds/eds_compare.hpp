// SPDX-License-Identifier: Apache-2.0
// A profile held against the maker's EDS: every place where the two cannot both be right.
// Promises each contradiction with its place in the profile and its section in the EDS, and silence about what only one
// of them says. Never says which of the two is wrong.
#pragma once

#include <string>
#include <vector>

#include "gateway/profile/eds/eds.hpp"
#include "gateway/profile/read/profile.hpp"

namespace axisgate::profile {

struct EdsContradiction {
  std::string pointer;  ///< into the profile
  std::string section;  ///< of the EDS: "6041", "6099sub1"
  std::string message;
  friend bool operator==(const EdsContradiction&, const EdsContradiction&) = default;
};

/// In the order of the profile's objects, then of what it maps and writes. The profile must have no fault of its own.
[[nodiscard]] std::vector<EdsContradiction> contradictions(const Profile& profile, const Eds& eds);

}  // namespace axisgate::profile
