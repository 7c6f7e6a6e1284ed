// The control socket's language: one text line in, one line out, beginning with "ok" or "error".
// Promises that every error says what would be right, and that `help` lists every command.
// Never touches a socket.
#pragma once

#include <string>
#include <string_view>

#include "tests/axisgate_sim/simulator.hpp"

namespace axisgate::simulated {

class Control {
 public:
  explicit Control(Simulator& simulator) : simulator_(simulator) {}

  std::string answer(std::string_view line);
  // As a command `NAME LINE/STATION [RATE]` would set it; for --fault. Throws std::invalid_argument.
  void set_fault(std::string_view text);

 private:
  struct Target {
    PortLine& port;
    std::size_t position;
    KincoDrive& drive() const { return port.line->drive(position); }
    DriveFaults& faults() const { return port.line->faults(position); }
  };
  using Words = std::vector<std::string>;

  std::string carry_out(const Words& words);
  std::string on_line(const Words& words);
  std::string on_drive(const Words& words);
  std::string switch_fault(const Words& words, const Target& target);
  PortLine& port_named(const std::string& name);
  Target target_named(const std::string& text);

  Simulator& simulator_;
};

}  // namespace axisgate::simulated
