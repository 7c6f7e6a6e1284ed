// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/reload_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::app {
namespace {

/// Where in its file a thing stands does not change it.
BusConfig without_places(BusConfig bus) {
  bus.pointer.clear();
  for (DriveConfig& drive : bus.drives) {
    drive.pointer.clear();
    for (AxisConfig& axis : drive.axes) axis.pointer.clear();
  }
  return bus;
}

/// The axes' units are those of the buses, and follow them.
std::optional<dds::DdsSettings> without_axes(std::optional<dds::DdsSettings> settings) {
  if (settings) settings->units.clear();
  return settings;
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

void plan_buses(const Config& running, const Config& wanted, ReloadPlan& plan) {
  for (const BusConfig& bus : wanted.buses) {
    const auto before = place_of(running.buses, [&](const BusConfig& other) { return other.name == bus.name; });
    const bool same = before && without_places(running.buses[*before]) == without_places(bus);
    plan.kept_buses.push_back(same ? before : std::nullopt);
    if (!same) plan.changes.push_back(fmt::format("bus {}: {}", bus.name, before ? "changed" : "added"));
  }
  for (std::size_t i = 0; i < running.buses.size(); ++i) {
    if (std::ranges::find(plan.kept_buses, std::optional(i)) != plan.kept_buses.end()) continue;
    plan.leaving_buses.push_back(i);
    const std::string& name = running.buses[i].name;
    if (!place_of(wanted.buses, [&](const BusConfig& bus) { return bus.name == name; }))
      plan.changes.push_back(fmt::format("bus {}: removed", name));
  }
}

void plan_listeners(const Config& running, const Config& wanted, ReloadPlan& plan) {
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

ReloadPlan plan_reload(const Config& running, const Config& wanted) {
  ReloadPlan plan;
  plan_buses(running, wanted, plan);
  plan_listeners(running, wanted, plan);
  if (without_axes(running.dds) != without_axes(wanted.dds)) {
    plan.refusals.emplace_back(
        "/dds: it is read when the gateway starts, since every DDS client would lose its connection: restart the "
        "gateway when its axes are "
        "disabled, or put the section back");
  }
  return plan;
}

}  // namespace axisgate::app
