#include "gateway/app/serial_wires.hpp"

#include "adapters/kinco/kinco_wire.hpp"
#include "adapters/serial/serial_link.hpp"

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

}  // namespace

MakeWire serial_wires(boost::asio::io_context& io, Runtime& runtime, const Log& log) {
  // The loader has refused every adapter but this one.
  return [&io, &runtime, &log](const BusConfig& bus) -> std::unique_ptr<bus::Wire> {
    auto link = std::make_unique<serial::SerialLink>(bus.name, settings_of(bus), io, runtime, log);
    return std::make_unique<kinco::KincoWire>(bus.name, std::move(link), runtime, log);
  };
}

}  // namespace axisgate::app
