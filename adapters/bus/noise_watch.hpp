// SPDX-License-Identifier: Apache-2.0
// Tells a line that babbles from one that has a hiccup: bytes without an answer in them, without a pause, for over 100
// ms. Promises that an answer clears it, and so does a pause longer than a USB adapter's latency
// timer (16 ms). Never acts: it only says.
#pragma once

#include "gateway/core/clock.hpp"

namespace axisgate::bus {

class NoiseWatch {
 public:
  static constexpr Duration kTooLong = std::chrono::milliseconds(100);
  static constexpr Duration kPause = std::chrono::milliseconds(20);

  void clear() { since_ = last_ = kLongAgo; }
  /// Bytes came that belong to no frame.
  void on_noise(Instant now) {
    if (last_ == kLongAgo || now - last_ > kPause) since_ = now;
    last_ = now;
  }
  /// Noise for longer than kTooLong, and still going on.
  [[nodiscard]] bool babbles(Instant now) const { return heard_lately(now) && now - since_ > kTooLong; }
  [[nodiscard]] bool heard_lately(Instant now) const { return last_ != kLongAgo && now - last_ <= kPause; }

 private:
  Instant since_ = kLongAgo;
  Instant last_ = kLongAgo;
};

}  // namespace axisgate::bus
