// SPDX-License-Identifier: Apache-2.0
// Which events are still to be sent: by their numbers, out of the gateway's one ring.
// Promises that they come in their order, once for each life of the reader, and that those which a slow or late reader
// will never see are counted. Never copies an event.
#pragma once

#include <cstdint>

#include "gateway/image/events.hpp"

namespace axisgate::feed {

/// All that the ring has: at a start with many axes more happens than a process that starts beside them can take.
inline constexpr std::size_t kMaxEventsWaiting = kMaxEvents;

class EventFeed {
 public:
  explicit EventFeed(const EventRing& ring) : ring_(ring) {}

  /// A reader that knows nothing yet: the newest ones, also those that another one was sent before.
  void restart();
  /// Good until the ring is added to; null: none waits.
  [[nodiscard]] const Event* next();
  [[nodiscard]] bool waiting() const { return sent_ < ring_.added(); }
  /// Events that no reader was ever sent, because newer ones took their place.
  [[nodiscard]] std::uint32_t lost() const { return lost_; }

 private:
  /// Passes over what does not fit any more.
  void keep_newest();

  const EventRing& ring_;
  std::uint64_t sent_ = 0;  ///< number of the last one that was sent or passed over, to this reader
  std::uint64_t seen_ = 0;  ///< to any reader
  std::uint32_t lost_ = 0;
};

}  // namespace axisgate::feed
