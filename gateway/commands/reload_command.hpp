// SPDX-License-Identifier: Apache-2.0
// `axisgate reload CONFIG`: has the gateway that runs with this file read it anew. Promises to say what was changed, or
// why nothing was, and to wait for that. Never checks or changes anything itself.
#pragma once

#include <string>

namespace axisgate::app {

struct ReloadOptions {
  std::string config;
};

/// Exit code 0: done; 1: refused, or no gateway runs with this file.
[[nodiscard]] int run(const ReloadOptions& options);

}  // namespace axisgate::app
