// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/simulator.hpp"

#include <algorithm>
#include <iostream>
#include <stdexcept>

#include "tests/axisgate_sim/can_socket.hpp"
#include "tests/axisgate_sim/pty.hpp"
#include "tests/simulated/lawicel_line.hpp"
#include "tests/simulated/socket_can_line.hpp"

namespace axisgate::simulated {

Time Simulator::now() const { return std::chrono::steady_clock::now() - begin_; }

void Simulator::add(const LineSpec& spec, const LineTimings& timings, std::uint64_t seed) {
  if (lines_.contains(spec.name)) {
    throw std::invalid_argument("two lines are called '" + spec.name + "': give their links different names");
  }
  PortLine& port = lines_[spec.name];
  port.spec = spec;
  const auto to_port = [&port](const ToHost& arrived) {
    if (port.port) port.port->write(arrived.bytes);
  };
  if (spec.is_can()) {
    std::unique_ptr<CanPortLine> line;
    if (spec.kind == LineKind::can) {
      line = std::make_unique<SocketCanLine>(timings.can, Random(seed), to_port);
    } else {
      line = std::make_unique<LawicelLine>(timings.can, LawicelOptions{}, Random(seed), to_port);
    }
    for (const CanDriveOptions& drive : spec.can_drives) line->bus().add(drive);
    port.can = line.get();
    port.line = std::move(line);
  } else if (spec.kind == LineKind::rtu) {
    auto line = std::make_unique<RtuLine>(timings.rtu, Random(seed), to_port);
    for (const RtuDriveOptions& drive : spec.rtu_drives) line->add(drive);
    port.rtu = line.get();
    port.line = std::move(line);
  } else if (spec.is_keya_serial()) {
    KeyaLineOptions options = timings.keya;
    options.wiring = spec.kind == LineKind::keya_rs232 ? KeyaWiring::rs232 : KeyaWiring::rs485;
    auto line = std::make_unique<KeyaLine>(options, Random(seed), to_port);
    for (const KeyaOptions& drive : spec.keya_drives) line->add(drive);
    port.keya = line.get();
    port.line = std::move(line);
  } else {
    auto line = std::make_unique<SerialLine>(timings.serial, Random(seed), to_port);
    for (const DriveOptions& drive : spec.drives) line->add(drive);
    port.serial = line.get();
    port.line = std::move(line);
  }
  plug(port);
}

void Simulator::plug(PortLine& port) {
  if (port.spec.kind == LineKind::can) {
    port.port = std::make_unique<CanSocket>(port.spec.path);
  } else {
    port.port = std::make_unique<Pty>(port.spec.path, terminals_);
  }
  std::cout << "ready " << port.spec.path << " -> " << port.port->far_end() << ' ' << port.spec.describe() << std::endl;
}

void Simulator::unplug(PortLine& port) {
  port.line->cut();
  port.port.reset();
}

void Simulator::set_duplicate(PortLine& port, std::size_t position, bool there) {
  CanLine& bus = port.can->bus();
  const auto found = port.duplicates.find(position);
  if (found != port.duplicates.end()) {
    bus.connect(found->second, there);
  } else if (there) {
    port.duplicates[position] = bus.add_duplicate(position);
  }
}

PortLine* Simulator::find(const std::string& name) {
  const auto found = lines_.find(name);
  return found == lines_.end() ? nullptr : &found->second;
}

std::optional<Time> Simulator::advance() {
  std::optional<Time> next;
  for (auto& [name, port] : lines_) {
    port.line->advance(now());
    const auto event = port.line->next_event();
    if (event) next = next ? std::min(*next, *event) : *event;
  }
  return next;
}

}  // namespace axisgate::simulated
