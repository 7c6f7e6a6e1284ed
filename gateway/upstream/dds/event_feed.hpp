// SPDX-License-Identifier: Apache-2.0
// Which events are still to be sent: by their numbers, out of the gateway's one ring.
// Promises that they come in their order, once for each life of the reader, and that those which a slow or late reader
// will never see are counted. Never copies an event before its turn.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/image/events.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

class EventFeed {
 public:
  explicit EventFeed(const EventRing& ring) : ring_(ring) {}

  /// A reader that knows nothing yet: the newest ones, also those that another one was sent before.
  void restart();
  [[nodiscard]] std::optional<EventRecord> next();
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

}  // namespace axisgate::dds
