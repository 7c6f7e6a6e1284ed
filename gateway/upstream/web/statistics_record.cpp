// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web/statistics_record.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::web {

static_assert(web::kMaxBuses >= axisgate::kMaxBuses);
static_assert(web::kExchangeClasses == axisgate::kExchangeClasses);
static_assert(web::kEventKindsShown == axisgate::kEventKinds);

StatisticsRecord statistics_record(const ProcessImage& image, ProcessFigures figures, const EventFigures& events,
                                   Instant now) {
  image.refresh();
  StatisticsRecord out;
  out.at = now.time_since_epoch().count();
  out.state = static_cast<std::uint8_t>(image.gateway.state);
  out.axes_online = image.gateway.axes_online;
  out.alarms = image.gateway.alarms;
  out.events_lost = events.lost;
  out.events = events.added;
  const auto worst = std::chrono::duration_cast<std::chrono::microseconds>(figures.worst_turn).count();
  out.worst_turn_us = static_cast<std::uint32_t>(std::clamp<std::int64_t>(worst, 0, UINT32_MAX));
  out.modbus_clients = figures.modbus_clients;
  out.modbus_refused = figures.modbus_refused;
  out.modbus_requests = figures.modbus_requests;
  out.modbus_exceptions = figures.modbus_exceptions;
  out.modbus_took = figures.modbus_took;
  out.loop_late = figures.loop_late;
  out.has_dds = figures.dds.has_value();
  const ProcessFigures::Dds dds = figures.dds.value_or(ProcessFigures::Dds{});
  out.dds_sent = dds.sent;
  out.dds_received = dds.received;
  out.programs = std::move(figures.programs);
  for (const BusImage& bus : image.buses) {
    out.buses.push_back({static_cast<std::uint8_t>(bus.link),
                         bus.load_permille,
                         bus.cycle_ms,
                         bus.queue_depth,
                         {bus.requests, bus.replies, bus.timeouts, bus.bad_frames, bus.late_replies, bus.dropped_bytes,
                          bus.refused, bus.coalesced, bus.superseded, bus.reconnects, bus.echoes}});
  }
  return out;
}

BusCounts bus_counts(const BusImage& bus, std::size_t place) {
  const auto busy = std::chrono::duration_cast<std::chrono::microseconds>(bus.busy).count();
  return {static_cast<std::uint8_t>(place), static_cast<std::uint64_t>(busy), bus.times, bus.waits};
}

AxisCountsRow axis_counts(const AxisImage& axis) {
  const AxisCounts& counts = *axis.counts;
  AxisCountsRow out;
  out.axis = axis.number;
  out.faults = counts.faults;
  out.lease_expiries = counts.lease_expiries;
  const auto enabled = std::chrono::duration_cast<std::chrono::milliseconds>(counts.enabled).count();
  out.enabled_ms = static_cast<std::uint64_t>(enabled);
  out.travel_microturns = counts.travel_microturns;
  for (const auto& [of, count] : counts.commands)
    out.commands.push_back({static_cast<std::uint8_t>(of.first), static_cast<std::uint8_t>(of.second), count});
  return out;
}

}  // namespace axisgate::web
