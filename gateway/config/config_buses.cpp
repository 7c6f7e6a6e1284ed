// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "adapters/kinco/kinco_exchange.hpp"
#include "adapters/modbus_rtu/rtu_timing.hpp"
#include "gateway/config/adapter_names.hpp"
#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

using std::chrono::milliseconds;

/// As the drives leave their factories (JD, MD, iD286pro).
constexpr std::uint32_t kRtuBaud = 19200;
/// What a serial port of this system can be set to.
constexpr std::array kPortRates{1200,   2400,   4800,   9600,   19200,  38400,  57600,
                                115200, 230400, 460800, 500000, 921600, 1000000};
/// Of these, what the sheets of the Kinco drives give codes for (RS232 and RS485 together).
constexpr std::array kKincoRates{9600, 19200, 38400, 115200};

/// For each drive on the line. One exchange takes 5 ms at 38400 baud before the drive has thought about it: the periods
/// of a faster bus (20, 100, 1000 ms) would only queue up. These fill about 70 % of the line, however many drives share
/// it.
constexpr std::array<Duration, 3> kKincoPoll{milliseconds(50), milliseconds(250), milliseconds(2500)};
constexpr Duration kKincoTimeout = milliseconds(100);
constexpr Duration kSerialSettle = milliseconds(10);

std::array<Duration, 3> default_poll(std::size_t drives) {
  std::array<Duration, 3> periods = kKincoPoll;
  for (Duration& period : periods) period *= static_cast<int>(std::max<std::size_t>(drives, 1));
  return periods;
}

void read_poll(const JsonNode& node, BusConfig& bus, ConfigFaults& faults) {
  const JsonNode poll = node["poll"];
  constexpr std::array<std::string_view, 3> kClasses{"fast", "normal", "slow"};
  for (std::size_t i = 0; i < kClasses.size(); ++i) bus.poll[i] = poll.milliseconds(kClasses[i], bus.poll[i]);
  for (std::size_t i = 1; i < kClasses.size(); ++i) {
    if (bus.poll[i] >= bus.poll[i - 1] || faults.within(poll.pointer())) continue;
    faults.add(poll.pointer(kClasses[i]),
               fmt::format("{} ms is shorter than {} ms of class {}: give the slower class the longer period",
                           bus.poll[i] / milliseconds(1), bus.poll[i - 1] / milliseconds(1), kClasses[i - 1]));
  }
}

template <typename Rates>
bool has(const Rates& rates, std::uint32_t baud) {
  return std::ranges::find(rates, static_cast<int>(baud)) != rates.end();
}

void check_serial_line(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  if (!faults.within(node.pointer("baud")) && !has(kPortRates, bus.baud))
    faults.add(node.pointer("baud"),
               fmt::format("{} is no rate of a serial port: write 9600, 19200, 38400 or 115200", bus.baud));
  if (node.has("bitrate"))
    faults.add(node.pointer("bitrate"), "a serial port has no CAN bit rate: write \"baud\" instead");
  if (bus.device.starts_with("slcan:"))
    faults.add(node.pointer("device"),
               fmt::format("slcan: names a CAN adapter, and {} needs a serial port: write its path", bus.adapter));
}

void check_kinco_line(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  if (has(kPortRates, bus.baud) && !has(kKincoRates, bus.baud)) {
    faults.warn(node.pointer("baud"),
                fmt::format("{} is not among the rates of Kinco drives (9600, 19200, 38400, 115200)", bus.baud));
  }
  if (bus.parity == "even" || bus.parity == "odd") {
    faults.add(node.pointer("parity"), "Kinco drives speak without parity: write \"none\" or remove the key");
  }
}

void check_rtu_line(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  if (bus.cascade)
    faults.add(node.pointer("cascade"), "only Kinco's RS232 protocol has drives in a chain: remove the key");
  const Duration gap = modbus_rtu::gap_time(std::max(bus.baud, 1U));
  if (bus.min_gap < gap && node.has("min_gap_ms"))
    faults.add(node.pointer("min_gap_ms"),
               fmt::format("Modbus RTU ends a frame by {:.2f} ms of silence at {} baud: write at least that, or remove "
                           "the key",
                           static_cast<double>(gap.count()) / 1e6, bus.baud));
}

