#include "gateway/app/device_wires.hpp"

#include "adapters/can/make_can_link.hpp"
#include "adapters/canopen/canopen_wire.hpp"
#include "adapters/kinco/kinco_wire.hpp"
#include "adapters/modbus_rtu/libmodbus_link.hpp"
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "adapters/serial/serial_link.hpp"
#include "gateway/app/can_wires.hpp"

namespace axisgate::app {
namespace {

serial::SerialSettings settings_of(const BusConfig& bus) {
  serial::SerialSettings settings;
  settings.device = bus.device;
  settings.baud = bus.baud;
  if (bus.parity == "even") settings.parity = serial::Parity::even;
  if (bus.parity == "odd") settings.parity = serial::Parity::odd;
  settings.rs485 = bus.rs485 == "auto" ? serial::Rs485::automatic : serial::Rs485::off;
  return settings;
}

std::vector<modbus_rtu::RtuNode> rtu_nodes(const std::vector<drive::DriveModel>& drives) {
  std::vector<modbus_rtu::RtuNode> nodes;
  for (const drive::DriveModel& drive : drives)
    nodes.push_back({drive.node, drive.rtu.low_word_first, drive.rtu.error_functions, drive.rtu.broadcast});
  return nodes;
}

}  // namespace

MakeWire device_wires(boost::asio::io_context& io, Runtime& runtime, const Log& log) {
  return [&io, &runtime, &log](const BusConfig& bus,
                               const std::vector<drive::DriveModel>& drives) -> std::unique_ptr<bus::Wire> {
    if (bus.adapter == "modbus-rtu") {
      auto link = std::make_unique<modbus_rtu::LibmodbusLink>(bus.name, settings_of(bus), io, runtime, log);
      const modbus_rtu::LineSpeed speed{bus.baud, bus.parity == "none" ? 0 : 1};
      return std::make_unique<modbus_rtu::RtuWire>(bus.name, rtu_nodes(drives), speed, std::move(link), runtime, log);
    }
    if (bus.adapter == "canopen") {
      auto link = can::make_can_link(bus.device, bus.bitrate, bus.name, io, runtime, log);
      return canopen::make_canopen_wire(canopen_settings(bus, drives), std::move(link), runtime, log);
    }
    // The loader has refused every other adapter.
    auto link = std::make_unique<serial::SerialLink>(bus.name, settings_of(bus), io, runtime, log);
    return std::make_unique<kinco::KincoWire>(bus.name, std::move(link), runtime, log);
  };
}

}  // namespace axisgate::app
