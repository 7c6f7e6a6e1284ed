// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/device_wires.hpp"

#include "adapters/can/link/make_can_link.hpp"
#include "adapters/canopen/canopen_wire.hpp"
#include "adapters/keya/keya_can_wire.hpp"
#include "adapters/keya/keya_serial_wire.hpp"
#include "adapters/kinco/kinco_wire.hpp"
#include "adapters/modbus_rtu/link/libmodbus_link.hpp"
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "adapters/serial/serial_link.hpp"
#include "gateway/compose/can_wires.hpp"
#include "gateway/config/adapter_names.hpp"

namespace axisgate::process {
namespace {

serial::SerialSettings settings_of(const config::BusConfig& bus) {
  serial::SerialSettings settings;
  settings.device = bus.device;
  settings.baud = bus.baud;
  if (bus.parity == "even") settings.parity = serial::Parity::even;
  if (bus.parity == "odd") settings.parity = serial::Parity::odd;
  settings.rs485 = bus.rs485 == "auto" ? serial::Rs485::automatic : serial::Rs485::off;
  return settings;
}

std::vector<modbus_rtu::RtuNode> rtu_nodes(const std::vector<model::DriveModel>& drives) {
  std::vector<modbus_rtu::RtuNode> nodes;
  for (const model::DriveModel& drive : drives)
    nodes.push_back({.node = drive.node,
                     .low_word_first = drive.rtu.low_word_first,
                     .error_functions = drive.rtu.error_functions,
                     .worst_reply = drive.resync.worst_reply,
                     .broadcast = drive.rtu.broadcast});
  return nodes;
}

keya::KeyaCanSettings keya_can_settings(const config::BusConfig& bus, const std::vector<model::DriveModel>& drives) {
  keya::KeyaCanSettings settings;
  settings.name = bus.name;
  settings.timeout = bus.timeout;
  for (const model::DriveModel& drive : drives) settings.nodes.push_back(drive.node);
  return settings;
}

keya::KeyaSerialSettings keya_serial_settings(const config::BusConfig& bus) {
  const bool rs232 = bus.adapter == config::adapter::kKeyaRs232;
  return {bus.name, rs232 ? keya::KeyaLine::rs232 : keya::KeyaLine::rs485, bus.baud};
}

}  // namespace

compose::MakeWire device_wires(boost::asio::io_context& io, Runtime& runtime, const Log& log) {
  return [&io, &runtime, &log](const config::BusConfig& bus,
                               const std::vector<model::DriveModel>& drives) -> std::unique_ptr<bus::Wire> {
    if (bus.adapter == config::adapter::kModbusRtu) {
      auto link = std::make_unique<modbus_rtu::LibmodbusLink>(bus.name, settings_of(bus), io, runtime, log);
      const modbus_rtu::LineSpeed speed{bus.baud, bus.parity == "none" ? 0 : 1};
      return std::make_unique<modbus_rtu::RtuWire>(bus.name, rtu_nodes(drives), speed, std::move(link), runtime, log);
    }
    if (config::adapter::on_can(bus.adapter)) {
      auto link = can::make_can_link(bus.device, bus.bitrate, bus.name, io, runtime, log);
      if (bus.adapter == config::adapter::kKeyaCan)
        return keya::make_keya_can_wire(keya_can_settings(bus, drives), std::move(link), runtime, log);
      return canopen::make_canopen_wire(compose::canopen_settings(bus, drives), std::move(link), runtime, log);
    }
    auto link = std::make_unique<serial::SerialLink>(bus.name, settings_of(bus), io, runtime, log);
    if (config::adapter::keya_serial(bus.adapter))
      return keya::make_keya_serial_wire(keya_serial_settings(bus), std::move(link), runtime, log);
    // The loader has refused every other adapter.
    return std::make_unique<kinco::KincoWire>(bus.name, std::move(link), runtime, log);
  };
}

}  // namespace axisgate::process
