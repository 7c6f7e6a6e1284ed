// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/can_wires.hpp"

#include <algorithm>

namespace axisgate::compose {
namespace {

/// The shorter of two periods; 0 is none.
Duration shorter(Duration a, Duration b) {
  if (a == Duration{} || b == Duration{}) return std::max(a, b);
  return std::min(a, b);
}

}  // namespace

canopen::CanopenSettings canopen_settings(const config::BusConfig& bus, const std::vector<model::DriveModel>& drives) {
  canopen::CanopenSettings settings;
  settings.name = bus.name;
  settings.own_node = model::kOwnNode;
  settings.timeout = bus.timeout;
  for (const model::DriveModel& drive : drives) {
    const model::CanopenProperties& facts = drive.canopen;
    settings.own_heartbeat = shorter(settings.own_heartbeat, facts.own_heartbeat);
    settings.sync = shorter(settings.sync, facts.sync);
    settings.nodes.push_back({drive.node, facts.heartbeat, facts.guard_time, facts.life_factor, facts.sdo_block});
  }
  return settings;
}

}  // namespace axisgate::compose
