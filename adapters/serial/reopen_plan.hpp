// SPDX-License-Identifier: Apache-2.0
// When to try a missing device again: each second, and at once when its path appears.
// Promises a try within a second of the last, and that a path that flaps causes no more than one try each 20 ms.
// Never opens anything, and never looks at a clock.
#pragma once

#include <algorithm>

#include "gateway/core/clock.hpp"

namespace axisgate::serial {

class ReopenPlan {
 public:
  static constexpr Duration kRetry = std::chrono::seconds(1);
  static constexpr Duration kShortest = std::chrono::milliseconds(20);

  /// The next try; kNever while the device is open.
  [[nodiscard]] Instant due() const { return due_; }

  void on_open() { due_ = kNever; }
  /// A try has failed.
  void on_failure(Instant now) {
    last_failure_ = now;
    due_ = now + kRetry;
  }
  /// An open device was lost; what is left of it may look open for a moment, so not at once.
  void on_loss(Instant now) { due_ = now + kRetry; }
  /// The path has appeared, or what may be done with it has changed.
  void on_path(Instant now) {
    if (due_ != kNever) due_ = std::min(due_, soonest(now));
  }
  /// Somebody wants it open now.
  void on_request(Instant now) { due_ = soonest(now); }

 private:
  [[nodiscard]] Instant soonest(Instant now) const {
    return last_failure_ == kLongAgo ? now : std::max(now, last_failure_ + kShortest);
  }
  Instant due_ = kNever;
  Instant last_failure_ = kLongAgo;
};

}  // namespace axisgate::serial
