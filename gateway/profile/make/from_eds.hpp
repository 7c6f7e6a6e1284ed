// SPDX-License-Identifier: Apache-2.0
// A profile made from a maker's EDS: what the drive has otherwise than the profile that it extends, and the questions
// that no EDS answers.
// Promises a profile that the same EDS does not contradict, or the reason why there is none. Where the EDS is
// unclear, the drive is taken not to have the object. Never opens a file, and never answers a question by a guess.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gateway/profile/eds/eds.hpp"

namespace axisgate::profile {

struct FromEds {
  std::string name;  ///< of the profile
  std::string base;  ///< name of the profile that it extends
  std::string file;  ///< the EDS, for "source"
};

struct MadeProfile {
  std::string text;                    ///< JSON; empty: none could be made
  std::vector<std::string> notes;      ///< what was taken, and what was left out and why
  std::vector<std::string> questions;  ///< "ask", each in one line
  std::vector<std::string> faults;     ///< why there is none
};

/// `base`: the whole profile that is extended, put together from its files.
[[nodiscard]] MadeProfile profile_from_eds(const Eds& eds, const nlohmann::json& base, const FromEds& what);

}  // namespace axisgate::profile
