// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/motion/sightings.hpp"

namespace axisgate::drive {

Sightings::Changes Sightings::see(const AxisFacts& facts) {
  const Changes changes{.faulted = facts.faulted() && !faulted_,
                        .lost = !facts.reachable && reachable_,
                        .disabled = !facts.enabled() && enabled_};
  found_ = facts.enabled() && (found_ || !reachable_);
  found_at_start_ = found_ && (found_at_start_ || !ever_reachable_);
  ever_reachable_ = ever_reachable_ || facts.reachable;
  faulted_ = facts.faulted();
  reachable_ = facts.reachable;
  enabled_ = facts.enabled();
  return changes;
}

}  // namespace axisgate::drive
