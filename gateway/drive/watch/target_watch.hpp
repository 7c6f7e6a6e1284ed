// SPDX-License-Identifier: Apache-2.0
// A move that stands at its target and is never reported to be there: its window in the drive is too narrow, or it
// waits for something. Pure. Promises to report each such move once. Never ends it.
#pragma once

#include "gateway/core/clock.hpp"

namespace axisgate::drive {

class TargetWatch {
 public:
  static constexpr Duration kPatience = std::chrono::seconds(5);

  /// `waits`: a move is under way, stands at its target, and the drive does not say that it has reached it.
  [[nodiscard]] bool observe(bool waits, Instant now) {
    if (!waits) {
      since_ = kNever;
      reported_ = false;
      return false;
    }
    if (since_ == kNever) since_ = now;
    if (reported_ || now - since_ < kPatience) return false;
    reported_ = true;
    return true;
  }

 private:
  Instant since_ = kNever;
  bool reported_ = false;
};

}  // namespace axisgate::drive
