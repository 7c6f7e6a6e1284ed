// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/watch/slowing.hpp"

#include <cstdlib>

namespace axisgate::drive {

void FirstFall::before(std::int64_t velocity) {
  if (std::abs(velocity) > std::abs(fastest_)) fastest_ = velocity;
}

bool FirstFall::falls(std::int64_t velocity, Instant sampled, std::int64_t standstill) {
  before(velocity);
  const std::int64_t fastest = std::abs(fastest_);
  const std::int64_t speed = fastest_ < 0 ? -velocity : velocity;
  turned_round_ = turned_round_ || speed < 0;
  if (fastest - speed >= std::max(fastest / model::kPartSlower, model::kTimesStandstill * standstill)) return true;
  if (steady_.since == kNever || speed > steady_.lowest + standstill)
    steady_ = {.since = sampled, .from = speed, .lowest = speed};
  if (speed < steady_.lowest) ++steady_.steps;
  steady_.lowest = std::min(steady_.lowest, speed);
  return sampled - steady_.since >= kSteadily && steady_.steps >= kSteps &&
         steady_.from - speed >= std::max(steady_.from / kPartSteadily, 2 * standstill);
}

}  // namespace axisgate::drive
