// SPDX-License-Identifier: Apache-2.0
// What `axisgate check` says about a right configuration: the plan of each bus and what matters for safety on each
// axis. Promises to name what a drive does when the gateway dies, what it cannot give on its protocol, and every
// assumption. Never reads a file or a port: it looks at a loaded configuration.
#pragma once

#include <string>

#include "gateway/config/config_loader.hpp"

namespace axisgate::check {

struct CheckReport {
  std::string text;  ///< lines, each ended by a newline
  bool overloaded = false;
};

[[nodiscard]] CheckReport report(const config::LoadedConfig& loaded);

}  // namespace axisgate::check
