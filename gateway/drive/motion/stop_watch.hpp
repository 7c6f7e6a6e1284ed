// SPDX-License-Identifier: Apache-2.0
// Whether a motor goes on obeying a stop that was answered done: from one look to the next it gets slower, until it
// stands. Pure: what the drive shows goes in. Promises that a ramp which takes no longer than some forty seconds is
// none that goes on, and that each stop is reported as unheeded once. Never looks at an axis without torque, and never
// sends.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "gateway/core/clock.hpp"
#include "gateway/drive/motion/owed_stop.hpp"
#include "gateway/image/axis_record.hpp"

namespace axisgate::drive {

/// One part in so many of the speed at the stop is slower: what a loaded motor's speed varies is not taken for it.
inline constexpr std::int64_t kPartSlower = 50;

class StopWatch {
 public:
  /// In each of these it must get slower, or in the time in which its velocity can be measured, where that is longer.
  static constexpr Duration kWindow = std::chrono::seconds(1);

  /// What is watched: the stop that was accepted at this point.
  struct Stop {
    StopKind kind = StopKind::halt;
    AxisRecord::Point at = 0;
  };
  /// The drive has shown it.
  void begin(Stop stop) {
    stop_ = stop;
    slower_at_.reset();
  }
  void end() { stop_.reset(); }
  [[nodiscard]] const std::optional<Stop>& watched() const { return stop_; }

  /// A speed, without sign, sampled at this instant. True, once: it does not get slower any more, and turns.
  [[nodiscard]] bool goes_on(std::int64_t speed, Instant sampled, Duration window) {
    if (!stop_) return false;
    if (!slower_at_) at_stop_ = speed_ = speed;
    if (!slower_at_ || speed <= speed_ - std::max<std::int64_t>(at_stop_ / kPartSlower, 1)) {
      slower_at_ = sampled;
      speed_ = speed;
    }
    if (sampled - *slower_at_ < std::max(window, kWindow)) return false;
    end();
    return true;
  }

 private:
  std::optional<Stop> stop_;
  std::int64_t at_stop_ = 0;
  std::int64_t speed_ = 0;  ///< when it was seen to get slower last
  std::optional<Instant> slower_at_;
};

}  // namespace axisgate::drive
