// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/reload_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "gateway/compose/changed_keys.hpp"

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

/// Null: nothing that can be compared.
nlohmann::json parsed(const std::string& text) {
  auto read = profile::parse_json(text);
  return std::holds_alternative<nlohmann::json>(read) ? std::get<nlohmann::json>(std::move(read)) : nullptr;
}

/// What the file said when it was read.
nlohmann::json document_of(const config::Config& config) {
  return config.read.empty() ? nullptr : parsed(config.read.front().text.value_or(""));
}

nlohmann::json part_of(const nlohmann::json& document, const std::string& pointer) {
  const nlohmann::json::json_pointer place(pointer);
  return document.contains(place) ? document.at(place) : nlohmann::json();
}

/// Beside what its section says: what the profiles of its drives say, where they have the names of before.
std::vector<std::string> changed_profiles(const config::BusConfig& running, const config::BusConfig& wanted) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < std::min(running.drives.size(), wanted.drives.size()); ++i) {
    const config::DriveConfig& before = running.drives[i];
    const config::DriveConfig& after = wanted.drives[i];
    if (before.profile != after.profile || before.profile_text == after.profile_text) continue;
    for (const std::string& key : changed_keys(parsed(before.profile_text), parsed(after.profile_text)))
      out.push_back(fmt::format("profile {} of drives/{}: {}", after.profile, i, key));
  }
  return out;
}

/// Compares the two files where a thing of both is changed.
class Teller {
 public:
  Teller(const config::Config& running, const config::Config& wanted, ReloadPlan& plan)
      : running_(document_of(running)), wanted_(document_of(wanted)), plan_(plan) {}

  void tell(const std::string& change) {
    plan_.changes.push_back(change);
    plan_.lines.push_back(change);
  }
  void tell_changed(const std::string& thing, const std::string& before, const std::string& after,
                    std::vector<std::string> more = {}) {
    tell(thing + ": changed");
    std::vector<std::string> keys = changed_keys(part_of(running_, before), part_of(wanted_, after));
    keys.insert(keys.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    for (const std::string& key : bounded(std::move(keys))) plan_.lines.push_back(thing + ": " + key);
  }

 private:
  nlohmann::json running_, wanted_;
  ReloadPlan& plan_;
};

void plan_buses(const config::Config& running, const config::Config& wanted, ReloadPlan& plan, Teller& teller) {
  for (const config::BusConfig& bus : wanted.buses) {
    const auto before = place_of(running.buses, [&](const config::BusConfig& other) { return other.name == bus.name; });
    const bool same = before && without_places(running.buses[*before]) == without_places(bus);
    plan.kept_buses.push_back(same ? before : std::nullopt);
    if (!before)
      teller.tell(fmt::format("bus {}: added", bus.name));
    else if (!same)
      teller.tell_changed("bus " + bus.name, running.buses[*before].pointer, bus.pointer,
                          changed_profiles(running.buses[*before], bus));
  }
  for (std::size_t i = 0; i < running.buses.size(); ++i) {
    if (std::ranges::find(plan.kept_buses, std::optional(i)) != plan.kept_buses.end()) continue;
    plan.leaving_buses.push_back(i);
    const std::string& name = running.buses[i].name;
    if (!place_of(wanted.buses, [&](const config::BusConfig& bus) { return bus.name == name; }))
      teller.tell(fmt::format("bus {}: removed", name));
  }
}

void plan_listeners(const config::Config& running, const config::Config& wanted, ReloadPlan& plan, Teller& teller) {
  const auto pointer = [](std::size_t place) { return fmt::format("/modbus_tcp/{}", place); };
  for (std::size_t i = 0; i < wanted.modbus_tcp.size(); ++i) {
    const auto& listener = wanted.modbus_tcp[i];
    const auto before = place_of(running.modbus_tcp, [&](const auto& other) { return same_address(other, listener); });
    const bool same = before && running.modbus_tcp[*before] == listener;
    plan.kept_listeners.push_back(same ? before : std::nullopt);
    if (!before)
      teller.tell(name_of(listener) + ": added");
    else if (!same)
      teller.tell_changed(name_of(listener), pointer(*before), pointer(i));
  }
  for (std::size_t i = 0; i < running.modbus_tcp.size(); ++i) {
    if (std::ranges::find(plan.kept_listeners, std::optional(i)) != plan.kept_listeners.end()) continue;
    plan.leaving_listeners.push_back(i);
    const auto& listener = running.modbus_tcp[i];
    if (!place_of(wanted.modbus_tcp, [&](const auto& other) { return same_address(other, listener); }))
      teller.tell(name_of(listener) + ": removed");
  }
}

}  // namespace

ReloadPlan plan_reload(const config::Config& running, const config::Config& wanted) {
  ReloadPlan plan;
  Teller teller(running, wanted, plan);
  plan_buses(running, wanted, plan, teller);
  plan_listeners(running, wanted, plan, teller);
  if (const auto keys = changed_dds_keys(running.dds, wanted.dds); !keys.empty()) {
    // A default that follows another key is named as well.
    plan.refusals.push_back(
        fmt::format("/dds: {}: it is read when the gateway starts, since every DDS client would lose its connection: "
                    "restart the gateway when its axes are disabled, or put the section back",
                    fmt::join(keys, ", ")));
  }
  // Nobody's motor depends on a page.
  if (running.web && wanted.web && running.web != wanted.web)
    teller.tell_changed("web", "/web", "/web");
  else if (running.web.has_value() != wanted.web.has_value())
    teller.tell(fmt::format("web: {}", wanted.web ? "added" : "removed"));
  return plan;
}

}  // namespace axisgate::compose
