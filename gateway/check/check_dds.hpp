// SPDX-License-Identifier: Apache-2.0
// What `axisgate check` says of the DDS server: what is published, how often, who may command, and when a DDS client
// that has died is noticed. Promises to say nothing where the configuration has no key "dds". Never looks whether
// axisgate-dds is there: that is a matter of the machine, not of the file.
#pragma once

#include "gateway/check/check_lines.hpp"
#include "gateway/config/bus_budget.hpp"
#include "gateway/config/config.hpp"

namespace axisgate::check {

/// "DDS: domain 0 on lo".
[[nodiscard]] std::string dds_title(const dds::DdsSettings& settings);
[[nodiscard]] ReportLines dds_lines(const dds::DdsSettings& settings);

/// Of one axis, as far as DDS clients may own it. `budget`: of its bus.
[[nodiscard]] ReportLines dds_master_lines(const dds::DdsSettings& settings, const config::AxisConfig& axis,
                                           const config::BusBudget& budget);

}  // namespace axisgate::check
