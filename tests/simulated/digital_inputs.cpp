// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/digital_inputs.hpp"

namespace axisgate::simulated {
namespace {

bool holds(std::uint16_t word, InputFunction function) {
  return (word & 0x8000U) == 0 && (word & static_cast<std::uint16_t>(function)) != 0;
}

}  // namespace

ObjectKey input_function_object(int input) {
  if (input == 8) return {0x2010, 0x1D};
  return {0x2010, static_cast<std::uint8_t>(0x02 + input)};
}

void DigitalInputs::set_pin(int input, bool high) {
  const auto bit = static_cast<std::uint16_t>(1U << (input - 1));
  pins_ = static_cast<std::uint16_t>(high ? pins_ | bit : pins_ & ~bit) & mask();
}

void DigitalInputs::configure(const ObjectDictionary& objects) {
  polarity_ = static_cast<std::uint16_t>(objects.get({0x2010, 0x01}));
  simulated_ = static_cast<std::uint16_t>(objects.get({0x2010, 0x02}));
  for (int input = 1; input <= count_; ++input) {
    functions_[static_cast<std::size_t>(input - 1)] =
        static_cast<std::uint16_t>(objects.get(input_function_object(input)));
  }
}

void DigitalInputs::wire(InputFunction function, bool high) {
  for (int input = 1; input <= count_; ++input) {
    if (holds(functions_[static_cast<std::size_t>(input - 1)], function)) set_pin(input, high);
  }
}

void DigitalInputs::follow(const Mechanics& mechanics, FinePosition physical) {
  const std::int64_t place = counts_of(physical);
  if (mechanics.positive_limit) wire(InputFunction::positive_limit, place < *mechanics.positive_limit);
  if (mechanics.negative_limit) wire(InputFunction::negative_limit, place > *mechanics.negative_limit);
  if (mechanics.home_from || mechanics.home_to) {
    const bool after = !mechanics.home_from || place >= *mechanics.home_from;
    const bool before = !mechanics.home_to || place <= *mechanics.home_to;
    wire(InputFunction::home_switch, after && before);
  }
}

bool DigitalInputs::has(InputFunction function) const {
  for (const std::uint16_t word : functions_) {
    if (holds(word, function)) return true;
  }
  return false;
}

bool DigitalInputs::active(InputFunction function) const {
  const std::uint16_t levels = effective();
  for (int input = 1; input <= count_; ++input) {
    const bool level = ((levels >> (input - 1)) & 1U) != 0;
    if (level && holds(functions_[static_cast<std::size_t>(input - 1)], function)) return true;
  }
  return false;
}

std::uint32_t DigitalInputs::input_state() const {
  std::uint32_t bits = 0;
  if (at_negative_limit()) bits |= 0x1U;
  if (at_positive_limit()) bits |= 0x2U;
  if (active(InputFunction::home_switch)) bits |= 0x4U;
  if (active(InputFunction::emergency_stop)) bits |= 0x8U;  // "hardware lock"
  return bits;
}

}  // namespace axisgate::simulated
