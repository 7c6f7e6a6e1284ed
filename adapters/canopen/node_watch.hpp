// SPDX-License-Identifier: Apache-2.0
// Whether a node is there and in what state, by its boot-up, heartbeats, or answers to node guarding (CiA 301 section
// 7.2.8.3.2). Promises one unsolicited event for each change, one for each call(), and one for each sign that the node
// is stopped or pre-operational: whether it should be, only its drive knows, and it may learn that later than the first
// sign; `gone` once; and that a heartbeat is missed only after one was heard. Never sends: it says when a guarding
// frame is due. Never looks at a clock.
#pragma once

#include <boost/container/static_vector.hpp>
#include <optional>

#include "adapters/bus/exchange.hpp"
#include "adapters/canopen/nmt.hpp"

namespace axisgate::canopen {

class NodeWatch {
 public:
  /// A heartbeat is overdue after 1.5 periods and this: a drive's clock may be off, its frame wait for a busy bus, and
  /// we for the loop; but one that is missing altogether must be noticed before the next one is due for long.
  static constexpr Duration kHeartbeatGrace = std::chrono::milliseconds(100);

  struct Settings {
    std::uint8_t node = 1;
    Duration heartbeat{};          ///< period; 0: none is missed
    Duration guard_time{};         ///< 0: not guarded by us
    std::uint8_t life_factor = 3;  ///< guarding frames without an answer in a row; then it is gone
  };
  explicit NodeWatch(const Settings& settings) : settings_(settings) {}

  /// Nothing is known of the node; guarding begins.
  void link_up(Instant now);
  void link_down();
  /// No value: an answer whose toggle bit did not change, which tells nothing.
  [[nodiscard]] std::optional<boost::container::static_vector<bus::UnsolicitedEvent, 1>> on_error_control(
      const ErrorControl& heard, Instant now);
  /// Frames under its id are dropped, its own may be among them: it is not missed for what we did not look at.
  void on_flood(Instant now);
  /// Its next sign of life is reported, whether it is news or not. A guarding frame must be sent.
  void call() { called_ = true; }

  struct Due {
    bool guard = false;  ///< a guarding frame is to be sent
    bool gone = false;
  };
  [[nodiscard]] Due on_deadline(Instant now);
  [[nodiscard]] Instant next_deadline() const;

 private:
  [[nodiscard]] bool guarded() const { return settings_.guard_time > Duration::zero(); }
  void expect_heartbeat(Instant now);
  [[nodiscard]] bus::UnsolicitedEvent unsolicited(bus::UnsolicitedEvent::Kind kind) const;
  void forget();

  Settings settings_;
  bool present_ = false;
  bool called_ = false;
  bus::NodeState state_ = bus::NodeState::unknown;
  Instant heartbeat_due_ = kNever;
  Instant guard_due_ = kNever;
  bool unanswered_ = false;            ///< a guarding frame
  int misses_ = 0;                     ///< guarding frames in a row that were not answered
  std::optional<bool> next_toggle_{};  ///< none: whatever comes first
};

}  // namespace axisgate::canopen
