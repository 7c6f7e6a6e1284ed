// SPDX-License-Identifier: Apache-2.0
// What /metrics has: each metric with its unit in the name, its kind, its labels and what it means.
// Promises one table for the answer, for docs/monitoring.md, and for the rules and the dashboard of deploy/monitoring;
// a counter's name, and no other, ends with _total. Never says where a value comes from.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace axisgate::web {

enum class Metric : std::uint8_t {
  up,
  build_info,
  alarm,
  loop_delay,
  process_restarts,
  clients,
  clients_refused,
  modbus_requests,
  modbus_exceptions,
  modbus_request_duration,
  dds_samples,
  events,
  events_lost,
  bus_up,
  bus_reconnects,
  bus_busy,
  bus_exchanges,
  bus_exchange_duration,
  bus_wait,
  bus_late_replies,
  bus_queue_jobs,
  axis_info,
  axis_link_state,
  axis_state,
  axis_alarm,
  axis_age,
  axis_position,
  axis_velocity,
  axis_torque,
  axis_current,
  axis_temperature,
  axis_faults,
  axis_lease_expiries,
  axis_commands,
  axis_enabled,
  axis_travel,
  web_connections,
  web_streams,
  web_requests,
  web_refused,
  web_gaps,
  web_confined,
};
inline constexpr std::size_t kMetrics = static_cast<std::size_t>(Metric::web_confined) + 1;

enum class MetricKind : std::uint8_t { gauge, counter, histogram };

struct MetricRow {
  Metric metric{};
  std::string_view name;
  MetricKind kind{};
  std::string_view labels;  ///< "axis, state"; empty: none
  std::string_view help;
};

/// In the order of the answer.
[[nodiscard]] std::span<const MetricRow> metric_rows();
[[nodiscard]] const MetricRow& row(Metric metric);
/// The table as docs/monitoring.md has it.
[[nodiscard]] std::string metrics_table_page();

}  // namespace axisgate::web
