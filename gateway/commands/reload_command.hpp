// SPDX-License-Identifier: Apache-2.0
// `axisgate reload CONFIG`: has the gateway that runs with this file read it again. Promises to say what was changed,
// or why nothing was, and to wait for that as long as the gateway lives, not for one that hangs. Never checks or
// changes anything itself.
#pragma once

#include <string>

#include "gateway/core/clock.hpp"

namespace axisgate::commands {

struct ReloadOptions {
  std::string config;
  Duration patience = std::chrono::seconds(5);  ///< so long at most it shows no sign of life
};

/// Exit code 0: done; 1: refused, or no gateway runs with this file, or it hangs.
[[nodiscard]] int run(const ReloadOptions& options);

}  // namespace axisgate::commands
