// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/read_only_drive.hpp"

#include <utility>

#include "adapters/can/link/make_can_link.hpp"
#include "adapters/canopen/canopen_wire.hpp"
#include "gateway/compose/can_wires.hpp"
#include "gateway/process/device_wires.hpp"

namespace axisgate::commands {

model::DriveModel only_read(model::DriveModel model) {
  model.setup.clear();
  model.factory_writes.clear();
  model.loss_objects.clear();
  model::CanopenProperties& node = model.canopen;
  node.tpdos.clear();
  node.unused_tpdos.clear();
  node.heartbeat = node.guard_time = node.own_heartbeat = node.sync = Duration{};
  return model;
}

compose::MakeWire guarded_wires(boost::asio::io_context& io, Runtime& runtime, const Log& log, const LinkGuard& guard) {
  const compose::MakeWire make = process::device_wires(io, runtime, log);
  return [make, &io, &runtime, &log, &guard](const config::BusConfig& bus,
                                             const std::vector<model::DriveModel>& drives) {
    if (!model::is_canopen(drives[0])) return make(bus, drives);
    auto link =
        std::make_unique<GuardedLink>(can::make_can_link(bus.device, bus.bitrate, bus.name, io, runtime, log), guard);
    return canopen::make_canopen_wire(compose::canopen_settings(bus, drives), std::move(link), runtime, log);
  };
}

}  // namespace axisgate::commands
