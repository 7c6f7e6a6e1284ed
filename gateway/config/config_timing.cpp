// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "gateway/config/bus_budget.hpp"
#include "gateway/config/config_sections.hpp"

namespace axisgate::config {

void settle_timeout(BusConfig& bus, const std::vector<model::DriveModel>& drives, Duration on_wire,
                    const std::string& takes, ConfigFaults& faults) {
  using std::chrono::milliseconds;
  constexpr int kRoom = 20;  // ms above the wire's time, for the drive
  if (bus.timeout == Duration{}) {
    Duration answer{};
    for (const model::DriveModel& model : drives) answer = std::max(answer, model.timeout);
    bus.timeout = (on_wire + answer + milliseconds(1) - Duration(1)) / milliseconds(1) * milliseconds(1);
  } else if (bus.timeout <= on_wire) {
    faults.add(bus.pointer + "/timeout_ms",
               fmt::format("{} ms is less than {} ({:.1f} ms), every answer would come too late: write at least {}",
                           bus.timeout / milliseconds(1), takes, static_cast<double>(on_wire.count()) / 1e6,
                           on_wire / milliseconds(1) + kRoom));
  }
}

void settle_poll(BusConfig& bus, std::vector<model::DriveModel>& drives) {
  if (!bus.poll_given) bus.poll = comfortable_periods(plan_bus(timing_of(bus), drives));
  for (model::DriveModel& model : drives) model.poll_period = bus.poll;
}

}  // namespace axisgate::config
