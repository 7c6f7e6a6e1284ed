// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/trapezoid.hpp"

#include <algorithm>

namespace axisgate::simulated {
namespace {

// What is still travelled after this millisecond's step at `speed`, when each further step is slower by `deceleration`.
FinePosition stopping_distance(Dec speed, Dec deceleration) {
  const std::int64_t steps = speed / deceleration;
  return steps * speed - deceleration * (steps * (steps + 1) / 2);
}

}  // namespace

Dec ramp(Dec speed, Dec target, Dec acceleration, Dec deceleration) {
  acceleration = std::max<Dec>(acceleration, 1);
  deceleration = std::max<Dec>(deceleration, 1);
  if (speed == target) return speed;
  if (speed > 0 && target < speed) return std::max({speed - deceleration, target, target < 0 ? Dec{0} : target});
  if (speed < 0 && target > speed) return std::min({speed + deceleration, target, target > 0 ? Dec{0} : target});
  return target > speed ? std::min(speed + acceleration, target) : std::max(speed - acceleration, target);
}

Dec approach(Dec speed, FinePosition remaining, Dec maximum, Dec acceleration, Dec deceleration) {
  acceleration = std::max<Dec>(acceleration, 1);
  deceleration = std::max<Dec>(deceleration, 1);
  if (remaining < 0 || (remaining == 0 && speed < 0)) {
    return -approach(-speed, -remaining, maximum, acceleration, deceleration);
  }
  if (speed < 0) return ramp(speed, 0, acceleration, deceleration);  // the wrong way: stop first
  Dec slowest = std::max<Dec>(speed - deceleration, 0);
  Dec fastest = std::max(std::min(speed + acceleration, maximum), slowest);
  // The fastest step from which the rest of the way still suffices to stop; the condition is monotone.
  while (slowest < fastest) {
    const Dec middle = slowest + (fastest - slowest + 1) / 2;
    if (middle + stopping_distance(middle, deceleration) <= remaining) {
      slowest = middle;
    } else {
      fastest = middle - 1;
    }
  }
  // Discrete steps may leave a rest smaller than one deceleration: the last step takes it whole.
  return slowest > remaining && slowest <= deceleration ? remaining : slowest;
}

}  // namespace axisgate::simulated
