// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/reload_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace axisgate::compose {
namespace {

/// Where in its file a thing stands does not change it.
config::BusConfig without_places(config::BusConfig bus) {
  bus.pointer.clear();
  for (config::DriveConfig& drive : bus.drives) {
    drive.pointer.clear();
    for (config::AxisConfig& axis : drive.axes) axis.pointer.clear();
  }
  return bus;
}

/// Which keys the two differ in; the axes' units are those of the buses, and follow them.
std::vector<std::string_view> changed_dds_keys(const std::optional<dds::DdsSettings>& running,
                                               const std::optional<dds::DdsSettings>& wanted) {
  if (!running && !wanted) return {};
  if (!running || !wanted) return {wanted ? "the section is new" : "the section is gone"};
  const dds::DdsSettings& a = *running;
  const dds::DdsSettings& b = *wanted;
  const std::pair<std::string_view, bool> looks[] = {{"/gateway/name", a.gateway != b.gateway},
                                                     {"domain", a.domain != b.domain},
                                                     {"interfaces", a.interfaces != b.interfaces},
                                                     {"shared_memory", a.shared_memory != b.shared_memory},
                                                     {"peers", a.peers != b.peers},
                                                     {"discovery_servers", a.discovery_servers != b.discovery_servers},
                                                     {"multicast", a.multicast != b.multicast},
                                                     {"qos_file", a.qos_file != b.qos_file},
                                                     {"commands", a.commands != b.commands},
                                                     {"role", a.role != b.role},
                                                     {"roles", a.roles != b.roles},
                                                     {"max_age_ms", a.max_age != b.max_age},
                                                     {"ros2", a.ros2 != b.ros2},
                                                     {"sync_tolerance", a.sync_tolerance != b.sync_tolerance},
                                                     {"min_period_ms", a.min_period != b.min_period},
                                                     {"max_period_ms", a.max_period != b.max_period},
                                                     {"start_deadline_ms", a.start_deadline != b.start_deadline},
                                                     {"reply_deadline_ms", a.reply_deadline != b.reply_deadline},
                                                     {"memory_limit_mb", a.memory_limit_mib != b.memory_limit_mib}};
  std::vector<std::string_view> keys;
  for (const auto& [key, changed] : looks)
    if (changed) keys.push_back(key);
  return keys;
}

std::string name_of(const modbus_tcp::ListenerSettings& listener) {
  return "listener " + modbus_tcp::address_text(listener.host, listener.port);
}

template <class Item, class Same>
std::optional<std::size_t> place_of(const std::vector<Item>& items, const Same& same) {
  const auto found = std::find_if(items.begin(), items.end(), same);
  if (found == items.end()) return std::nullopt;
  return static_cast<std::size_t>(found - items.begin());
}

void plan_buses(const config::Config& running, const config::Config& wanted, ReloadPlan& plan) {
  for (const config::BusConfig& bus : wanted.buses) {
    const auto before = place_of(running.buses, [&](const config::BusConfig& other) { return other.name == bus.name; });
    const bool same = before && without_places(running.buses[*before]) == without_places(bus);
    plan.kept_buses.push_back(same ? before : std::nullopt);
    if (!same) plan.changes.push_back(fmt::format("bus {}: {}", bus.name, before ? "changed" : "added"));
  }
  for (std::size_t i = 0; i < running.buses.size(); ++i) {
    if (std::ranges::find(plan.kept_buses, std::optional(i)) != plan.kept_buses.end()) continue;
    plan.leaving_buses.push_back(i);
    const std::string& name = running.buses[i].name;
    if (!place_of(wanted.buses, [&](const config::BusConfig& bus) { return bus.name == name; }))
      plan.changes.push_back(fmt::format("bus {}: removed", name));
  }
}

void plan_listeners(const config::Config& running, const config::Config& wanted, ReloadPlan& plan) {
  for (const auto& listener : wanted.modbus_tcp) {
    const auto before = place_of(running.modbus_tcp, [&](const auto& other) { return same_address(other, listener); });
    const bool same = before && running.modbus_tcp[*before] == listener;
    plan.kept_listeners.push_back(same ? before : std::nullopt);
    if (!same) plan.changes.push_back(fmt::format("{}: {}", name_of(listener), before ? "changed" : "added"));
  }
  for (std::size_t i = 0; i < running.modbus_tcp.size(); ++i) {
    if (std::ranges::find(plan.kept_listeners, std::optional(i)) != plan.kept_listeners.end()) continue;
    plan.leaving_listeners.push_back(i);
    const auto& listener = running.modbus_tcp[i];
    if (!place_of(wanted.modbus_tcp, [&](const auto& other) { return same_address(other, listener); }))
      plan.changes.push_back(name_of(listener) + ": removed");
  }
}

}  // namespace

ReloadPlan plan_reload(const config::Config& running, const config::Config& wanted) {
  ReloadPlan plan;
  plan_buses(running, wanted, plan);
  plan_listeners(running, wanted, plan);
  if (const auto keys = changed_dds_keys(running.dds, wanted.dds); !keys.empty()) {
    // A default that follows another key is named as well.
    plan.refusals.push_back(
        fmt::format("/dds: {}: it is read when the gateway starts, since every DDS client would lose its connection: "
                    "restart the gateway when its axes are disabled, or put the section back",
                    fmt::join(keys, ", ")));
  }
  // Nobody's motor depends on a page.
  if (running.web != wanted.web)
    plan.changes.push_back(fmt::format("web: {}", !running.web ? "added" : !wanted.web ? "removed" : "changed"));
  return plan;
}

}  // namespace axisgate::compose
