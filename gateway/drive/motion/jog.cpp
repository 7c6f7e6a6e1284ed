// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/motion/jog.hpp"

#include <cmath>

namespace axisgate::drive {

// v * v / (2 a), with v in rpm and a in rpm/s, is minutes-turns: 60 of them are a turn. An estimate that only decides
// when to begin a halt, so a double is good enough.
Duration time_left(const JogTravel& travel, Command direction) {
  constexpr double kPerRpm = 1000, kPerRpmPerS = 10, kSecondsPerMinute = 60;
  constexpr std::chrono::duration<double> kLongest = std::chrono::hours(1);
  const double rpm = std::abs(static_cast<double>(travel.velocity)) / kPerRpm;
  double turns = 0;
  if (travel.deceleration && *travel.deceleration > 0)
    turns = rpm * rpm / (2 * static_cast<double>(*travel.deceleration) / kPerRpmPerS) / kSecondsPerMinute;
  const double units_per_rev = travel.units_per_rev.to_double();
  const auto position = static_cast<double>(travel.position);
  const double room = direction == Command::jog_forward ? static_cast<double>(travel.limits.max) - position
                                                        : position - static_cast<double>(travel.limits.min);
  const double left = room - turns * units_per_rev;
  if (left <= 0) return Duration::zero();
  const double speed = rpm / kSecondsPerMinute * units_per_rev;
  if (left >= speed * kLongest.count()) return std::chrono::duration_cast<Duration>(kLongest);
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(left / speed));
}

}  // namespace axisgate::drive
