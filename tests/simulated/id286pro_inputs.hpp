// SPDX-License-Identifier: Apache-2.0
// The iD286pro's three inputs: terminals, simulated inputs 0410 to 0412 and functions 0400 to 0402 (iD286pro 5).
// Promises that an input is on while its terminal or its simulation is, and that each rising edge is told once.
// Never decides what a function leads to.
#pragma once

#include <array>
#include <vector>

#include "tests/simulated/id286pro_registers.hpp"
#include "tests/simulated/mechanics.hpp"
#include "tests/simulated/units.hpp"

namespace axisgate::simulated {

class Id286proInputs {
 public:
  static constexpr int count = 3;
  static constexpr std::uint16_t positive_limit = 9;
  static constexpr std::uint16_t negative_limit = 10;
  static constexpr std::uint16_t origin = 11;
  static constexpr std::uint16_t enable = 20;

  void set_terminal(int input, bool on) { terminals_.at(static_cast<std::size_t>(input - 1)) = on; }
  bool terminal(int input) const { return terminals_.at(static_cast<std::size_t>(input - 1)); }
  void configure(const Id286proRegisters& registers);
  // Moves the terminals that are wired to a switch of the mechanics.
  void follow(const Mechanics& mechanics, FinePosition physical);

  bool has(std::uint16_t function) const;
  bool active(std::uint16_t function) const;
  // Functions of the inputs that have come on since the last call.
  std::vector<std::uint16_t> risen();
  void forget_edges() { (void)risen(); }

 private:
  bool on(std::size_t input) const { return terminals_[input] || simulated_[input]; }
  void wire(std::uint16_t function, bool on);

  std::array<bool, count> terminals_{};
  std::array<bool, count> simulated_{};
  std::array<bool, count> was_on_{};
  std::array<std::uint16_t, count> functions_{};
};

}  // namespace axisgate::simulated
