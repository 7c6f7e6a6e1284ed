// SPDX-License-Identifier: Apache-2.0
// The watch over the event loop: a timer that measures how late it was called.
// Promises to report how late each of its turns came, and to tell since when what is read now may have waited.
// Never does anything about it.
#pragma once

#include <functional>
#include <memory>

#include "gateway/core/clock.hpp"

namespace axisgate::app {

class LoopWatch {
 public:
  static constexpr Duration kPeriod = std::chrono::milliseconds(250);
  /// So late it is no busy machine's turn: the process, or the machine, stood still.
  static constexpr Duration kStoodStill = std::chrono::seconds(2);
  /// How long it may take until all that waited then has been read.
  static constexpr Duration kAftermath = std::chrono::milliseconds(100);

  LoopWatch(Runtime& runtime, std::function<void(Duration late)> report)
      : runtime_(runtime), report_(std::move(report)), timer_(runtime.make_timer([this] { look(); })) {
    arm();
  }

  /// Since when what is read now may have waited: since the loop stood still. Now, where it did not.
  [[nodiscard]] Instant waiting_since() const {
    const Instant now = runtime_.now();
    if (now - due_ >= kStoodStill) return due_;
    return now < aftermath_until_ ? stood_since_ : now;
  }

 private:
  void arm() {
    due_ = runtime_.now() + kPeriod;
    timer_->expires_at(due_);
  }
  void look() {
    const Instant now = runtime_.now();
    if (now - due_ >= kStoodStill) {
      stood_since_ = due_;
      aftermath_until_ = now + kAftermath;
    }
    report_(now - due_);
    arm();
  }
  Runtime& runtime_;
  std::function<void(Duration)> report_;
  Instant due_ = kLongAgo;
  Instant stood_since_ = kLongAgo;
  Instant aftermath_until_ = kLongAgo;
  std::unique_ptr<Timer> timer_;
};

}  // namespace axisgate::app
