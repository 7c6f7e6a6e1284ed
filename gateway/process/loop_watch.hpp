// SPDX-License-Identifier: Apache-2.0
// The watch over the event loop: a timer that measures how late it was called.
// Promises to report each turn that came kSlowLoop late or more.
// Never does anything about it.
#pragma once

#include <functional>
#include <memory>

#include "gateway/core/clock.hpp"

namespace axisgate::process {

class LoopWatch {
 public:
  static constexpr Duration kPeriod = std::chrono::milliseconds(250);

  LoopWatch(Runtime& runtime, std::function<void(Duration late)> report)
      : runtime_(runtime), report_(std::move(report)), timer_(runtime.make_timer([this] { look(); })) {
    arm();
  }

 private:
  void arm() {
    due_ = runtime_.now() + kPeriod;
    timer_->expires_at(due_);
  }
  void look() {
    report_(runtime_.now() - due_);
    arm();
  }
  Runtime& runtime_;
  std::function<void(Duration)> report_;
  Instant due_ = kLongAgo;
  std::unique_ptr<Timer> timer_;
};

}  // namespace axisgate::process
