// SPDX-License-Identifier: Apache-2.0
// The running simulator: its lines with their ports, and the time that has passed since it began.
// Promises that a line keeps its drives and their faults while it is unplugged; only the port is gone.
// Never blocks and never waits: the poll loop does.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/axisgate_sim/line_spec.hpp"
#include "tests/axisgate_sim/port.hpp"
#include "tests/simulated/can_port_line.hpp"
#include "tests/simulated/rtu_line.hpp"
#include "tests/simulated/serial_line.hpp"

namespace axisgate::simulated {

struct PortLine {
  LineSpec spec;
  std::unique_ptr<DriveLine> line;
  SerialLine* serial = nullptr;  // the same line, as what it is
  RtuLine* rtu = nullptr;
  CanPortLine* can = nullptr;
  KeyaLine* keya = nullptr;
  std::map<std::size_t, std::size_t> duplicates{};  // where the second drive with the number of the first stands
  std::unique_ptr<Port> port;                       // none while unplugged
};

struct LineTimings {
  LineOptions serial;
  RtuLineOptions rtu;
  CanLineOptions can;
  KeyaLineOptions keya{};
};

class Simulator {
 public:
  // `terminals`: where pseudo-terminals are made (pty.hpp).
  explicit Simulator(std::string terminals = {}) : terminals_(std::move(terminals)) {}

  Time now() const;

  // Throws std::invalid_argument or std::runtime_error.
  void add(const LineSpec& spec, const LineTimings& timings, std::uint64_t seed);
  void plug(PortLine& line);  // prints the ready line
  // A second drive under the number of this one, or none any more.
  void set_duplicate(PortLine& line, std::size_t position, bool there);
  void unplug(PortLine& line);
  PortLine* find(const std::string& name);
  std::map<std::string, PortLine>& lines() { return lines_; }

  // Moves all lines on to now, and tells when the next of them has something to do.
  std::optional<Time> advance();

 private:
  std::string terminals_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::map<std::string, PortLine> lines_;
};

}  // namespace axisgate::simulated
