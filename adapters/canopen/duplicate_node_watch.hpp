// SPDX-License-Identifier: Apache-2.0
// Two devices under one node number, as their heartbeats give them away.
// Promises to suspect nothing of one device alone: whatever period it has, and whatever state we commanded.
// Never looks at a clock.
#pragma once

#include <optional>

#include "adapters/bus/exchange.hpp"

namespace axisgate::canopen {

class DuplicateNodeWatch {
 public:
  /// Heartbeats in a row that contradict the one before and agree with the one before that.
  static constexpr int kMaxFlips = 4;
  /// Gaps in a row that are unequal and make up one period with their neighbour: two devices, each on its own time.
  static constexpr int kMaxPairs = 6;
  /// Gaps in a row, each of the configured period, after which another rhythm is news; and of how many faster ones.
  static constexpr int kSteadyGaps = 3;
  static constexpr int kMaxFastGaps = 8;
  /// Heartbeats of the state before a boot-up, at the times they would have come without it.
  static constexpr int kMaxGhosts = 2;

  /// `period`: of the heartbeats, as configured; 0: unknown.
  explicit DuplicateNodeWatch(Duration period) : period_(period) {}

  void on_boot_up(Instant now);
  /// True: there are two.
  [[nodiscard]] bool on_heartbeat(bus::NodeState state, Instant now);
  /// Its state or its period is being changed by us, or the link is a new one.
  void forget();

 private:
  [[nodiscard]] bool flips(bus::NodeState state);
  [[nodiscard]] bool out_of_rhythm(Duration gap);
  [[nodiscard]] bool is_ghost(bus::NodeState state, Instant now);

  Duration period_;
  std::optional<Instant> last_{};
  bus::NodeState state_ = bus::NodeState::unknown;
  bus::NodeState state_before_ = bus::NodeState::unknown;
  int flips_ = 0;
  Duration gap_before_{};
  int pairs_ = 0;
  int steady_gaps_ = 0;
  int fast_gaps_ = 0;
  std::optional<Instant> before_boot_{};  ///< the last heartbeat before the boot-up
  bus::NodeState state_before_boot_ = bus::NodeState::unknown;
  int ghosts_ = 0;
};

}  // namespace axisgate::canopen
