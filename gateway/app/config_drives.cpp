#include <fmt/format.h>

#include "adapters/kinco/kinco_exchange.hpp"
#include "gateway/app/config_sections.hpp"

namespace axisgate::app {
namespace {

void read_constants(const ConfigNode& node, DriveConfig& drive, ConfigFaults& faults) {
  for (const ConfigNode& constant : node.items("constants")) {
    if (const auto value = constant.rational()) {
      drive.constants.emplace(constant.key(), *value);
    } else if (!faults.within(constant.pointer())) {
      faults.add(constant.pointer(), "is no decimal number: write it like 27.5 or \"27.5\", without an exponent");
    }
  }
}

void check_can_node(const ConfigNode& node, const DriveConfig& drive, ConfigFaults& faults) {
  if (drive.node < drive::kOwnNode) return;
  if (drive.node == drive::kOwnNode) {
    faults.add(node.pointer("node"),
               "127 is the gateway's own node-ID, in its heartbeat: give the drive one of 1 to 126");
  } else {
    faults.add(
        node.pointer("node"),
        fmt::format("{} is no CANopen node-ID: they go from 1 to 127, and 127 is the gateway's own", drive.node));
  }
}

void check_node(const ConfigNode& node, const DriveConfig& drive, const BusConfig& bus, ConfigFaults& faults) {
  if (bus.adapter == "canopen" && !faults.within(node.pointer("node"))) return check_can_node(node, drive, faults);
  if (bus.adapter != "kinco-serial" || drive.node <= kinco::kLastStation || faults.within(node.pointer("node"))) return;
  if (drive.node == kinco::kLastStation + 1) {
    faults.add(node.pointer("node"),
               "127 is the address with which Kinco's PC tool reaches every drive: give the drive a station "
               "number of 1 to 126 (object 100B:00 or its DIP switches)");
  } else {
    faults.add(node.pointer("node"),
               fmt::format("{} is no station number of a Kinco drive: they go from 1 to 126", drive.node));
  }
}

std::array<std::optional<std::uint32_t>, 4> read_identity(const ConfigNode& node) {
  constexpr std::array<std::string_view, 4> kNumbers{"vendor", "product", "revision", "serial"};
  std::array<std::optional<std::uint32_t>, 4> out{};
  const auto identity = node.child("identity");
  for (std::size_t i = 0; identity && i < kNumbers.size(); ++i)
    if (const auto number = identity->integer(kNumbers[i])) out[i] = static_cast<std::uint32_t>(*number);
  return out;
}

}  // namespace

DriveConfig read_drive(const ConfigNode& node, const BusConfig& bus, ConfigFaults& faults) {
  DriveConfig drive;
  drive.pointer = node.pointer();
  drive.profile = node.string("profile").value_or("");
  drive.node = static_cast<std::uint8_t>(node.integer("node").value_or(0));
  check_node(node, drive, bus, faults);
  read_constants(node, drive, faults);
  drive.identity = read_identity(node);
  // Accepting it unchecked would promise a safety that is not there.
  if (node.has("identity") && (bus.adapter == "kinco-serial" || bus.adapter == "modbus-rtu")) {
    faults.add(node.pointer("identity"),
               fmt::format("{} has no object 1018h to compare with: remove the key", bus.adapter));
  }
  for (const ConfigNode& axis : node.items("axes")) drive.axes.push_back(read_axis(axis, faults));
  return drive;
}

}  // namespace axisgate::app
