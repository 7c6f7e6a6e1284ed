// SPDX-License-Identifier: Apache-2.0
// How busy a bus is: the share of the last whole second in which an exchange was on the wire, or, where the wire counts
// them, the share of its bits that were taken.
// Promises 0..1000 permille at every instant, of seconds counted from the first call. Never used to decide anything.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

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

/// The same of a wire that counts its bits: all of them, also those that nobody asked for (CAN).
class BitMeter {
 public:
  explicit BitMeter(std::uint32_t bit_rate) : bit_rate_(bit_rate) {}

  /// So many bits since the beginning; none: they are not counted. A window ends with the first call after a second of
  /// it.
  void count(std::optional<std::uint64_t> carried, Instant now) {
    if (!carried) return;
    const std::uint64_t bits = *carried;
    if (start_ == kLongAgo) return begin(bits, now);
    const auto elapsed = std::chrono::duration_cast<std::chrono::microseconds>(now - start_).count();
    if (now - start_ < LoadMeter::kWindow || bit_rate_ == 0) return;
    constexpr std::uint64_t kPermille = 1000, kMicros = 1'000'000;
    const std::uint64_t room = std::uint64_t{bit_rate_} * static_cast<std::uint64_t>(elapsed) / kMicros;
    last_ =
        static_cast<std::uint16_t>(std::min((bits - from_) * kPermille / std::max<std::uint64_t>(room, 1), kPermille));
    begin(bits, now);
  }
  [[nodiscard]] std::uint16_t permille(std::uint64_t bits, Instant now) const {
    BitMeter then = *this;
    then.count(bits, now);
    return then.last_;
  }

 private:
  void begin(std::uint64_t bits, Instant now) {
    from_ = bits;
    start_ = now;
  }
  std::uint32_t bit_rate_;
  std::uint64_t from_ = 0;
  Instant start_ = kLongAgo;
  std::uint16_t last_ = 0;
};

}  // namespace axisgate::bus
