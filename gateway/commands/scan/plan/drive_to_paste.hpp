// SPDX-License-Identifier: Apache-2.0
// A drive as `axisgate scan` proposes it for a configuration. Pure.
// Promises each constant that the profile wants, with what it is, and config::kFillIn for its number: a configuration
// with that in it is refused. Never guesses a number.
#pragma once

#include <string>
#include <vector>

#include "gateway/commands/scan/plan/scan_plan.hpp"

namespace axisgate::commands {

/// `identity`: what stands in its braces; empty: the key is left out. `indent`: before each line.
[[nodiscard]] std::string drive_to_paste(const ScanFit& fit, int node, const std::string& identity,
                                         const std::string& indent);
/// What is said above such drives where one of them has something to fill in; else nothing.
[[nodiscard]] std::string to_fill_in(const std::vector<std::string>& drives);

}  // namespace axisgate::commands
