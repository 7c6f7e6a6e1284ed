// SPDX-License-Identifier: Apache-2.0
// `axisgate commission CONFIG AXIS`: shows the settings of a drive that a person must decide, asks about each that is
// bad, and applies its remedy.
// Promises to change nothing before a yes, nothing that the question did not name, and nothing that changed meanwhile;
// and that polls and heartbeats go on while it waits for the answer.
// Never enables or moves an axis.
#pragma once

#include <string>
#include <vector>

namespace axisgate::commands {

struct CommissionOptions {
  std::string config;
  std::string axis;  ///< its number, or its name
  std::vector<std::string> profile_folders;
  bool yes = false;  ///< the answer to every question
};

[[nodiscard]] int run(const CommissionOptions& options);

}  // namespace axisgate::commands
