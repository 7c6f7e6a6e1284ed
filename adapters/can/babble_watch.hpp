// SPDX-License-Identifier: Apache-2.0
// How many frames of one identifier come in a second.
// Promises that no more than the limit pass in one second, and that an id over it is reported once in kTellAgain.
// Never looks at a frame or a clock.
#pragma once

#include "gateway/core/clock.hpp"

namespace axisgate::can {

/// Frames in a second beyond which an id babbles. Sane process data come every millisecond at the fastest: that is the
/// shortest event timer and SYNC period of CiA 301's 16-bit millisecond objects.
inline constexpr int kMaxProcessDataPerSecond = 1000;
/// Heartbeats and EMCY: a heartbeat every 20 ms would be three times as fast as any drive sheet suggests.
inline constexpr int kMaxSignsPerSecond = 50;
/// SDO replies that nobody asked for; those that were asked for come as fast as we ask.
inline constexpr int kMaxUnsolicitedRepliesPerSecond = 50;

class BabbleWatch {
 public:
  static constexpr Duration kWindow = std::chrono::seconds(1);
  static constexpr Duration kTellAgain = std::chrono::seconds(10);

  explicit BabbleWatch(int limit) : limit_(limit) {}

  struct Verdict {
    bool pass = true;
    bool tell = false;
  };
  [[nodiscard]] Verdict on_frame(Instant now) {
    if (now >= window_end_) {
      window_end_ = now + kWindow;
      count_ = 0;
    }
    if (count_ < limit_) {
      ++count_;
      return {};
    }
    const bool tell = now >= tell_at_;
    if (tell) tell_at_ = now + kTellAgain;
    return {.pass = false, .tell = tell};
  }

 private:
  int limit_;
  int count_ = 0;
  Instant window_end_ = kLongAgo;
  Instant tell_at_ = kLongAgo;
};

}  // namespace axisgate::can
