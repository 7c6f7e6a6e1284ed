// SPDX-License-Identifier: Apache-2.0
// The sections of the report that `axisgate check` prints, and its warnings, each made by a function of its own.
// Promises to name what is only tried and what takes its place, what is missing or looks like a mistake of units, who
// counts as alive, and what stops an axis when a master of it dies. Never refuses anything, and never looks at this
// machine or a running gateway.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/check/check_lines.hpp"
#include "gateway/config/bus_budget.hpp"
#include "gateway/config/config_loader.hpp"

namespace axisgate::check {

// --- A bus on CAN ----------------------------------------------------------------------------------------------------

/// "500000 bit/s"
[[nodiscard]] std::string bitrate_text(const config::BusConfig& bus);
/// How the interface or adapter is brought up.
[[nodiscard]] std::string interface_text(const config::BusConfig& bus);
/// canopen, beyond its plan: what comes by TPDO and what by SDO.
[[nodiscard]] ReportLines can_lines(const config::BusConfig& bus, const std::vector<model::DriveModel>& drives,
                                    const config::BusBudget& budget);

// --- DDS -------------------------------------------------------------------------------------------------------------

/// "DDS: domain 0 on lo".
[[nodiscard]] std::string dds_title(const dds::DdsSettings& settings);
/// What is published, how often, and who may command.
[[nodiscard]] ReportLines dds_lines(const dds::DdsSettings& settings);
/// Of one axis, as far as DDS clients may own it: when one that has died is noticed. `budget`: of its bus.
[[nodiscard]] ReportLines dds_master_lines(const dds::DdsSettings& settings, const config::AxisConfig& axis,
                                           const config::BusBudget& budget);

// --- The page --------------------------------------------------------------------------------------------------------

/// "Web: http://127.0.0.1:8080/".
[[nodiscard]] std::string web_title(const web::WebSettings& settings);
/// Who may look and from where, how far back it shows and what it may take. @param values of all axes together
[[nodiscard]] ReportLines web_lines(const web::WebSettings& settings, std::size_t values);

// --- An axis ---------------------------------------------------------------------------------------------------------

/// What its `limits` are in rpm and turns, and which are missing.
[[nodiscard]] ReportLines limit_lines(const config::AxisConfig& config, const model::AxisModel& axis);
/// What bounds nothing on the drive, does not reach what it should or looks like another unit, and constants without
/// which nobody sees how hard a motor works. Each with file, line, key and what to change.
[[nodiscard]] std::vector<std::string> limit_warnings(const config::LoadedConfig& loaded);

/// What of it is watched, and what is done then; where the drive shows nothing that could be watched, that.
[[nodiscard]] ReportLines watch_lines(const model::AxisModel& axis);

/// One axis with all that its fate hangs on.
struct MasteredAxis {
  const config::AxisConfig& config;
  const model::AxisModel& model;
  const model::DriveModel& drive;
  const config::BusBudget& budget;  ///< of its bus
  const std::optional<dds::DdsSettings>& dds;
};
/// The death of its masters, the client that owns it and the gateway: the time from a dead program to the stop, what
/// that stop is on this drive, and what the drive does by itself.
[[nodiscard]] ReportLines master_lines(const MasteredAxis& axis);
/// What is dangerous or will not work in the leases of this configuration; `budgets`: one per bus.
[[nodiscard]] std::vector<std::string> lease_warnings(const config::LoadedConfig& loaded,
                                                      const std::vector<config::BusBudget>& budgets);

}  // namespace axisgate::check
