// SPDX-License-Identifier: Apache-2.0
// The drive's digital inputs: pins, polarity 2010:01, simulation 2010:02 and the functions 2010:03 to :09 and :1D.
// Promises that a limit function is at its limit while its input is inactive (JD K44, MD C50), wired or not.
// Never decides what a function leads to.
#pragma once

#include <array>
#include <cstdint>

#include "tests/simulated/kinco_model.hpp"
#include "tests/simulated/mechanics.hpp"
#include "tests/simulated/units.hpp"

namespace axisgate::simulated {

// JD 4.16, MD 6.1. Codes with bit 15 are another page and combine with none of these.
enum class InputFunction : std::uint16_t {
  drive_enable = 0x0001,
  fault_reset = 0x0002,
  mode_control = 0x0004,
  positive_limit = 0x0010,
  negative_limit = 0x0020,
  home_switch = 0x0040,
  emergency_stop = 0x1000,
};

ObjectKey input_function_object(int input);  // 1 to 8

class DigitalInputs {
 public:
  explicit DigitalInputs(int count) : count_(count) {}

  void set_pin(int input, bool high);
  // For a drive whose functions stand elsewhere; several may be set in one word.
  void assign(int input, std::uint16_t functions) { functions_.at(static_cast<std::size_t>(input - 1)) = functions; }
  // Takes over what the dictionary says of polarity, simulation and functions; call after each write.
  void configure(const ObjectDictionary& objects);
  // Moves the switches of the mechanics that are wired to inputs with the fitting function.
  void follow(const Mechanics& mechanics, FinePosition physical);

  bool has(InputFunction function) const;
  bool active(InputFunction function) const;
  bool at_positive_limit() const { return off(InputFunction::positive_limit); }
  bool at_negative_limit() const { return off(InputFunction::negative_limit); }

  std::uint16_t pins() const { return pins_; }  // 2010:0A
  std::uint32_t input_state() const;            // 60FD
  std::uint16_t effective() const { return static_cast<std::uint16_t>((pins_ ^ ~polarity_) | simulated_) & mask(); }

 private:
  bool off(InputFunction function) const { return has(function) && !active(function); }
  std::uint16_t mask() const { return static_cast<std::uint16_t>((1U << count_) - 1U); }
  void wire(InputFunction function, bool high);

  int count_;
  std::uint16_t pins_ = 0;
  std::uint16_t polarity_ = 0xFF;
  std::uint16_t simulated_ = 0;
  std::array<std::uint16_t, 8> functions_{};
};

}  // namespace axisgate::simulated
