// SPDX-License-Identifier: Apache-2.0
// `axisgate check CONFIG`: validates a configuration and prints what it comes to.
// Promises every mistake at once, and for a right one the plan of each bus and the facts of each axis that matter for
// safety. Never opens a port.
#pragma once

#include <string>
#include <vector>

namespace axisgate::commands {

struct CheckOptions {
  std::string config;
  std::vector<std::string> profile_folders;
};

/// 0: right. 1: mistakes, or a bus over 100 %.
[[nodiscard]] int run(const CheckOptions& options);

}  // namespace axisgate::commands
