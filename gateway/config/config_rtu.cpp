// SPDX-License-Identifier: Apache-2.0
// What a Modbus RTU line needs follows from its drives, so it is settled once their profiles are known.
#include <fmt/format.h>

#include <algorithm>

#include "gateway/config/adapter_names.hpp"
#include "gateway/config/bus_budget.hpp"
#include "gateway/config/config_sections.hpp"
#include "gateway/drive/device/read_blocks.hpp"

namespace axisgate::config {
namespace {

using std::chrono::milliseconds;

/// The longest request and reply that the gateway's own reads and writes come to.
Duration longest_on_wire(const BusConfig& bus, const std::vector<model::DriveModel>& drives) {
  const BusTiming timing = timing_of(bus);
  Duration longest = timing.on_wire;
  for (const model::DriveModel& model : drives)
    for (const drive::PlannedRead& read : drive::planned_reads(model))
      longest = std::max(longest, wire_time_of(timing, read.exchange));
  return longest;
}

void check_nodes(const BusConfig& bus, const std::vector<model::DriveModel>& drives, ConfigFaults& faults) {
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const std::uint8_t node = drives[i].node;
    const bool broadcast =
        std::ranges::any_of(drives, [&](const model::DriveModel& model) { return model.rtu.broadcast == node; });
    if (node == 0 || broadcast)
      faults.add(bus.drives[i].pointer + "/node",
                 fmt::format("{} is an address that every drive obeys and none answers: give the drive a number of its "
                             "own, 1 to 247",
                             node));
  }
}

}  // namespace

void settle_rtu_buses(Config& config, std::vector<std::vector<model::DriveModel>>& models, ConfigFaults& faults) {
  for (std::size_t i = 0; i < config.buses.size(); ++i) {
    BusConfig& bus = config.buses[i];
    if (bus.adapter != adapter::kModbusRtu) continue;
    check_nodes(bus, models[i], faults);
    settle_timeout(bus, models[i], longest_on_wire(bus, models[i]),
                   fmt::format("an exchange takes on the wire at {} baud", bus.baud), faults);
    settle_poll(bus, models[i]);
  }
}

}  // namespace axisgate::config
