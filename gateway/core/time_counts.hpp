// SPDX-License-Identifier: Apache-2.0
// How long things took: counts in buckets of fixed ends, and their sum, so that one more costs two additions.
// Promises that counts and sum only grow, and that the sum is that of what was counted. Never used to decide anything.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <numeric>

#include "gateway/core/clock.hpp"

namespace axisgate {

struct TimeCounts {
  static constexpr std::size_t kBuckets = 16;
  /// Bucket i counts what took less than kFirst * 2^i, the last one all that took longer (1.6 s and more).
  static constexpr Duration kFirst = std::chrono::microseconds(100);

  std::array<std::uint64_t, kBuckets> counts{};
  std::uint64_t sum_ns = 0;

  /// What took less than nothing took nothing.
  void add(Duration took) {
    const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(0, took.count()));
    const std::uint64_t units = ns / static_cast<std::uint64_t>(kFirst.count());
    ++counts[std::min<std::size_t>(kBuckets - 1, static_cast<std::size_t>(std::bit_width(units)))];
    sum_ns += ns;
  }
  /// What another one has counted as well.
  TimeCounts& operator+=(const TimeCounts& other) {
    std::ranges::transform(counts, other.counts, counts.begin(), std::plus());
    sum_ns += other.sum_ns;
    return *this;
  }
  [[nodiscard]] std::uint64_t total() const { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }
  friend bool operator==(const TimeCounts&, const TimeCounts&) = default;
};

}  // namespace axisgate
