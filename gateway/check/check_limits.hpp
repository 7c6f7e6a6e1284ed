// SPDX-License-Identifier: Apache-2.0
// What `axisgate check` says of an axis's `limits`: keys that bound nothing on its drive, and what they do not reach.
// Promises file, key and what to change. Never refuses: such a limit does no harm but that somebody trusts in it.
#pragma once

#include <string>
#include <vector>

#include "gateway/config/config_loader.hpp"

namespace axisgate::app {

[[nodiscard]] std::vector<std::string> limit_warnings(const LoadedConfig& loaded);

}  // namespace axisgate::app
