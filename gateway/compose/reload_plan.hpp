// SPDX-License-Identifier: Apache-2.0
// What a reload changes: the running configuration against the wanted one. Pure.
// Promises that a bus whose section and profiles say the same is untouched, wherever it stands in the file; that a
// listener that says the same keeps its connections; that what cannot change while the gateway runs is refused by its
// key. Never asks whether a motor has torque: gateway/compose/bus_release.hpp does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/config/config.hpp"

namespace axisgate::compose {

struct ReloadPlan {
  /// Of each bus of the wanted configuration: its place in the running one, where it goes on untouched.
  std::vector<std::optional<std::size_t>> kept_buses;
  /// Places of buses of the running configuration that end: changed or removed.
  std::vector<std::size_t> leaving_buses;
  /// Of each listener of the wanted configuration: its place in the running one, where it goes on untouched.
  std::vector<std::optional<std::size_t>> kept_listeners;
  /// Places of listeners of the running configuration whose connections are closed: changed or removed.
  std::vector<std::size_t> leaving_listeners;
  /// Why it cannot be done while the gateway runs: "/dds: ...". With one of them nothing is done.
  std::vector<std::string> refusals;
  /// What it does, one line each: "bus lift: changed".
  std::vector<std::string> changes;
  /// The same, and behind each thing that is changed its keys: "bus lift: drives/0/node 1 -> 2", as far as
  /// kMostChangedKeys of each.
  std::vector<std::string> lines;
};

[[nodiscard]] ReloadPlan plan_reload(const config::Config& running, const config::Config& wanted);

}  // namespace axisgate::compose
