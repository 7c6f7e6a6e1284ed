// SPDX-License-Identifier: Apache-2.0
// What the motor drives: where its switches, stops and index pulses are, and how fast it can change speed.
// Promises that all places are counts of the motor from where it stood when the world began.
// Never moves by itself.
#pragma once

#include <cstdint>
#include <optional>

namespace axisgate::simulated {

struct Mechanics {
  // Limit switches are normally closed and open beyond these places. A limit function without a place here has no
  // switch wired, and the drive then sits in limit state (JD 1.4 point 2).
  std::optional<std::int64_t> negative_limit;
  std::optional<std::int64_t> positive_limit;
  // The home switch is active from home_from to home_to; leave one open for a switch that stays active to the end.
  std::optional<std::int64_t> home_from;
  std::optional<std::int64_t> home_to;
  // Mechanical end stops, for the homing methods -17 and -18.
  std::optional<std::int64_t> negative_stop;
  std::optional<std::int64_t> positive_stop;
  std::int64_t index_offset = 0;  // an index pulse once per revolution, here

  std::int64_t rps_per_s_at_full_current = 2000;  // the load's inertia; also the ramp of the "immediate" mode -3
  std::int64_t coasting_rps_per_s = 50;           // friction with the torque off
};

}  // namespace axisgate::simulated
