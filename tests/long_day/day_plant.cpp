// SPDX-License-Identifier: Apache-2.0
#include "tests/long_day/day_plant.hpp"

namespace axisgate::test::long_day {
namespace {

using namespace std::chrono_literals;
using simulated::CanDriveOptions;
using simulated::KincoType;
using simulated::RtuDriveOptions;

simulated::DriveOptions kinco(KincoType type, std::uint8_t station) {
  simulated::DriveOptions options;
  options.type = type;
  options.station = station;
  return options;
}

simulated::KincoRtuDrive kinco_rtu(KincoType type, std::uint8_t station) { return {kinco(type, station), {}}; }
simulated::KincoCanDrive kinco_can(KincoType type, std::uint8_t station) { return {kinco(type, station), {}}; }

simulated::Id286proOptions id286pro(std::uint8_t unit) {
  simulated::Id286proOptions options;
  options.unit = unit;
  return options;
}

simulated::LeadshineOptions leadshine(std::uint8_t node) {
  simulated::LeadshineOptions options;
  options.node = node;
  return options;
}

simulated::KeyaOptions keya(std::uint8_t node) {
  simulated::KeyaOptions options;
  options.node = node;
  return options;
}

/// Kinco's own protocol, two drives on RS485.
GatewayStage::Line kinco_rs485(AxisNumber first) {
  GatewayStage::Line line = line_of(KincoType::md, first);
  line.options.wiring = simulated::Wiring::rs485;
  line.drives.push_back(line_of(KincoType::md, static_cast<AxisNumber>(first + 1)).drives.front());
  line.drives.back().options.station = 2;
  return line;
}

}  // namespace

std::vector<GatewayStage::Line> plant() {
  using enum KincoType;
  constexpr std::uint32_t kFastRtu = 38'400;
  const auto own = [](std::uint8_t node) { return CanDriveOptions(simulated::KeyaCanDrive{keya(node)}); };
  const auto open = [](std::uint8_t node) { return CanDriveOptions(simulated::KeyaCanopenDrive{keya(node)}); };
  std::vector<GatewayStage::Line> lines{
      kinco_rs485(1),
      line_of(jd, 3),
      rtu_line_of({kinco_rtu(jd, 1), kinco_rtu(md, 2)}, 4),
      rtu_line_of({id286pro(1), id286pro(2), id286pro(3)}, 6),
      can_line_of({kinco_can(jd, 1), kinco_can(md, 2), leadshine(3), leadshine(4), open(5)}, 9),
      can_line_of({leadshine(1), leadshine(2), leadshine(3), kinco_can(jd, 4), kinco_can(md, 5), leadshine(6)}, 15),
      can_line_of({own(1), own(2)}, 21),
      keya_line_of(simulated::KeyaWiring::rs232, {keya(1)}, 25),
      keya_line_of(simulated::KeyaWiring::rs485, {keya(1)}, 27),
      keya_line_of(simulated::KeyaWiring::rs232, {keya(1)}, 29),
  };
  for (GatewayStage::Line& line : lines) {
    line.lease = LeaseRules{};
    line.poll = {100ms, 500ms, 5s};
    if (line.rtu_drives.size() > 1) line.rtu_options.baud = kFastRtu;
  }
  return lines;
}

std::size_t drives_on(const GatewayStage::Line& line) {
  return line.drives.size() + line.rtu_drives.size() + line.can_drives.size() + line.keya_drives.size();
}

}  // namespace axisgate::test::long_day
