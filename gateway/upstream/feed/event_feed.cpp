// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/feed/event_feed.hpp"

#include <algorithm>

namespace axisgate::feed {

void EventFeed::restart() {
  sent_ = 0;
  keep_newest();
}

void EventFeed::keep_newest() {
  const std::uint64_t added = ring_.added();
  if (added - sent_ <= kMaxEventsWaiting) return;
  sent_ = added - kMaxEventsWaiting;
  if (sent_ > seen_) {
    lost_ += static_cast<std::uint32_t>(sent_ - seen_);
    seen_ = sent_;
  }
}

const Event* EventFeed::next() {
  keep_newest();
  if (!waiting()) return nullptr;
  const auto& events = ring_.events();
  const Event& event = events[static_cast<std::size_t>(sent_ + 1 - events.front().number)];
  seen_ = std::max(seen_, ++sent_);
  return &event;
}

}  // namespace axisgate::feed
