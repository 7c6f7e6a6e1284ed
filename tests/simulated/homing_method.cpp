// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/homing_method.hpp"

namespace axisgate::simulated {

std::optional<HomingMethod> homing_method(int number) {
  using enum HomingSignal;
  switch (number) {
    case 33:
      return HomingMethod{none, 0, -1, false, false, true, false};
    case 34:
      return HomingMethod{none, 0, +1, false, false, true, false};
    case 35:
      return HomingMethod{none, 0, 0, false, false, false, true};
    case -17:
      return HomingMethod{end_stop, -1, -1, true, false, false, false};
    case -18:
      return HomingMethod{end_stop, +1, +1, true, false, false, false};
    default:
      break;
  }
  const bool index = number <= 14;
  const auto with = [index](HomingSignal signal, int search, int last, bool entering, bool turns_round) {
    return HomingMethod{signal, search, last, entering, turns_round, index, false};
  };
  // 17 to 30 are 1 to 14 without the index pulse.
  switch (index ? number : number - 16) {
    case 1:
      return with(negative_limit, -1, +1, false, false);
    case 2:
      return with(positive_limit, +1, -1, false, false);
    case 3:
      return with(home_switch, +1, -1, false, false);
    case 4:
      return with(home_switch, +1, +1, true, false);
    case 5:
      return with(home_switch, -1, +1, false, false);
    case 6:
      return with(home_switch, -1, -1, true, false);
    case 7:  // the switch's left edge, from inside
      return with(home_switch, +1, -1, false, true);
    case 8:  // left edge, from outside
      return with(home_switch, +1, +1, true, true);
    case 9:  // right edge, from outside
      return with(home_switch, +1, -1, true, true);
    case 10:  // right edge, from inside
      return with(home_switch, +1, +1, false, true);
    case 11:  // right edge, from inside
      return with(home_switch, -1, +1, false, true);
    case 12:  // right edge, from outside
      return with(home_switch, -1, -1, true, true);
    case 13:  // left edge, from outside
      return with(home_switch, -1, +1, true, true);
    case 14:  // left edge, from inside
      return with(home_switch, -1, -1, false, true);
    default:
      return std::nullopt;
  }
}

}  // namespace axisgate::simulated
