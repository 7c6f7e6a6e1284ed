// SPDX-License-Identifier: Apache-2.0
// What `axisgate scan` shows of the nodes that it found: a table, what is odd about a node, and the lines with which a
// configuration may begin. Pure.
// Promises that all it shows is what the nodes said. Never calls a profile certain: it tells how much of it fits.
#pragma once

#include <string>
#include <vector>

#include "gateway/commands/scan/plan/scan_plan.hpp"

namespace axisgate::commands {

/// Lines, each with its end; empty where nobody was found.
[[nodiscard]] std::string scan_table(const std::vector<FoundNode>& nodes);

}  // namespace axisgate::commands
