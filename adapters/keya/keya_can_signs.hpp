// SPDX-License-Identifier: Apache-2.0
// What one Keya drive shows of itself on CAN without being asked: its heartbeat, and replies that nobody waits for.
// Promises unsolicited events in the order of the frames, within bounds: an id that babbles is thinned and reported
// once in BabbleWatch::kTellAgain, a duplicate node-ID once in kTellDuplicateNodeAgain. Never says that a drive is
// gone: timeouts tell that, since nothing is known of how regular its heartbeat is. Never looks at a clock.
#pragma once

#include <boost/container/static_vector.hpp>

#include "adapters/can/babble_watch.hpp"
#include "adapters/keya/keya_can_codec.hpp"

namespace axisgate::keya {

/// Two periods of the heartbeat: the first one after more is news.
inline constexpr Duration kHeartbeatSilence = std::chrono::seconds(2);

class CanSigns {
 public:
  static constexpr Duration kTellDuplicateNodeAgain = std::chrono::seconds(10);

  explicit CanSigns(std::uint8_t node) : node_(node) {}

  struct News {
    boost::container::static_vector<bus::UnsolicitedEvent, 2> unsolicited_events;
    bool bad = false;  ///< the frame is not what its id says, or one too many
  };
  /// The link is a new one.
  void reset();
  [[nodiscard]] News on_heartbeat(Bytes bytes, Instant now);
  /// `duplicate`: it is a second reply.
  [[nodiscard]] News on_stray_reply(bool duplicate, Instant now);

 private:
  [[nodiscard]] bool passes(can::BabbleWatch& watch, std::uint32_t id, Instant now, News& news) const;

  std::uint8_t node_;
  Instant last_heartbeat_ = kLongAgo;
  Instant tell_duplicate_node_at_ = kLongAgo;
  can::BabbleWatch heartbeats_{can::kMaxSignsPerSecond};
  can::BabbleWatch stray_replies_{can::kMaxUnsolicitedRepliesPerSecond};
};

}  // namespace axisgate::keya
