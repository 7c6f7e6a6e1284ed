// SPDX-License-Identifier: Apache-2.0
// What belongs to a CAN bus: its device and rate, and what follows from its drives once their profiles are known.
#include <fmt/format.h>

#include <algorithm>

#include "adapters/can/can_device.hpp"
#include "adapters/can/lawicel.hpp"
#include "gateway/config/adapter_names.hpp"
#include "gateway/config/bus_budget.hpp"
#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

using std::chrono::milliseconds;

/// CiA 301 section 6.2, table of bit rates; 100 kbit/s of older editions among them.
constexpr std::array kCiaRates{10000U, 20000U, 50000U, 100000U, 125000U, 250000U, 500000U, 800000U, 1000000U};
constexpr std::uint32_t kLongestInhibit = 0xFFFF;

void refuse_serial_keys(const JsonNode& node, ConfigFaults& faults) {
  if (node.has("baud")) faults.add(node.pointer("baud"), "a CAN bus has no baud rate: write \"bitrate\" instead");
  for (const std::string_view key : {"parity", "rs485", "cascade"})
    if (node.has(key)) faults.add(node.pointer(key), "belongs to serial ports, and this is a CAN bus: remove the key");
}

void check_bitrate(const JsonNode& node, const BusConfig& bus, bool lawicel, ConfigFaults& faults) {
  const std::string pointer = node.pointer("bitrate");
  if (faults.within(pointer) || bus.adapter != adapter::kCanopen) return;  // Keya's rates are its own
  if (lawicel && !bus.bitrate_given) {
    faults.add(pointer, "is missing: a serial CAN adapter must be told the bit rate of the drives, such as 500000");
  } else if (lawicel && !can::lawicel_rate(bus.bitrate)) {
    faults.add(pointer, can::can_device_mistake(bus.device, bus.bitrate));
  } else if (std::ranges::find(kCiaRates, bus.bitrate) == kCiaRates.end()) {
    faults.warn(pointer, fmt::format("{} is not among the bit rates of CiA 301 (10000, 20000, 50000, 125000, 250000, "
                                     "500000, 800000, 1000000)",
                                     bus.bitrate));
  }
}

/// TPDOs win the line against every SDO request, stops among them: they must not fill it, however much moves at once.
void stretch_tpdos(const BusConfig& bus, std::vector<model::DriveModel>& drives) {
  const int load = plan_bus(timing_of(bus), drives).load_unsolicited;
  if (load <= kUnsolicitedPermille) return;
  const auto factor = static_cast<std::uint32_t>((load + kUnsolicitedPermille - 1) / kUnsolicitedPermille);
  const auto longer = [&](std::uint16_t time) {
    return static_cast<std::uint16_t>(std::min(time * factor, kLongestInhibit));
  };
  for (model::DriveModel& model : drives) {
    for (model::TpdoProperties& tpdo : model.canopen.tpdos) {
      if (tpdo.inhibit && *tpdo.inhibit != 0) {
        const std::uint16_t inhibit = longer(*tpdo.inhibit);
        tpdo.inhibit_time = tpdo.inhibit_time / *tpdo.inhibit * inhibit;
        tpdo.inhibit = inhibit;
      }
      if (tpdo.event_ms) tpdo.event_ms = longer(*tpdo.event_ms);
    }
  }
}

/// What comes by TPDO is read now and then all the same: with many drives on a slow line, not so often.
void stretch_confirming(const BusConfig& bus, std::vector<model::DriveModel>& drives) {
  const int load = plan_bus(timing_of(bus), drives).load_confirmed();
  if (load <= kConfirmPermille) return;
  for (model::DriveModel& model : drives) model.canopen.confirm *= (load + kConfirmPermille - 1) / kConfirmPermille;
}

}  // namespace

void check_can_bus(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  refuse_serial_keys(node, faults);
  const can::CanDevice device = can::parse_can_device(bus.device);
  if (!faults.within(node.pointer("device")) && node.has("device")) {
    const std::string mistake = can::can_device_mistake(bus.device, BusConfig{}.bitrate);
    if (!mistake.empty()) faults.add(node.pointer("device"), mistake);
  }
  check_bitrate(node, bus, device.lawicel, faults);
}

void settle_can_buses(Config& config, std::vector<std::vector<model::DriveModel>>& models, ConfigFaults& faults) {
  for (std::size_t i = 0; i < config.buses.size(); ++i) {
    BusConfig& bus = config.buses[i];
    if (bus.adapter != adapter::kCanopen) continue;
    settle_timeout(bus, models[i], timing_of(bus).on_wire,
                   fmt::format("an SDO request and its answer take at {} bit/s", bus.bitrate), faults);
    stretch_tpdos(bus, models[i]);
    stretch_confirming(bus, models[i]);
    settle_poll(bus, models[i]);
  }
}

}  // namespace axisgate::config
