// SPDX-License-Identifier: Apache-2.0
// What `axisgate check` says of an axis's `limits`: what they are in rpm and turns, which are missing or look like a
// mistake of units, keys that bound nothing on the drive, and what they do not reach.
// Promises file, key and what to change. Never refuses: such a limit does no harm but that somebody trusts in it.
#pragma once

#include <string>
#include <vector>

#include "gateway/check/check_lines.hpp"
#include "gateway/config/config_loader.hpp"

namespace axisgate::check {

[[nodiscard]] ReportLines limit_lines(const config::AxisConfig& config, const model::AxisModel& axis);
[[nodiscard]] std::vector<std::string> limit_warnings(const config::LoadedConfig& loaded);

}  // namespace axisgate::check
