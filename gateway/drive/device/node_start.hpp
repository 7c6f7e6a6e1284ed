// SPDX-License-Identifier: Apache-2.0
// Whether a CANopen node that we have commanded to start stays operational. Pure: signs of life and instants go in.
// Promises that a state from before its start counts for nothing, that a node which has left operational is to be set
// up and restarted after a pause, and that this pause grows from one failure to the next until a start has held. Never
// sends: an NMT command to a node whose motor is enabled is not its decision.
#pragma once

#include "adapters/bus/backoff.hpp"
#include "adapters/bus/exchange.hpp"

namespace axisgate::drive {

class NodeStart {
 public:
  /// A heartbeat that was on its way when the node was commanded to start shows the state before.
  static constexpr Duration kNmtSettles = std::chrono::milliseconds(100);
  /// A node that was operational for so long has obeyed: what takes it out of that state now is something new.
  static constexpr Duration kStartHeld = std::chrono::seconds(30);

  /// `timeout`: of its bus.
  explicit NodeStart(Duration timeout) : backoff_(timeout) {}

  /// Bring-up begins: it is started at its end.
  void begin() { left_ = false; }
  /// The node was commanded to change its state.
  void commanded(Instant now) { commanded_at_ = now; }
  /// A sign of life of a node that was commanded to start: true once for each start that it has left, missed or was
  /// taken out of.
  [[nodiscard]] bool has_left(bus::NodeState state, Instant now) const {
    const bool elsewhere = state == bus::NodeState::pre_operational || state == bus::NodeState::stopped;
    return elsewhere && !left_ && now - commanded_at_ > kNmtSettles;
  }
  /// It has left: the pause before it is set up again.
  Duration leave(Instant now) {
    if (now - commanded_at_ > kStartHeld) backoff_.reset();
    const Duration pause = backoff_.next();
    due_ = now + pause;
    left_ = true;
    return pause;
  }
  /// The node is to be set up and started again.
  [[nodiscard]] bool is_due(Instant now) const { return left_ && now >= due_; }
  /// When is_due() changes by time alone.
  [[nodiscard]] Instant deadline(Instant now) const { return left_ && now < due_ ? due_ : kNever; }

 private:
  bus::Backoff backoff_;
  Instant commanded_at_ = kLongAgo;
  bool left_ = false;
  Instant due_ = kLongAgo;
};

}  // namespace axisgate::drive
