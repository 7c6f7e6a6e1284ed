// SPDX-License-Identifier: Apache-2.0
// A profile written for axisgate 0.1 or 0.2 in the words of today.
// Promises that nothing changes but what has another name or is not allowed any more, and a line for each change.
// Never invents a fact: what today's format asks beyond it, `axisgate profile check` tells.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace axisgate::profile {

struct Upgraded {
  std::string name;  ///< of the profile
  std::string text;
  std::vector<std::string> changes;  ///< empty: nothing was to be done
  std::string fault;                 ///< why it is no profile; empty: it is one
};
[[nodiscard]] Upgraded upgraded(const nlohmann::json& document);

}  // namespace axisgate::profile
