// SPDX-License-Identifier: Apache-2.0
// How long the exchanges of a bus took, or how long bus jobs waited for their first one, by class.
// Promises that counts only grow between two starts of the gateway. Never used to decide anything.
#pragma once

#include <array>

#include "adapters/bus/bus_job.hpp"
#include "gateway/core/time_counts.hpp"

namespace axisgate::bus {

class ExchangeTimes {
 public:
  using ByClass = std::array<TimeCounts, kPriorityCount>;

  /// An exchange that was answered, or given up at its timeout; a wait that has ended on the wire.
  void add(Priority priority, Duration took) { by_class_[static_cast<std::size_t>(priority)].add(took); }
  [[nodiscard]] const ByClass& by_class() const { return by_class_; }
  /// Of all classes together.
  [[nodiscard]] Duration sum() const {
    TimeCounts all;
    for (const TimeCounts& each : by_class_) all += each;
    return Duration(static_cast<std::int64_t>(all.sum_ns));
  }

 private:
  ByClass by_class_{};
};

}  // namespace axisgate::bus
