// SPDX-License-Identifier: Apache-2.0
// The wait of a command sequence for a condition: how long, and how often the drive is asked for it. Pure. Promises
// that one sample is judged once, and that a wait leaves the wire to the commands of other drives: the pause between
// two looks doubles. Never reads anything.
#pragma once

#include <algorithm>

#include "gateway/drive/state/object_store.hpp"

namespace axisgate::drive {

class Awaiting {
 public:
  /// Between two looks, from the answer to the next request.
  static constexpr Duration kLookAgain = std::chrono::milliseconds(5);
  static constexpr Duration kLookSeldom = std::chrono::milliseconds(20);

  [[nodiscard]] bool begun() const { return until_ != kNever; }
  void begin(Instant until) {
    until_ = until;
    pause_ = kLookAgain;
  }
  void end() { until_ = kNever; }
  [[nodiscard]] bool is_over(Instant now) const { return now >= until_; }
  /// The condition was judged on this sample.
  void judged(const ObjectState& sample, Instant now) {
    if (judged_ == sample.exchange) return;
    judged_ = sample.exchange;
    look_after_ = now + pause_;
    pause_ = std::min(2 * pause_, kLookSeldom);
  }
  /// A resynchronisation read may have kept the look away until the time was over: this sample is of its end.
  [[nodiscard]] bool is_last_look(const ObjectState& sample, Instant now) const {
    return sample.sent_at + kLookSeldom >= std::min(now, until_);
  }
  [[nodiscard]] Instant look_after() const { return look_after_; }

 private:
  Instant until_ = kNever;    ///< kNever: not begun
  std::uint64_t judged_ = 0;  ///< exchange of the sample that was judged last
  Instant look_after_ = kLongAgo;
  Duration pause_{};
};

}  // namespace axisgate::drive
