// SPDX-License-Identifier: Apache-2.0
// The homing methods of 6098 as a table: which signal, from which side, with or without the index pulse (JD 6.5,
// MD 8.5). Promises CiA 402's meaning inside the groups, which the manual says the methods follow; its own figures are
// lost. Never moves anything.
#pragma once

#include <cstdint>
#include <optional>

namespace axisgate::simulated {

enum class HomingSignal : std::uint8_t { none, negative_limit, positive_limit, home_switch, end_stop };

struct HomingMethod {
  HomingSignal signal;
  int search;        // first direction, while the signal is inactive
  int last;          // direction of the final run over the edge, or towards the index pulse
  bool entering;     // the edge counts when the signal becomes active, else when it becomes inactive
  bool turns_round;  // a limit on the way reverses the search
  bool index;        // then the next index pulse in the last direction
  bool at_once;      // method 35: here
};

// Nothing for the reserved numbers 15, 16, 31, 32 and all others.
std::optional<HomingMethod> homing_method(int number);

}  // namespace axisgate::simulated
