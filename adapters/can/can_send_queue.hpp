// SPDX-License-Identifier: Apache-2.0
// Frames that wait until the driver or the adapter takes them.
// Promises at most kMaxUnsentFrames, urgent ones before the others, each kind in order, and to tell when one has waited
// for too long. Never sends, and never looks at a clock.
#pragma once

#include <algorithm>
#include <deque>

#include "adapters/can/can_link.hpp"

namespace axisgate::can {

class SendQueue {
 public:
  /// False: full, and the frame is not taken.
  [[nodiscard]] bool push(const CanFrame& frame, bool urgent, Instant now) {
    if (waiting_.size() >= kMaxUnsentFrames) return false;
    const auto normal = std::ranges::find_if(waiting_, [](const Entry& entry) { return !entry.urgent; });
    waiting_.insert(urgent ? normal : waiting_.end(), {frame, urgent, now});
    return true;
  }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] std::size_t size() const { return waiting_.size(); }
  [[nodiscard]] const CanFrame& front() const { return waiting_.front().frame; }
  void pop() { waiting_.pop_front(); }
  void clear() { waiting_.clear(); }
  /// When the frame that waits longest has waited for kMaxSendWait; kNever where none waits.
  [[nodiscard]] Instant overdue_at() const {
    Instant oldest = kNever;
    for (const Entry& entry : waiting_) oldest = std::min(oldest, entry.since);
    return oldest == kNever ? kNever : oldest + kMaxSendWait;
  }

 private:
  struct Entry {
    CanFrame frame;
    bool urgent = false;
    Instant since;
  };
  std::deque<Entry> waiting_;
};

}  // namespace axisgate::can
