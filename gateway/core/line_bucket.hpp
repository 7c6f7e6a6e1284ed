// SPDX-License-Identifier: Apache-2.0
// How many lines the log takes of one kind: a burst, then a few a second.
// Promises that nothing outside can fill the log through it, and that lines left out are counted.
// Never looks at what a line says.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "gateway/core/clock.hpp"

namespace axisgate {

class LineBucket {
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

/// What a line says of those before it that were left out; empty: there were none.
[[nodiscard]] inline std::string left_out_text(std::uint64_t left_out) {
  return left_out == 0 ? std::string() : " (and " + std::to_string(left_out) + " more since the last such line)";
}

}  // namespace axisgate