void check_timeout(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  const Duration wire = kinco::wire_time(std::max(bus.baud, 1U), bus.cascade);
  if (bus.timeout > wire || faults.within(node.pointer("timeout_ms")) || faults.within(node.pointer("baud"))) return;
  faults.add(node.pointer("timeout_ms"),
             fmt::format(
                 "{} ms is less than an exchange takes on the wire at {} baud ({:.1f} ms), every answer would come too "
                 "late: write at least {}",
                 bus.timeout / milliseconds(1), bus.baud, static_cast<double>(wire.count()) / 1e6,
                 wire / milliseconds(1) + 20));
}

/// What a bus of this adapter has where its configuration says nothing.
BusConfig default_bus(std::string_view name, std::size_t drives) {
  BusConfig bus;
  bus.adapter = name;
  bus.settle = kSerialSettle;
  bus.poll_given = false;
  if (name == adapter::kKincoSerial) {
    bus.timeout = kKincoTimeout;
    bus.poll = default_poll(drives);
    bus.poll_given = true;
  }
  if (name == adapter::kModbusRtu) bus.baud = kRtuBaud;
  if (adapter::keya(name)) default_keya_bus(bus);
  if (adapter::on_can(name)) bus.settle = {};  // two talkers cannot spoil each other's frames on CAN
  return bus;
}

/// The silence between two exchanges where none is given: what parts two frames on this line.
Duration default_gap(const BusConfig& bus) {
  const std::uint32_t baud = std::max(bus.baud, 1U);
  if (bus.adapter == adapter::kModbusRtu) return modbus_rtu::gap_time(baud);
  return adapter::keya_serial(bus.adapter) ? keya_gap(baud) : Duration{};
}

void check_bus(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  const bool kinco = bus.adapter == adapter::kKincoSerial;
  const bool rtu = bus.adapter == adapter::kModbusRtu;
  if (kinco || rtu || adapter::keya_serial(bus.adapter)) check_serial_line(node, bus, faults);
  if (kinco) {
    check_kinco_line(node, bus, faults);
    check_timeout(node, bus, faults);
  }
  if (rtu) check_rtu_line(node, bus, faults);
  if (adapter::on_can(bus.adapter)) check_can_bus(node, bus, faults);
  if (adapter::keya(bus.adapter)) check_keya_bus(node, bus, faults);
}

BusConfig read_bus(const JsonNode& node, ConfigFaults& faults) {
  const auto drives = node["drives"].items();
  BusConfig bus = default_bus(node.text("adapter"), drives.size());
  bus.pointer = node.pointer();
  bus.name = node.text("name");
  bus.device = node.text("device");
  bus.baud = static_cast<std::uint32_t>(node.integer("baud").value_or(bus.baud));
  bus.bitrate = static_cast<std::uint32_t>(node.integer("bitrate").value_or(bus.bitrate));
  bus.bitrate_given = node.has("bitrate");
  bus.parity = node.string("parity").value_or(bus.parity);
  bus.rs485 = node.string("rs485").value_or(bus.rs485);
  bus.cascade = node.flag("cascade", false);
  bus.decode = node.flag("decode", false);
  bus.timeout = node.milliseconds("timeout_ms", bus.timeout);
  bus.min_gap = node.milliseconds("min_gap_ms", default_gap(bus));
  bus.settle = node.milliseconds("settle_ms", bus.settle);
  bus.poll_given = bus.poll_given || node.has("poll");
  read_poll(node, bus, faults);
  check_bus(node, bus, faults);
  for (const JsonNode& drive : drives) bus.drives.push_back(read_drive(drive, bus, faults));
  return bus;
}

}  // namespace

std::vector<BusConfig> read_buses(const JsonNode& root, ConfigFaults& faults) {
  std::vector<BusConfig> buses;
  for (const JsonNode& node : root["buses"].items()) buses.push_back(read_bus(node, faults));
  return buses;
}

}  // namespace axisgate::config
