// How busy a bus is: the share of the last whole second in which an exchange was on the wire.
// Promises 0..1000 permille at every instant, of seconds counted from the first call. Never used to decide anything.
#pragma once

#include <algorithm>
#include <cstdint>

#include "gateway/core/clock.hpp"

namespace axisgate::bus {

class LoadMeter {
 public:
  static constexpr Duration kWindow = std::chrono::seconds(1);

  /// The wire is busy, or free again, from now on. `now` never goes back.
  void set_busy(bool busy, Instant now) {
    roll(now);
    if (busy_) in_window_ += now - busy_since_;
    busy_ = busy;
    busy_since_ = now;
  }

  /// The share of the last second that is over, in 0.1 %.
  [[nodiscard]] std::uint16_t permille(Instant now) const {
    LoadMeter then = *this;
    then.roll(now);
    return then.last_;
  }

 private:
  void roll(Instant now) {
    if (window_start_ == kLongAgo) window_start_ = busy_since_ = now;
    if (now < window_start_ + kWindow) return;
    const Instant first_end = window_start_ + kWindow;
    const Duration first = in_window_ + (busy_ ? first_end - busy_since_ : Duration{});
    const auto whole_seconds = (now - window_start_) / kWindow;
    // Seconds in which nothing changed were busy or idle from end to end.
    const Duration last = whole_seconds == 1 ? first : (busy_ ? kWindow : Duration{});
    last_ = static_cast<std::uint16_t>(last * 1000 / kWindow);
    window_start_ += whole_seconds * kWindow;
    in_window_ = Duration{};
    busy_since_ = std::max(busy_since_, window_start_);
  }

  Instant window_start_ = kLongAgo;
  Instant busy_since_ = kLongAgo;
  Duration in_window_{};
  std::uint16_t last_ = 0;
  bool busy_ = false;
};

}  // namespace axisgate::bus
