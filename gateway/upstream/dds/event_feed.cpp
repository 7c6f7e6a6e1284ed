// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/event_feed.hpp"

#include <algorithm>

#include "gateway/upstream/dds/dds_session.hpp"

namespace axisgate::dds {

static_assert(kMaxEventsWaiting <= kMaxEvents, "what waits is in the ring");

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

std::optional<EventRecord> EventFeed::next() {
  keep_newest();
  if (!waiting()) return std::nullopt;
  const auto& events = ring_.events();
  const Event& event = events[static_cast<std::size_t>(sent_ + 1 - events.front().number)];
  seen_ = std::max(seen_, ++sent_);
  return EventRecord{event.axis,   event.at == kLongAgo ? 0 : event.at.time_since_epoch().count(),
                     event.number, static_cast<std::uint8_t>(event.kind),
                     event.code,   event.text};
}

}  // namespace axisgate::dds
