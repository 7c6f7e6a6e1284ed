// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "adapters/can/can_device.hpp"
#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

/// Remembers who used a name first.
template <typename Key>
class Uses {
 public:
  /// The place of the first use, where this is not the first.
  const std::string* second_use(const Key& key, const std::string& pointer) {
    const auto [entry, first] = places_.emplace(key, pointer);
    return first ? nullptr : &entry->second;
  }

 private:
  std::map<Key, std::string> places_;
};

bool printable(const std::string& name) {
  return std::ranges::none_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
}

void check_printable(const std::string& name, const std::string& pointer, ConfigFaults& faults) {
  if (!printable(name))
    faults.add(pointer, "has control characters, which would spoil log lines: write printable ones");
}

class AxisUses {
 public:
  explicit AxisUses(ConfigFaults& faults) : faults_(faults) {}
  void add(const AxisConfig& axis) {
    check_printable(axis.name, axis.pointer + "/name", faults_);
    if (axis.number == 0) return;  // the schema has named what is wrong with it
    if (const auto* first = numbers_.second_use(axis.number, axis.pointer)) {
      faults_.add(axis.pointer + "/axis",
                  fmt::format("axis {} is taken by {}: give each axis a number of its own", axis.number, *first));
    } else if (const auto* other = names_.second_use(axis.name, axis.pointer)) {
      faults_.add(axis.pointer + "/name",
                  fmt::format("\"{}\" is the name of {} too: give each axis a name of its own", axis.name, *other));
    }
  }

 private:
  ConfigFaults& faults_;
  Uses<AxisNumber> numbers_;
  Uses<std::string> names_;
};

void check_bus(const BusConfig& bus, AxisUses& axes, ConfigFaults& faults) {
  Uses<std::uint8_t> nodes;
  for (const DriveConfig& drive : bus.drives) {
    const auto* first = drive.node == 0 ? nullptr : nodes.second_use(drive.node, drive.pointer);
    if (first != nullptr && !faults.within(drive.pointer + "/node")) {
      faults.add(
          drive.pointer + "/node",
          fmt::format("node {} on this bus is {} already: give each drive a number of its own", drive.node, *first));
    }
    for (const AxisConfig& axis : drive.axes) axes.add(axis);
  }
}

}  // namespace

void check_unique(const Config& config, ConfigFaults& faults) {
  Uses<std::string> names;
  Uses<std::string> devices;
  AxisUses axes(faults);
  for (const BusConfig& bus : config.buses) {
    check_printable(bus.name, bus.pointer + "/name", faults);
    check_printable(bus.device, bus.pointer + "/device", faults);
    if (const auto* first = bus.name.empty() ? nullptr : names.second_use(bus.name, bus.pointer)) {
      faults.add(bus.pointer + "/name",
                 fmt::format("\"{}\" is the name of {} too: give each bus a name of its own", bus.name, *first));
    }
    // A serial CAN adapter is a serial port too.
    // As it is spelled: what a symbolic link points to may change while the gateway runs.
    const std::string device =
        std::filesystem::path(can::parse_can_device(bus.device).path).lexically_normal().string();
    if (const auto* first = device.empty() ? nullptr : devices.second_use(device, bus.pointer)) {
      faults.add(
          bus.pointer + "/device",
          fmt::format("{} is the device of {} already: put the drives of one line into one bus", bus.device, *first));
    }
    check_bus(bus, axes, faults);
  }
}

}  // namespace axisgate::config
