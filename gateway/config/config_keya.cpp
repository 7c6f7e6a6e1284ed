// SPDX-License-Identifier: Apache-2.0
// What belongs to a bus that speaks one of Keya's own protocols: its rates, and what follows from its drives once their
// profiles are known.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gateway/config/adapter_names.hpp"
#include "gateway/config/bus_budget.hpp"
#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

/// KYDAS4860-2E manual V2.2: RS232 has one rate, parameter 0021 gives those of RS485 and CAN.
constexpr std::uint32_t kFactoryBaud = 115200;
constexpr std::uint32_t kFactoryBitrate = 250000;
constexpr std::array<std::uint32_t, 3> kRs485Rates{9600, 19200, 115200};
constexpr std::array<std::uint32_t, 3> kCanRates{125000, 250000, 500000};
/// Frames have neither a length nor an end: silence parts them. How much, the manual does not say.
constexpr int kGapCharacters = 4;

bool among(const std::array<std::uint32_t, 3>& rates, std::uint32_t rate) {
  return std::ranges::find(rates, rate) != rates.end();
}

void check_rate(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  if (faults.within(node.pointer("baud")) || faults.within(node.pointer("bitrate"))) return;
  if (bus.adapter == adapter::kKeyaCan && !among(kCanRates, bus.bitrate))
    faults.add(
        node.pointer("bitrate"),
        fmt::format("{} is no bit rate of this protocol: write 125000, 250000 or 500000, as parameter 0021 of the "
                    "drive says",
                    bus.bitrate));
  if (bus.adapter == adapter::kKeyaRs232 && bus.baud != kFactoryBaud)
    faults.add(node.pointer("baud"),
               fmt::format("the drive speaks RS232 at {} baud alone: write that, or remove the key", kFactoryBaud));
  if (bus.adapter == adapter::kKeyaRs485 && !among(kRs485Rates, bus.baud))
    faults.add(
        node.pointer("baud"),
        fmt::format("{} is no rate of this protocol: write 9600, 19200 or 115200, as parameter 0021 of the drive "
                    "says",
                    bus.baud));
}

}  // namespace

void default_keya_bus(BusConfig& bus) {
  bus.baud = kFactoryBaud;
  bus.bitrate = kFactoryBitrate;
  if (bus.adapter == adapter::kKeyaRs232) bus.rs485 = "off";  // RS232 has no direction to control
}

Duration keya_gap(std::uint32_t baud) { return characters_time(baud, kGapCharacters); }

void check_keya_bus(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  check_rate(node, bus, faults);
  if (bus.adapter == adapter::kKeyaCan) return;
  if (bus.parity == "even" || bus.parity == "odd")
    faults.add(node.pointer("parity"), "Keya drives speak without parity: write \"none\" or remove the key");
  if (bus.cascade)
    faults.add(node.pointer("cascade"), "only Kinco's RS232 protocol has drives in a chain: remove the key");
  if (bus.adapter == adapter::kKeyaRs232 && node["drives"].items().size() > 1)
    faults.add(
        node.pointer("drives"),
        "RS232 joins the gateway and one drive, whose frames carry no address: give each other drive a bus of its "
        "own");
}

void settle_keya_buses(Config& config, std::vector<std::vector<model::DriveModel>>& models, ConfigFaults& faults) {
  for (std::size_t i = 0; i < config.buses.size(); ++i) {
    BusConfig& bus = config.buses[i];
    if (!adapter::keya(bus.adapter)) continue;
    const bool can = bus.adapter == adapter::kKeyaCan;
    settle_timeout(bus, models[i], timing_of(bus).on_wire,
                   fmt::format("a query and its answer take on the wire at {}",
                               can ? fmt::format("{} bit/s", bus.bitrate) : fmt::format("{} baud", bus.baud)),
                   faults);
    settle_poll(bus, models[i]);
  }
}

}  // namespace axisgate::config
