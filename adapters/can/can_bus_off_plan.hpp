// SPDX-License-Identifier: Apache-2.0
// Whether a CAN controller can be spoken through: from its error frames and the time.
// Promises: bus-off counts at once, and until the controller says it was restarted; the sixth bus-off within a minute
// gives the bus up until a minute has passed without another (or the owner begins with a new plan, since the interface
// was taken down and up); a missing acknowledgement counts when the controller is error passive by it and its queue is
// full, or half a second has passed without a frame from anybody. Never looks at a clock, and never acts.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "adapters/can/can_error.hpp"
#include "adapters/can/can_link.hpp"

namespace axisgate::can {

class BusOffPlan {
 public:
  /// More within kWindow: somebody must look at the bus, and restarting it again and again would disturb the others.
  static constexpr std::size_t kMaxBusOffs = 5;
  static constexpr Duration kWindow = std::chrono::seconds(60);
  /// Error passive without acknowledgement for this long is no hiccup.
  static constexpr Duration kNoAckPersists = std::chrono::milliseconds(500);
  /// A controller repeats an unacknowledged frame for ever: this long without a further complaint, somebody took it.
  static constexpr Duration kNoAckQuiet = std::chrono::seconds(1);

  enum class Health : std::uint8_t { usable, no_ack, bus_off, given_up };

  /// Counts in `trouble`, too.
  void on_errors(const CanErrors& errors, Instant now, CanTrouble& trouble);
  /// The driver takes no more frames.
  void on_queue_full() { queue_full_ = no_ack_since_ != kNever; }
  /// A frame was received: there is somebody on the bus.
  void on_frame();
  /// The controller runs again, as its own state tells, not an error frame.
  void on_restart();
  /// The controller is found standing still: it went bus-off before anybody listened.
  void on_found_stopped() { bus_off_ = true; }

  [[nodiscard]] Health health(Instant now) const;
  [[nodiscard]] bool error_passive() const { return passive_; }
  /// When health() may change by time alone; kNever: not at all.
  [[nodiscard]] Instant due(Instant now) const;

 private:
  void on_bus_off(Instant now);
  void judge_acknowledgement(Instant now);

  bool bus_off_ = false;
  std::array<Instant, kMaxBusOffs> bus_offs_ = filled_with_long_ago();  ///< the last ones, oldest first
  Instant given_up_until_ = kLongAgo;
  bool passive_ = false;
  bool queue_full_ = false;
  Instant last_no_ack_ = kLongAgo;
  Instant no_ack_since_ = kNever;  ///< error passive, and nobody acknowledges

  static constexpr std::array<Instant, kMaxBusOffs> filled_with_long_ago() {
    std::array<Instant, kMaxBusOffs> all{};
    all.fill(kLongAgo);
    return all;
  }
};

/// What a user should read: "nobody acknowledges: ...", with what to look at.
[[nodiscard]] std::string text(BusOffPlan::Health health);

}  // namespace axisgate::can
