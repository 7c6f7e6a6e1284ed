// SPDX-License-Identifier: Apache-2.0
// One millisecond of a trapezoidal profile in exact integers: ramp to a speed, or approach a position.
// Promises that an approach ends exactly on its target, never beyond it unless it starts too fast to stop in time.
// Never keeps state: speed in, speed out.
#pragma once

#include "tests/simulated/units.hpp"

namespace axisgate::simulated {

// The speed after one millisecond on the way to `target`. Slowing down uses `deceleration`, also through zero.
Dec ramp(Dec speed, Dec target, Dec acceleration, Dec deceleration);

// The speed for the next millisecond on the way over `remaining`; `maximum` is positive.
Dec approach(Dec speed, FinePosition remaining, Dec maximum, Dec acceleration, Dec deceleration);

}  // namespace axisgate::simulated
