// SPDX-License-Identifier: Apache-2.0
// What `axisgate check` says of the death of an axis's masters: the client that owns it, and the gateway.
// Promises to tell, for each axis, who counts as alive, the time from a dead program to the stop, what that stop is on
// this drive, and what the drive does by itself. Never looks at a running gateway.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/check/check_lines.hpp"
#include "gateway/config/bus_budget.hpp"
#include "gateway/config/config_loader.hpp"

namespace axisgate::check {

/// One axis with all that its fate hangs on.
struct MasteredAxis {
  const config::AxisConfig& config;
  const model::AxisModel& model;
  const model::DriveModel& drive;
  const config::BusBudget& budget;  ///< of its bus
  const std::optional<dds::DdsSettings>& dds;
};

[[nodiscard]] ReportLines master_lines(const MasteredAxis& axis);

/// What is dangerous or will not work in the leases of this configuration; `budgets`: one per bus.
[[nodiscard]] std::vector<std::string> lease_warnings(const config::LoadedConfig& loaded,
                                                      const std::vector<config::BusBudget>& budgets);

}  // namespace axisgate::check
