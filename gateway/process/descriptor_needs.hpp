// SPDX-License-Identifier: Apache-2.0
// What a configuration asks of the limit on open files.
// Promises to count every client that the listeners may let in, every bus with a port of its own, and what joins
// axisgate-dds and axisgate-web.
// Never looks at the system.
#pragma once

#include "gateway/config/config.hpp"
#include "gateway/upstream/host/child_process.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptor_plan.hpp"

namespace axisgate::process {

[[nodiscard]] inline modbus_tcp::DescriptorNeeds descriptor_needs(const config::Config& config) {
  modbus_tcp::DescriptorNeeds needs;
  needs.listeners = config.modbus_tcp.size();
  needs.buses = config.buses.size();
  needs.others = (config.dds ? host::kDescriptorsNeeded : 0) + (config.web ? host::kDescriptorsNeeded : 0);
  for (const auto& listener : config.modbus_tcp) needs.clients += listener.max_clients;
  return needs;
}

}  // namespace axisgate::process
