// SPDX-License-Identifier: Apache-2.0
// How every command ends where a file is wrong: each mistake on a line of its own, to stderr.
// Promises the same words whichever command found them.
// Never goes on after them.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <vector>

#include "gateway/config/config_fault.hpp"

namespace axisgate::commands {

/// The exit code: 1 where there is one.
[[nodiscard]] inline int tell(const std::vector<config::ConfigFault>& faults) {
  for (const config::ConfigFault& fault : faults) fmt::print(stderr, "{}\n", text(fault));
  return faults.empty() ? 0 : 1;
}

}  // namespace axisgate::commands
