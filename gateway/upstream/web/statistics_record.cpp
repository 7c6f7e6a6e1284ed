// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web/statistics_record.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::web {

static_assert(web::kMaxBuses >= axisgate::kMaxBuses);
static_assert(web::kExchangeClasses == axisgate::kExchangeClasses);
static_assert(web::kTimeBuckets == axisgate::kTimeBuckets);

StatisticsRecord statistics_record(const ProcessImage& image, ProcessFigures figures, std::uint32_t events_lost,
                                   Instant now) {
  image.refresh();
  StatisticsRecord out;
  out.at = now.time_since_epoch().count();
  out.state = static_cast<std::uint8_t>(image.gateway.state);
  out.axes_online = image.gateway.axes_online;
  out.alarms = image.gateway.alarms;
  out.events_lost = events_lost;
  const auto worst = std::chrono::duration_cast<std::chrono::microseconds>(figures.worst_turn).count();
  out.worst_turn_us = static_cast<std::uint32_t>(std::clamp<std::int64_t>(worst, 0, UINT32_MAX));
  out.modbus_clients = figures.modbus_clients;
  out.modbus_refused = figures.modbus_refused;
  out.programs = std::move(figures.programs);
  for (const BusImage& bus : image.buses) {
    out.buses.push_back({static_cast<std::uint8_t>(bus.link),
                         bus.load_permille,
                         bus.cycle_ms,
                         bus.queue_depth,
                         {bus.requests, bus.replies, bus.timeouts, bus.bad_frames, bus.late_replies, bus.dropped_bytes,
                          bus.refused, bus.coalesced, bus.superseded, bus.reconnects, bus.echoes},
                         bus.times});
  }
  return out;
}

}  // namespace axisgate::web
