#include "tests/axisgate_sim/simulator.hpp"

#include <algorithm>
#include <iostream>
#include <stdexcept>

namespace axisgate::simulated {

Time Simulator::now() const { return std::chrono::steady_clock::now() - begin_; }

void Simulator::add(const LineSpec& spec, const LineOptions& options, std::uint64_t seed) {
  if (lines_.contains(spec.name)) {
    throw std::invalid_argument("two lines are called '" + spec.name + "': give their links different names");
  }
  PortLine& port = lines_[spec.name];
  port.spec = spec;
  port.line = std::make_unique<SerialLine>(options, Random(seed), [&port](const ToHost& arrived) {
    if (port.pty) port.pty->write(arrived.bytes);
  });
  for (const DriveOptions& drive : spec.drives) port.line->add(drive);
  plug(port);
}

void Simulator::plug(PortLine& port) {
  port.pty = std::make_unique<Pty>(port.spec.path);
  std::cout << "ready " << port.spec.path << " -> " << port.pty->slave_name() << ' ' << describe(port.spec.drives)
            << std::endl;
}

void Simulator::unplug(PortLine& port) {
  port.line->cut();
  port.pty.reset();
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
