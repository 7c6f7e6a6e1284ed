// SPDX-License-Identifier: Apache-2.0
// Whether a program still takes what it is sent, judged by how much of it lies unread in the socket.
// Promises that a slow reader is never taken for a dead one: what it takes makes less unread than was sent.
// Never looks at the socket itself.
#pragma once

#include <cstddef>
#include <utility>

#include "gateway/core/clock.hpp"

namespace axisgate::host {

/// Nothing was taken for so long, with something to take.
inline constexpr Duration kTakesWithin = std::chrono::seconds(10);
inline constexpr Duration kLooksEach = std::chrono::seconds(1);

class TakingWatch {
 public:
  void on_ready(Instant now) { *this = TakingWatch(now); }
  void on_sent(std::size_t bytes) { sent_ += bytes; }

  /// Each kLooksEach. `unread`: as the system counts it, which is more than the bytes that were sent.
  [[nodiscard]] bool stuck(std::size_t unread, Instant now) {
    const std::size_t before = std::exchange(unread_, unread);
    const std::size_t sent = std::exchange(sent_, 0);
    if (unread == 0 || unread < before + sent) took_ = now;
    return now - took_ >= kTakesWithin;
  }

  TakingWatch() = default;

 private:
  explicit TakingWatch(Instant now) : took_(now) {}
  Instant took_ = kNever;
  std::size_t unread_ = 0;
  std::size_t sent_ = 0;  ///< since the last look
};

}  // namespace axisgate::host
