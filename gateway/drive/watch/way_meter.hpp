// SPDX-License-Identifier: Apache-2.0
// The way of a motor, to and fro, from its positions. Pure. Promises that the trembling of a motor that stands is no
// way, and that what was not seen is none: over a gap, another zero, the end of the counter. Never used to decide
// anything.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace axisgate::drive {

class WayMeter {
 public:
  /// Less than so many turns is trembling; what is slow comes to more in time.
  static constexpr double kTremble = 0.001;

  /// The way to this position, 1e-6 turns. @param position register units @param units so many are a turn
  std::uint64_t to(std::int64_t position, double units) {
    constexpr double kMicro = 1e6;
    constexpr std::int64_t kWrapped = INT32_MAX;
    const std::int64_t way = std::abs(position - from_.value_or(position));
    const double turns = static_cast<double>(way) / units;
    if (from_ && turns < kTremble) return 0;
    from_ = position;
    return way < kWrapped ? static_cast<std::uint64_t>(std::llround(turns * kMicro)) : 0;
  }
  /// It counts from the next position on.
  void lose() { from_.reset(); }

 private:
  std::optional<std::int64_t> from_{};
};

}  // namespace axisgate::drive
