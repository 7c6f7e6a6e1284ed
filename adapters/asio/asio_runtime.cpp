// SPDX-License-Identifier: Apache-2.0
#include "adapters/asio/asio_runtime.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <utility>

namespace axisgate {

namespace {

using SteadyClock = std::chrono::steady_clock;

Instant steady_now() { return Instant(std::chrono::duration_cast<Duration>(SteadyClock::now().time_since_epoch())); }

/// What the handlers in flight share with the timer: they may outlive it.
struct TimerState {
  TimerState(boost::asio::io_context& of, std::function<void()> callback)
      : context(of), steady_timer(of), on_expiry(std::move(callback)) {}
  boost::asio::io_context& context;
  boost::asio::steady_timer steady_timer;
  std::function<void()> on_expiry;
  Instant deadline = kNever;
  Instant armed_for = kNever;  ///< what steady_timer waits for, at the latest the deadline
  bool posted = false;
  bool gone = false;
};

void arm(const std::shared_ptr<TimerState>& state);

void fire_or_arm(const std::shared_ptr<TimerState>& state) {
  if (state->gone || state->deadline == kNever) return;
  if (state->deadline > steady_now()) {
    arm(state);
    return;
  }
  state->deadline = kNever;
  state->on_expiry();
}

/// A deadline that moves back and forth with each exchange must not cost a system call each time: one that moves later
/// is left armed and looked at again when it fires; one in the past goes through the queue of the loop, not through the
/// timer.
void arm(const std::shared_ptr<TimerState>& state) {
  if (state->deadline == kNever) return;
  if (state->deadline <= steady_now()) {
    if (std::exchange(state->posted, true)) return;
    boost::asio::post(state->context, [state] {
      state->posted = false;
      fire_or_arm(state);
    });
    return;
  }
  if (state->armed_for <= state->deadline) return;
  state->armed_for = state->deadline;
  state->steady_timer.expires_at(SteadyClock::time_point(state->deadline.time_since_epoch()));
  state->steady_timer.async_wait([state](const boost::system::error_code& error) {
    if (error) return;  // armed anew for an earlier deadline, or gone
    state->armed_for = kNever;
    fire_or_arm(state);
  });
}

class AsioTimer final : public Timer {
 public:
  AsioTimer(boost::asio::io_context& context, std::function<void()> on_expiry)
      : state_(std::make_shared<TimerState>(context, std::move(on_expiry))) {}
  ~AsioTimer() override {
    state_->gone = true;
    boost::system::error_code ignored;  // its handler asks `gone` in any case
    state_->steady_timer.cancel(ignored);
  }
  void expires_at(Instant deadline) override {
    state_->deadline = deadline;
    arm(state_);
  }

 private:
  std::shared_ptr<TimerState> state_;
};

}  // namespace

Instant AsioRuntime::now() const { return steady_now(); }

std::unique_ptr<Timer> AsioRuntime::make_timer(std::function<void()> on_expiry) {
  return std::make_unique<AsioTimer>(context_, std::move(on_expiry));
}

}  // namespace axisgate
