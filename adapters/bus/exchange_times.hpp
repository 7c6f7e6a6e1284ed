// SPDX-License-Identifier: Apache-2.0
// How long the exchanges of a bus took, by class: counts in fixed buckets, so that an exchange costs one addition.
// Promises that counters only grow (modulo 2^32) between two starts of the gateway. Never used to decide anything.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "adapters/bus/bus_job.hpp"
#include "gateway/core/clock.hpp"

namespace axisgate::bus {

class ExchangeTimes {
 public:
  static constexpr std::size_t kBuckets = 16;
  /// Bucket i counts those below kFirst * 2^i, the last one all longer ones.
  static constexpr Duration kFirst = std::chrono::microseconds(100);
  using ByClass = std::array<std::array<std::uint32_t, kBuckets>, kPriorityCount>;

  /// An exchange that was answered, or given up at its timeout.
  void add(Priority priority, Duration took) {
    const auto units = static_cast<std::uint64_t>(std::max<std::int64_t>(0, took / kFirst));
    const auto bucket = std::min<std::size_t>(kBuckets - 1, static_cast<std::size_t>(std::bit_width(units)));
    ++counts_[static_cast<std::size_t>(priority)][bucket];
  }
  [[nodiscard]] const ByClass& by_class() const { return counts_; }

 private:
  ByClass counts_{};
};

}  // namespace axisgate::bus
