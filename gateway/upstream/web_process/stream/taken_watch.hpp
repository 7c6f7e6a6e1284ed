// SPDX-License-Identifier: Apache-2.0
// Whether the other side of a connection still takes what it is sent: by what it has acknowledged, as the system counts
// it. Promises that a slow page is never taken for one that does not read. Never looks at the socket itself.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gateway/upstream/web_process/time/utc.hpp"

namespace axisgate::web {

class TakenWatch {
 public:
  static constexpr SteadyNs kTakesWithin = 10 * kSecond;

  explicit TakenWatch(SteadyNs now) : took_(now) {}

  /// So much went to the system.
  void sent(std::size_t bytes) { sent_ += bytes; }
  /// @param unacknowledged of that, as the system says
  /// @param waits there is more that the system does not take
  [[nodiscard]] bool stuck(std::size_t unacknowledged, bool waits, SteadyNs now) {
    const std::uint64_t acknowledged = sent_ - unacknowledged;
    if (acknowledged > acknowledged_ || (unacknowledged == 0 && !waits)) took_ = now;
    acknowledged_ = acknowledged;
    return now - took_ >= kTakesWithin;
  }

 private:
  std::uint64_t sent_ = 0;
  std::uint64_t acknowledged_ = 0;
  SteadyNs took_;
};

}  // namespace axisgate::web
