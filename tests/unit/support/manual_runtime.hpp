// SPDX-License-Identifier: Apache-2.0
// A Runtime whose clock stands still until a test moves it.
// Promises that timers fire in order of deadline, then of arming, each seeing now() at its own deadline, and that a
// timer's callback may arm, disarm or destroy any timer, itself included. Never fires inside expires_at().
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "gateway/core/clock.hpp"

namespace axisgate::test {

class ManualRuntime final : public Runtime {
 public:
  /// More than this many timers fired at one instant is a loop that never rests.
  static constexpr int kMaxFiringsPerInstant = 100'000;

  [[nodiscard]] Instant now() const override { return now_; }
  [[nodiscard]] std::unique_ptr<Timer> make_timer(std::function<void()> on_expiry) override {
    return std::make_unique<ManualTimer>(*this, std::move(on_expiry));
  }

  /// kNever where no timer is armed.
  [[nodiscard]] Instant next_deadline() const {
    const ManualTimer* first = next_timer();
    return first == nullptr ? kNever : first->deadline;
  }

  /// Fires the first timer that is due up to and including `until`, the clock moving to its deadline; false: none was
  /// due.
  bool fire_one(Instant until) {
    ManualTimer* timer = next_timer();
    if (timer == nullptr || timer->deadline > until) return false;
    now_ = std::max(now_, timer->deadline);
    timer->deadline = kNever;
    // A copy: the callback may destroy its own timer.
    const std::function<void()> on_expiry = timer->on_expiry;
    on_expiry();
    return true;
  }
  /// Fires everything due up to and including `target`, in order; then the clock stands at `target`.
  void advance_to(Instant target) {
    assert(target >= now_);
    int firings = 0;
    for (Instant before = now_; fire_one(target); before = now_) {
      firings = now_ == before ? firings + 1 : 0;
      assert(firings < kMaxFiringsPerInstant);
    }
    now_ = target;
  }
  void advance_by(Duration step) { advance_to(now_ + step); }
  /// The event loop stands: the clock goes on and nothing fires. What is due by then fires late, with the next advance.
  void stall(Duration time) { now_ += time; }
  /// What is due now, without moving the clock: a turn of the event loop.
  void run_due() { advance_to(now_); }

 private:
  struct ManualTimer final : Timer {
    ManualTimer(ManualRuntime& of, std::function<void()> callback) : runtime(of), on_expiry(std::move(callback)) {
      runtime.timers_.push_back(this);
    }
    ManualTimer(const ManualTimer&) = delete;
    ManualTimer& operator=(const ManualTimer&) = delete;
    ~ManualTimer() override { std::erase(runtime.timers_, this); }
    void expires_at(Instant at) override {
      deadline = at;
      armed_as = ++runtime.armings_;
    }
    ManualRuntime& runtime;
    std::function<void()> on_expiry;
    Instant deadline = kNever;
    std::uint64_t armed_as = 0;
  };

  [[nodiscard]] ManualTimer* next_timer() const {
    ManualTimer* first = nullptr;
    for (ManualTimer* timer : timers_) {
      if (timer->deadline == kNever) continue;
      if (first == nullptr || timer->deadline < first->deadline ||
          (timer->deadline == first->deadline && timer->armed_as < first->armed_as)) {
        first = timer;
      }
    }
    return first;
  }

  Instant now_ = Instant{} + std::chrono::hours(1);
  std::vector<ManualTimer*> timers_;  // in order of making; all outlived by the runtime
  std::uint64_t armings_ = 0;
};

}  // namespace axisgate::test
