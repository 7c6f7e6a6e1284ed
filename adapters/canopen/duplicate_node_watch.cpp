// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/duplicate_node_watch.hpp"

#include <chrono>
#include <utility>

namespace axisgate::canopen {

namespace {

Duration apart(Duration a, Duration b) { return std::chrono::abs(a - b); }

}  // namespace

void DuplicateNodeWatch::forget() { *this = DuplicateNodeWatch(period_); }

void DuplicateNodeWatch::on_boot_up(Instant now) {
  const bool was_alive = last_ && now - *last_ <= period_ * 3 / 2;
  const std::optional<Instant> last = last_;
  const bus::NodeState state = state_;
  forget();
  // A node that has started anew is pre-operational: that state would prove nothing.
  if (!was_alive || state == bus::NodeState::pre_operational) return;
  before_boot_ = last;
  state_before_boot_ = state;
}

bool DuplicateNodeWatch::on_heartbeat(bus::NodeState state, Instant now) {
  bool duplicate = flips(state);
  if (period_ > Duration::zero()) {
    if (last_) duplicate = out_of_rhythm(now - *last_) || duplicate;
    duplicate = is_ghost(state, now) || duplicate;
  }
  last_ = now;
  if (duplicate) forget();
  return duplicate;
}

bool DuplicateNodeWatch::flips(bus::NodeState state) {
  const bool flip = last_ && state != state_ && state == state_before_;
  flips_ = flip ? flips_ + 1 : 0;
  state_before_ = std::exchange(state_, state);
  return flips_ >= kMaxFlips;
}

bool DuplicateNodeWatch::out_of_rhythm(Duration gap) {
  const Duration before = std::exchange(gap_before_, gap);
  const bool pair =
      before > Duration::zero() && apart(before + gap, period_) <= period_ / 10 && apart(before, gap) >= period_ / 5;
  pairs_ = pair ? pairs_ + 1 : 0;
  // A device may still have a faster period of its own, until it is told ours: only one that kept ours can be joined.
  const bool fast = gap < period_ * 3 / 4;
  if (steady_gaps_ < kSteadyGaps) steady_gaps_ = apart(gap, period_) <= period_ / 4 ? steady_gaps_ + 1 : 0;
  fast_gaps_ = fast && steady_gaps_ == kSteadyGaps ? fast_gaps_ + 1 : 0;
  return pairs_ >= kMaxPairs || fast_gaps_ >= kMaxFastGaps;
}

bool DuplicateNodeWatch::is_ghost(bus::NodeState state, Instant now) {
  if (!before_boot_ || state != state_before_boot_) return false;
  const Duration off = (now - *before_boot_) % period_;
  const bool in_time = off <= period_ / 10 || period_ - off <= period_ / 10;
  ghosts_ = in_time ? ghosts_ + 1 : ghosts_;
  return ghosts_ >= kMaxGhosts;
}

}  // namespace axisgate::canopen
