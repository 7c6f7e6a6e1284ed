// SPDX-License-Identifier: Apache-2.0
// How often an unresponsive drive is probed: 0.5 s, doubling until probes take at most 0.5 % of the bus's time, 60 s at
// most. Promises that a dead drive costs its bus no more than that share in the long run. Never probes by itself: it
// only says when.
#pragma once

#include <algorithm>

#include "gateway/core/clock.hpp"

namespace axisgate::bus {

class Backoff {
 public:
  static constexpr Duration kFirst = std::chrono::milliseconds(500);
  static constexpr Duration kLongest = std::chrono::seconds(60);
  /// A probe costs one timeout: 0.5 % of the time is 200 timeouts.
  static constexpr int kTimeoutsPerProbe = 200;

  explicit Backoff(Duration timeout) : longest_(std::clamp(timeout * kTimeoutsPerProbe, kFirst, kLongest)) {}

  /// The pause before the next probe; each call doubles the one after.
  [[nodiscard]] Duration next() {
    const Duration pause = std::min(step_, longest_);
    step_ = std::min(step_ * 2, longest_);
    return pause;
  }
  void reset() { step_ = kFirst; }

 private:
  Duration longest_;
  Duration step_ = kFirst;
};

}  // namespace axisgate::bus
