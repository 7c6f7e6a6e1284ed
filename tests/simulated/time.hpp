// SPDX-License-Identifier: Apache-2.0
// The simulation's time: nanoseconds since the world began, pushed in by whoever owns the world.
// Promises the same unit everywhere in this folder.
// Never reads a clock.
#pragma once

#include <chrono>

namespace axisgate::simulated {

using Time = std::chrono::nanoseconds;

inline constexpr Time one_millisecond = std::chrono::milliseconds(1);

}  // namespace axisgate::simulated
