// SPDX-License-Identifier: Apache-2.0
// What `axisgate check` says of a canopen bus beyond its plan: how the interface is brought up, what comes by TPDO and
// what by SDO. Promises to name what is only tried (mapping) and what takes its place where a drive refuses.
// Never looks whether the interface exists.
#pragma once

#include <string>
#include <vector>

#include "gateway/check/check_lines.hpp"
#include "gateway/config/bus_budget.hpp"

namespace axisgate::check {

/// "500000 bit/s"
[[nodiscard]] std::string bitrate_text(const config::BusConfig& bus);
/// How the interface or adapter is brought up.
[[nodiscard]] std::string interface_text(const config::BusConfig& bus);
[[nodiscard]] ReportLines can_lines(const config::BusConfig& bus, const std::vector<model::DriveModel>& drives,
                                    const config::BusBudget& budget);

}  // namespace axisgate::check
