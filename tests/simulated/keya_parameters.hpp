// SPDX-License-Identifier: Apache-2.0
// The parameters of a simulated Keya that change what it does, as its manual lists them (7): number, default, range.
// Promises that motor B's number is motor A's plus 30. Never changes one: no bus can write them (2).
#pragma once

#include <array>
#include <span>

#include "tests/simulated/keya_options.hpp"

namespace axisgate::simulated {

struct KeyaParameterRow {
  int number;
  std::int64_t initial;
  std::int64_t minimum;
  std::int64_t maximum;
};

std::span<const KeyaParameterRow> keya_parameter_rows();
const KeyaParameterRow* find_keya_parameter(int number);

class KeyaParameters {
 public:
  // Throws std::invalid_argument for a number or a value the manual does not have.
  KeyaParameters(const KeyaOptions& options, KeyaInterface plugged);

  std::int64_t get(int number) const { return values_.at(number); }
  std::int64_t of(KeyaMotorName motor, int number_of_a) const {
    return get(motor == KeyaMotorName::a ? number_of_a : number_of_a + 30);
  }
  KeyaInterface interface_in_force() const { return static_cast<KeyaInterface>(get(19)); }
  bool mixed() const { return get(17) == 1; }
  bool reversed(KeyaMotorName motor) const { return (get(26) >> (motor == KeyaMotorName::a ? 0 : 1) & 1) != 0; }

 private:
  std::map<int, std::int64_t> values_;
};

}  // namespace axisgate::simulated
