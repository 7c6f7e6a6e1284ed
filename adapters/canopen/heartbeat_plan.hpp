// SPDX-License-Identifier: Apache-2.0
// When our own periodic frames are due: SYNC, and the heartbeat by which the drives watch the gateway (1016h).
// Promises no drift, and no burst after a stall: what was missed is left out.
// Never sends, and never looks at a clock.
#pragma once

#include <boost/container/static_vector.hpp>

#include "adapters/canopen/nmt.hpp"
#include "gateway/core/clock.hpp"

namespace axisgate::canopen {

class PeriodPlan {
 public:
  /// 0: never.
  explicit PeriodPlan(Duration period) : period_(period) {}
  void begin(Instant now) { next_ = period_ > Duration::zero() ? now : kNever; }
  [[nodiscard]] bool due(Instant now) {
    if (now < next_) return false;
    next_ += ((now - next_) / period_ + 1) * period_;
    return true;
  }
  [[nodiscard]] Instant next_deadline() const { return next_; }

 private:
  Duration period_;
  Instant next_ = kNever;
};

class HeartbeatPlan {
 public:
  explicit HeartbeatPlan(Duration period) : period_(period) {}
  /// One is due now, and then each period: the link is up, or a drive has just been configured to listen.
  void begin(Instant now) { period_.begin(now); }
  /// The first one ever comes behind a boot-up. Not so after a loss of the link: we did not restart, and a drive
  /// that heard nothing of the loss would take it for a reason to stop.
  [[nodiscard]] boost::container::static_vector<can::CanFrame, 2> due(Instant now, std::uint8_t own_node) {
    boost::container::static_vector<can::CanFrame, 2> frames;
    if (!period_.due(now)) return frames;
    if (!booted_) frames.push_back(boot_up_frame(own_node));
    booted_ = true;
    frames.push_back(operational_heartbeat_frame(own_node));
    return frames;
  }
  [[nodiscard]] Instant next_deadline() const { return period_.next_deadline(); }

 private:
  PeriodPlan period_;
  bool booted_ = false;
};

}  // namespace axisgate::canopen
