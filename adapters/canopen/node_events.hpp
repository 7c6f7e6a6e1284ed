// SPDX-License-Identifier: Apache-2.0
// The unsolicited frames of one node: boot-up, heartbeat, guarding answers, EMCY, process data. Frames and instants go
// in, unsolicited events come out. Promises them in the order of the frames, and bounds on all of them (emergency.hpp,
// babble_watch.hpp). Never sends, and never looks at a clock.
#pragma once

#include <array>
#include <boost/container/static_vector.hpp>

#include "adapters/can/babble_watch.hpp"
#include "adapters/canopen/cob_id.hpp"
#include "adapters/canopen/duplicate_node_watch.hpp"
#include "adapters/canopen/emergency.hpp"
#include "adapters/canopen/node_watch.hpp"

namespace axisgate::canopen {

class NodeEvents {
 public:
  /// A duplicate node-ID is reported so often at most.
  static constexpr Duration kTellDuplicateNodeAgain = std::chrono::seconds(10);

  explicit NodeEvents(const NodeWatch::Settings& settings);

  struct News {
    boost::container::static_vector<bus::UnsolicitedEvent, 3> unsolicited_events;
    bool bad = false;    ///< the frame is not what its id says, or one too many
    bool guard = false;  ///< a guarding frame is to be sent
    [[nodiscard]] bool restarted() const;
  };
  void link_up(Instant now);
  void link_down();
  /// Not of Service::sdo_reply: whether one was asked for is known elsewhere.
  [[nodiscard]] News on_frame(const CobId& id, Bytes bytes, Instant now);
  /// An SDO reply that nobody waits for, or no reply at all; `duplicate`: it is a second one.
  [[nodiscard]] News on_stray_reply(bool duplicate, Instant now);
  [[nodiscard]] News on_deadline(Instant now);
  [[nodiscard]] Instant next_deadline() const;

  /// `number` 1 to kTpdos. Until the node restarts.
  void map(std::uint8_t number, const bus::ProcessMap& objects) { maps_.at(number - 1U) = objects; }
  /// A guarding frame must be sent.
  void call() { watch_.call(); }
  /// We change its state or its heartbeat.
  void on_changed_by_us() { duplicates_.forget(); }

 private:
  void on_error_control(Bytes bytes, Instant now, News& news);
  void on_emergency(Bytes bytes, Instant now, News& news);
  void on_process_data(std::uint8_t number, Bytes bytes, News& news);
  void tell_duplicate_node(Instant now, News& news);
  [[nodiscard]] bool passes(can::BabbleWatch& watch, std::uint32_t id, Instant now, News& news);

  std::uint8_t node_;
  NodeWatch watch_;
  DuplicateNodeWatch duplicates_;
  Instant tell_duplicate_node_at_ = kLongAgo;
  EmergencyLimit emergencies_;
  std::array<bus::ProcessMap, kTpdos> maps_{};
  can::BabbleWatch error_control_{can::kMaxSignsPerSecond};
  can::BabbleWatch emergency_{can::kMaxSignsPerSecond};
  can::BabbleWatch stray_replies_{can::kMaxUnsolicitedRepliesPerSecond};
  std::array<can::BabbleWatch, kTpdos> process_data_;
};

}  // namespace axisgate::canopen
