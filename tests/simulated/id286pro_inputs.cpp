// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/id286pro_inputs.hpp"

namespace axisgate::simulated {

void Id286proInputs::configure(const Id286proRegisters& registers) {
  for (std::size_t input = 0; input < count; ++input) {
    functions_[input] = static_cast<std::uint16_t>(registers.get(static_cast<std::uint16_t>(400 + input)));
    simulated_[input] = registers.get(static_cast<std::uint16_t>(410 + input)) == 1;
  }
}

void Id286proInputs::wire(std::uint16_t function, bool on) {
  for (std::size_t input = 0; input < count; ++input) {
    if (functions_[input] == function) terminals_[input] = on;
  }
}

void Id286proInputs::follow(const Mechanics& mechanics, FinePosition physical) {
  const std::int64_t place = counts_of(physical);
  if (mechanics.positive_limit) wire(positive_limit, place >= *mechanics.positive_limit);
  if (mechanics.negative_limit) wire(negative_limit, place <= *mechanics.negative_limit);
  if (mechanics.home_from || mechanics.home_to) {
    const bool after = !mechanics.home_from || place >= *mechanics.home_from;
    const bool before = !mechanics.home_to || place <= *mechanics.home_to;
    wire(origin, after && before);
  }
}

bool Id286proInputs::has(std::uint16_t function) const {
  for (const std::uint16_t assigned : functions_) {
    if (assigned == function) return true;
  }
  return false;
}

bool Id286proInputs::active(std::uint16_t function) const {
  for (std::size_t input = 0; input < count; ++input) {
    if (functions_[input] == function && on(input)) return true;
  }
  return false;
}

std::vector<std::uint16_t> Id286proInputs::risen() {
  std::vector<std::uint16_t> functions;
  for (std::size_t input = 0; input < count; ++input) {
    if (on(input) && !was_on_[input]) functions.push_back(functions_[input]);
    was_on_[input] = on(input);
  }
  return functions;
}

}  // namespace axisgate::simulated
