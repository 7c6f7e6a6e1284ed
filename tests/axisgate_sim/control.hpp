// SPDX-License-Identifier: Apache-2.0
// The control socket's language: one text line in, one line out, beginning with "ok" or "error".
// Promises that every error says what would be right, and that `help` lists every command.
// Never touches a socket.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "tests/axisgate_sim/control_words.hpp"
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
    DriveFaults& faults() const { return port.line->faults(position); }
  };

  std::string carry_out(const ControlWords& words);
  std::string on_line(const ControlWords& words);
  std::string on_drive(const ControlWords& words);
  std::optional<std::string> ask_drive(PortLine& port, std::size_t position, const ControlWords& words);
  std::string switch_fault(const ControlWords& words, const Target& target);
  std::string spoil(const ControlWords& words, const Target& target);
  PortLine& port_named(const std::string& name);
  Target target_named(const std::string& text);

  Simulator& simulator_;
};

// What a drive of its kind alone can do. Nothing: it is no such command.
std::optional<std::string> ask_cia402(Cia402Drive& drive, const ControlWords& words);
std::optional<std::string> ask_kinco(KincoDrive& drive, const ControlWords& words);
std::optional<std::string> ask_id286pro(Id286pro& drive, const ControlWords& words);
std::optional<std::string> ask_em2rs(Em2rs& drive, const ControlWords& words);
std::optional<std::string> ask_zlac8015d(Zlac8015d& drive, const ControlWords& words);
std::optional<std::string> ask_keya(KeyaDrive& drive, const ControlWords& words, Time now);
std::optional<std::string> ask_can(Simulator& simulator, PortLine& port, std::size_t position,
                                   const ControlWords& words);

// The newest of a record: " 12ms:#3:operation_enabled ..."
std::string transitions_text(const std::deque<Transition>& log);

}  // namespace axisgate::simulated
