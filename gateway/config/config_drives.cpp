// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "adapters/kinco/kinco_exchange.hpp"
#include "gateway/config/adapter_names.hpp"
#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

void read_constants(const JsonNode& node, DriveConfig& drive, ConfigFaults& faults) {
  for (const JsonNode& constant : node["constants"].items()) {
    if (const auto value = constant.rational()) {
      drive.constants.emplace(constant.key(), *value);
    } else if (constant.text() == kFillIn) {
      faults.add(
          constant.pointer(),
          fmt::format("still says \"{}\": write the number that the type plate of drive or motor, or the manual, "
                      "says; where the profile does without it, the line may go",
                      kFillIn));
    } else if (!faults.within(constant.pointer())) {
      faults.add(constant.pointer(), "is no exact number: write it like 27.5 or \"10000/60\", without an exponent");
    }
  }
}

/// What is wrong with a node-ID of CANopen; empty: nothing.
std::string canopen_mistake(int node) {
  if (node < model::kOwnNode) return "";
  if (node == model::kOwnNode)
    return "127 is the gateway's own node-ID, in its heartbeat: give the drive one of 1 to 126";
  return fmt::format("{} is no CANopen node-ID: they go from 1 to 127, and 127 is the gateway's own", node);
}

std::string kinco_mistake(int node) {
  if (node <= kinco::kLastStation) return "";
  if (node == kinco::kLastStation + 1)
    return "127 is the address with which Kinco's PC tool reaches every drive: give the drive a station "
           "number of 1 to 126 (object 100B:00 or its DIP switches)";
  return fmt::format("{} is no station number of a Kinco drive: they go from 1 to 126", node);
}

std::string rtu_mistake(int node) {
  constexpr int kLastUnit = 247;  // Modbus over serial line V1.02, section 2.2
  if (node <= kLastUnit) return "";
  return fmt::format("{} is no unit id that a drive may have: they go from 1 to 247", node);
}

/// Of a bus without one nothing is told that depends on it.
bool adapter_known(const BusConfig& bus, const ConfigFaults& faults) {
  return !bus.adapter.empty() && !faults.within(bus.pointer + "/adapter");
}

std::uint8_t read_node(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  if (!node.has("node")) {
    if (bus.adapter == adapter::kKeyaRs232) return 1;  // its frames carry none
    if (adapter_known(bus, faults)) faults.add(node.pointer(), "key \"node\" is missing");
    return 0;
  }
  const std::int64_t number = node.integer("node").value_or(0);
  const auto in_use = static_cast<std::uint8_t>(number);
  if (faults.within(node.pointer("node"))) return in_use;
  std::string mistake;
  if (bus.adapter == adapter::kCanopen) mistake = canopen_mistake(in_use);
  if (bus.adapter == adapter::kKincoSerial) mistake = kinco_mistake(in_use);
  if (bus.adapter == adapter::kModbusRtu) mistake = rtu_mistake(in_use);
  if (!mistake.empty()) faults.add(node.pointer("node"), mistake);
  return in_use;
}

std::array<std::optional<std::uint32_t>, 4> read_identity(const JsonNode& node) {
  constexpr std::array<std::string_view, 4> kNumbers{"vendor", "product", "revision", "serial"};
  std::array<std::optional<std::uint32_t>, 4> out{};
  const JsonNode identity = node["identity"];
  for (std::size_t i = 0; i < kNumbers.size(); ++i)
    if (const auto number = identity.integer(kNumbers[i])) out[i] = static_cast<std::uint32_t>(*number);
  return out;
}

}  // namespace

DriveConfig read_drive(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults) {
  DriveConfig drive;
  drive.pointer = node.pointer();
  drive.profile = node.text("profile");
  drive.node = read_node(node, bus, faults);
  read_constants(node, drive, faults);
  drive.identity = read_identity(node);
  // Accepting it unchecked would promise a safety that is not there.
  if (node.has("identity") && bus.adapter != adapter::kCanopen && adapter_known(bus, faults)) {
    faults.add(node.pointer("identity"),
               fmt::format("{} has no object 1018h to compare with: remove the key", bus.adapter));
  }
  for (const JsonNode& axis : node["axes"].items()) drive.axes.push_back(read_axis(axis, faults));
  return drive;
}

}  // namespace axisgate::config
