// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/motion/jog.hpp"

#include <cmath>

namespace axisgate::drive {

// v * latency + v * v / (2 a), with v in rpm and a in rpm/s, is minutes-turns: 60 of them are a turn. An estimate that
// only decides when to begin a halt, so a double is good enough.
bool must_stop(const JogTravel& travel, Command direction) {
  constexpr double kPerRpm = 1000, kPerRpmPerS = 10, kSecondsPerMinute = 60, kNanosecondsPerSecond = 1e9;
  const bool forward = direction == Command::jog_forward;
  const double rpm = std::abs(static_cast<double>(travel.velocity)) / kPerRpm;
  double turns = rpm * static_cast<double>(travel.latency.count()) / kNanosecondsPerSecond / kSecondsPerMinute;
  if (travel.deceleration && *travel.deceleration > 0)
    turns += rpm * rpm / (2 * static_cast<double>(*travel.deceleration) / kPerRpmPerS) / kSecondsPerMinute;
  const double way = turns * travel.units_per_rev.to_double();
  const auto position = static_cast<double>(travel.position);
  return forward ? position + way >= static_cast<double>(travel.limits.max)
                 : position - way <= static_cast<double>(travel.limits.min);
}

}  // namespace axisgate::drive
