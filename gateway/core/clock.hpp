// SPDX-License-Identifier: Apache-2.0
// The gateway's only notion of time: an instant on one steady clock, and the interfaces that read it and wait for it.
// Promises that deadlines never jump with the wall clock and that a simulation can stand in for the real clock.
// Never tells the time of day: logs and DDS stamps take that elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

namespace axisgate {

using Duration = std::chrono::nanoseconds;

/// Tag clock: instants of it come from `Runtime::now()` only, never from a static `now()`.
struct GatewayClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = Duration;
  using time_point = std::chrono::time_point<GatewayClock, Duration>;
  static constexpr bool is_steady = true;
};
using Instant = GatewayClock::time_point;

/// Later than every deadline: "no deadline". Half of what fits, so that a time added to it, or the time since what
/// never happened, is still a number.
inline constexpr Instant kNever = Instant(Duration::max() / 2);
/// Earlier than everything: "never happened".
inline constexpr Instant kLongAgo = Instant(Duration::min() / 2);

/// Whole milliseconds from `from` to `to`, not below 0; kLongAgo and kNever saturate.
[[nodiscard]] constexpr std::int64_t elapsed_ms(Instant from, Instant to) {
  if (from == kLongAgo || to == kNever) return INT64_MAX;
  return to <= from ? 0 : std::chrono::duration_cast<std::chrono::milliseconds>(to - from).count();
}

/// One deadline that can be moved. Its callback runs on the core thread, never inside expires_at().
class Timer {
 public:
  Timer() = default;
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  virtual ~Timer() = default;
  /// Replaces the deadline; a past instant fires as soon as the loop turns, kNever disarms.
  virtual void expires_at(Instant deadline) = 0;
};

/// The world's clock and timers: Asio in the product, a queue of deadlines in the simulation.
class Runtime {
 public:
  Runtime() = default;
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;
  virtual ~Runtime() = default;
  [[nodiscard]] virtual Instant now() const = 0;
  [[nodiscard]] virtual std::unique_ptr<Timer> make_timer(std::function<void()> on_expiry) = 0;
};

}  // namespace axisgate
