// SPDX-License-Identifier: Apache-2.0
// What the simulated drives saw and when, and who of them is mute, in memory that the bench shares with their process.
// Promises that a record is whole before it is counted; times are of the steady clock, which all processes share.
// Never blocks the drives: the oldest records are overwritten, and a reader that comes too late is told.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <vector>

namespace axisgate::bench {

using SteadyClock = std::chrono::steady_clock;
[[nodiscard]] inline std::chrono::nanoseconds steady_now() { return SteadyClock::now().time_since_epoch(); }

struct TappedExchange {
  std::int64_t asked_at = 0;     ///< ns of the steady clock: the request's last byte was read
  std::int64_t answered_at = 0;  ///< just before the reply was written
  std::uint16_t object = 0;      ///< index, or the first register
  bool write = false;
  std::uint8_t line = 0;
};

class ExchangeTap {
 public:
  static constexpr std::uint64_t kKept = 1U << 17;

  void record(const TappedExchange& exchange) {
    const std::uint64_t number = recorded_.load(std::memory_order_relaxed);
    kept_[number % kKept] = exchange;
    recorded_.store(number + 1, std::memory_order_release);
  }
  [[nodiscard]] std::uint64_t recorded() const { return recorded_.load(std::memory_order_acquire); }
  /// This station of every line hears and answers nothing from now on; 0: all do.
  void mute(std::uint8_t station) { mute_.store(station, std::memory_order_relaxed); }
  [[nodiscard]] std::uint8_t mute() const { return mute_.load(std::memory_order_relaxed); }
  /// From the one that `recorded()` counted as the first'th on. Throws std::runtime_error if they are gone.
  [[nodiscard]] std::vector<TappedExchange> since(std::uint64_t first) const;

 private:
  std::atomic<std::uint8_t> mute_{0};
  std::atomic<std::uint64_t> recorded_{0};
  std::array<TappedExchange, kKept> kept_;
};

/// Shared with every process that is forked afterwards; gone with the object.
class SharedTap {
 public:
  SharedTap();
  ~SharedTap();
  SharedTap(const SharedTap&) = delete;
  SharedTap& operator=(const SharedTap&) = delete;
  ExchangeTap* operator->() { return tap_; }
  const ExchangeTap& operator*() const { return *tap_; }

 private:
  ExchangeTap* tap_;
};

/// How many exchanges a second there are from now on.
class ExchangeRate {
 public:
  explicit ExchangeRate(const ExchangeTap& tap) : tap_(tap), before_(tap.recorded()) {}
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(SteadyClock::now() - began_).count(); }
  [[nodiscard]] double exchanges() const { return static_cast<double>(tap_.recorded() - before_); }
  [[nodiscard]] double per_second() const { return exchanges() / seconds(); }

 private:
  const ExchangeTap& tap_;
  std::uint64_t before_;
  SteadyClock::time_point began_ = SteadyClock::now();
};

}  // namespace axisgate::bench
