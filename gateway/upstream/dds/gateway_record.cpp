// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/gateway_record.hpp"

namespace axisgate::dds {

static_assert(kMaxBuses <= kMaxBusesShown);

GatewayRecord gateway_record(const ProcessImage& image, std::uint32_t events_lost) {
  image.refresh();
  GatewayRecord out;
  out.state = static_cast<std::uint8_t>(image.gateway.state);
  out.axis_count = static_cast<std::uint16_t>(image.axes().size());
  out.axes_online = image.gateway.axes_online;
  out.uptime_s = image.gateway.uptime_s;
  out.alarms = image.gateway.alarms;
  out.events_lost = events_lost;
  for (const BusImage& bus : image.buses) {
    out.buses.push_back({bus.name,
                         static_cast<std::uint8_t>(bus.link),
                         bus.load_permille,
                         bus.cycle_ms,
                         bus.queue_depth,
                         {bus.requests, bus.replies, bus.timeouts, bus.bad_frames, bus.late_replies, bus.dropped_bytes,
                          bus.refused, bus.coalesced, bus.superseded, bus.reconnects}});
  }
  return out;
}

}  // namespace axisgate::dds
