// How many lines of axisgate-dds the log takes: a burst, then a few a second.
// Promises that nothing on the network can fill the log through it, and that lines left out are counted.
// Never looks at what a line says.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "gateway/core/clock.hpp"

namespace axisgate::dds {

class LineLimit {
 public:
  static constexpr std::int64_t kBurst = 20;
  static constexpr Duration kEach = std::chrono::milliseconds(500);

  [[nodiscard]] bool takes(Instant now) {
    const std::int64_t earned = filled_ == kLongAgo ? kBurst : (now - filled_) / kEach;
    if (earned > 0) {
      left_ = std::min(kBurst, left_ + earned);
      filled_ = now;
    }
    if (left_ == 0) {
      ++left_out_;
      return false;
    }
    --left_;
    return true;
  }
  /// Since it was asked last.
  [[nodiscard]] std::uint64_t left_out() { return std::exchange(left_out_, 0); }

 private:
  std::int64_t left_ = 0;
  std::uint64_t left_out_ = 0;
  Instant filled_ = kLongAgo;
};

}  // namespace axisgate::dds
