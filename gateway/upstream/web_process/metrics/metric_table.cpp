// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/metrics/metric_table.hpp"

#include <fmt/format.h>

#include <array>

namespace axisgate::web {
namespace {

using enum MetricKind;

constexpr std::array<MetricRow, kMetrics> kRows{{
    {Metric::up, "axisgate_up", gauge, "",
     "1 while the gateway is heard; 0: of the gateway, its buses and axes there is nothing else here"},
    {Metric::build_info, "axisgate_build_info", gauge, "version, gateway", "always 1"},
    {Metric::alarm, "axisgate_alarm", gauge, "alarm", "1 while this alarm of the gateway is set"},
    {Metric::loop_delay, "axisgate_loop_delay_seconds", histogram, "",
     "how late the gateway's loop was, looked at four times a second"},
    {Metric::process_restarts, "axisgate_process_restarts_total", counter, "process",
     "how often a program of the gateway's was started again"},
    {Metric::clients, "axisgate_clients", gauge, "", "connections of Modbus-TCP clients"},
    {Metric::clients_refused, "axisgate_clients_refused_total", counter, "",
     "connections that no allow entry names, or above a limit"},
    {Metric::modbus_requests, "axisgate_modbus_requests_total", counter, "", "requests of Modbus-TCP clients"},
    {Metric::modbus_exceptions, "axisgate_modbus_exceptions_total", counter, "exception",
     "answers to them that are an exception"},
    {Metric::modbus_request_duration, "axisgate_modbus_request_duration_seconds", histogram, "",
     "from a request to its answer; a read is answered at once"},
    {Metric::dds_samples, "axisgate_dds_samples_total", counter, "direction",
     "samples to and from axisgate-dds: sent, received"},
    {Metric::events, "axisgate_events_total", counter, "kind", "events of the gateway, its buses and axes"},
    {Metric::events_lost, "axisgate_events_lost_total", counter, "",
     "of them those that were overwritten before the page took them"},
    {Metric::bus_up, "axisgate_bus_up", gauge, "bus", "1 while the port or CAN interface is there"},
    {Metric::bus_reconnects, "axisgate_bus_reconnects_total", counter, "bus", "how often the line came back"},
    {Metric::bus_busy, "axisgate_bus_busy_seconds_total", counter, "bus",
     "time with an exchange on the wire; on CAN, with any frame"},
    {Metric::bus_exchanges, "axisgate_bus_exchanges_total", counter, "bus, result",
     "exchanges with drives: answered, timed_out"},
    {Metric::bus_exchange_duration, "axisgate_bus_exchange_duration_seconds", histogram, "bus",
     "from a request on the wire to its answer, or its timeout"},
    {Metric::bus_wait, "axisgate_bus_wait_seconds", histogram, "bus, class",
     "how long what is to be sent waited for the wire"},
    {Metric::bus_late_replies, "axisgate_bus_late_replies_total", counter, "bus",
     "answers to exchanges that had been given up"},
    {Metric::bus_queue_jobs, "axisgate_bus_queue_jobs", gauge, "bus", "what waits for the wire now"},
    {Metric::axis_info, "axisgate_axis_info", gauge, "axis, name, bus, drive, profile, node", "always 1"},
    {Metric::axis_link_state, "axisgate_axis_link_state", gauge, "axis, state", "1 for the link state that it has"},
    {Metric::axis_state, "axisgate_axis_state", gauge, "axis, state", "1 for the axis state that it has"},
    {Metric::axis_alarm, "axisgate_axis_alarm", gauge, "axis, alarm", "1 while this alarm of the axis is set"},
    {Metric::axis_age, "axisgate_axis_age_seconds", gauge, "axis", "age of its oldest cyclic value"},
    {Metric::axis_position, "axisgate_axis_position_revolutions", gauge, "axis", "position of the motor"},
    {Metric::axis_velocity, "axisgate_axis_velocity_revolutions_per_second", gauge, "axis", "velocity of the motor"},
    {Metric::axis_torque, "axisgate_axis_torque_ratio", gauge, "axis", "torque; 1 is the rated one"},
    {Metric::axis_current, "axisgate_axis_current_amperes", gauge, "axis", "current of the motor, effective"},
    {Metric::axis_temperature, "axisgate_axis_temperature_celsius", gauge, "axis, sensor", "temperature: drive, motor"},
    {Metric::axis_faults, "axisgate_axis_faults_total", counter, "axis", "faults of the drive"},
    {Metric::axis_lease_expiries, "axisgate_axis_lease_expiries_total", counter, "axis",
     "leases that have run out: an owner was silent, or nobody took the axis over"},
    {Metric::axis_commands, "axisgate_axis_commands_total", counter, "axis, command, result",
     "commands of clients that have ended; of each command that the axis has, done is here from the start"},
    {Metric::axis_enabled, "axisgate_axis_enabled_seconds_total", counter, "axis", "time with torque"},
    {Metric::axis_travel, "axisgate_axis_travel_revolutions_total", counter, "axis",
     "way of the motor to and fro, as far as it was seen, in steps of 0.001; not while it homes"},
    {Metric::web_connections, "axisgate_web_connections", gauge, "", "connections to the page and the API"},
    {Metric::web_streams, "axisgate_web_streams", gauge, "", "of them streams"},
    {Metric::web_requests, "axisgate_web_requests_total", counter, "", "requests of the page, the API and scrapers"},
    {Metric::web_refused, "axisgate_web_refused_total", counter, "reason", "of them those that were refused"},
    {Metric::web_gaps, "axisgate_web_gaps_total", counter, "",
     "samples of axes that were left out since axisgate-web was slow"},
    {Metric::web_confined, "axisgate_web_confined", gauge, "",
     "1 where the kernel's filter of calls is in force for axisgate-web"},
}};

consteval bool rows_in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i)
    if (static_cast<std::size_t>(kRows[i].metric) != i) return false;
  return true;
}
static_assert(rows_in_order(), "a metric's number is its position in the table");

constexpr std::string_view text(MetricKind kind) {
  return kind == gauge ? "gauge" : kind == counter ? "counter" : "histogram";
}

}  // namespace

std::span<const MetricRow> metric_rows() { return kRows; }

const MetricRow& row(Metric metric) { return kRows[static_cast<std::size_t>(metric)]; }

std::string metrics_table_page() {
  std::string out = "| metric | kind | labels | what |\n|---|---|---|---|\n";
  for (const MetricRow& each : kRows)
    out += fmt::format("| {} | {} | {} | {} |\n", each.name, text(each.kind), each.labels, each.help);
  return out;
}

}  // namespace axisgate::web
