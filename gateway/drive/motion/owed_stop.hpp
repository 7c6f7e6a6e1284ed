// SPDX-License-Identifier: Apache-2.0
// The stop that one axis owes: accepted, and not yet shown by a state read later than its last sending. Pure: what was
// accepted, sent and read goes in, what is to be sent now comes out.
// Promises that a halt never takes the place of a stronger stop; that after a loss nothing but stops and reads passes
// until the axis was seen to be stopped; that a stop is sent again only after a fresh read of an enabled axis, never
// faster than its pace, and never once a later enable was accepted. Never sends.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "gateway/core/clock.hpp"
#include "gateway/model/cia402.hpp"

namespace axisgate::drive {

/// From the weakest to the strongest.
enum class StopKind : std::uint8_t { halt, quick_stop, disable };

class OwedStop {
 public:
  /// After a longer loss nobody knows what a halt would meet: it becomes a quick stop.
  static constexpr Duration kShortLoss = std::chrono::seconds(1);
  /// From the end of one attempt to the next.
  static constexpr Duration kPace = std::chrono::milliseconds(500);

  /// How it ceased to be owed.
  enum class End : std::uint8_t {
    none,
    shown,     ///< by a state read after its last sending
    disabled,  ///< the axis was read without torque
    enabled,   ///< an enable was accepted later
  };

  /// `exchange`: the newest so far; only what is read by a later one tells anything of this stop.
  void accepted(StopKind stop, std::uint64_t exchange);
  /// It goes to the drive now, by itself or as the client asked.
  void sending() { sent_ = true; }
  /// An attempt at `stop` has ended. `shown`: a state read after it confirms it.
  End attempted(StopKind stop, bool shown, std::uint64_t exchange, Instant now);
  /// What the drive shows, by this exchange. `turns`: the motor turns in that state by its torque, whatever the state
  /// says.
  End state_read(model::State402 state, std::uint64_t exchange, bool turns = false);
  /// It was shown, and the motor turns on all the same.
  void unheeded(StopKind stop, std::uint64_t exchange) {
    accepted(stop, exchange);
    sent_ = true;
  }
  /// What was accepted after the stop is carried out: what was asked last is what happens. A start takes back a halt
  /// alone.
  End enabled_later();
  End started_later();

  /// The drive is not there any more. `heard`: when it was heard last.
  void link_lost(Instant heard, std::uint64_t exchange);
  /// It has answered again.
  void link_back(Instant now);
  /// It says that it has restarted.
  void restarted() { uncertain_ = uncertain_ || stop_.has_value(); }

  [[nodiscard]] bool owed() const { return stop_.has_value(); }
  [[nodiscard]] bool halts() const { return stop_ == StopKind::halt; }
  /// Until the axis is seen to be stopped nothing but stops and reads passes: the drive was lost since.
  [[nodiscard]] bool gates() const { return owed() && by_loss_; }
  /// It is to be reported that nothing but stops and reads passes: once for each stop that is owed.
  [[nodiscard]] bool take_gate_report() { return gates() && !std::exchange(reported_, true); }
  /// The gating was reported of the stop that has ceased to be owed: once.
  [[nodiscard]] bool take_end_report() { return std::exchange(reported_, false); }
  /// What must be sent now: the axis was read enabled since the last attempt.
  [[nodiscard]] std::optional<StopKind> due(Instant now) const;
  /// When due() may change without anything being reported.
  [[nodiscard]] Instant next_deadline(Instant now) const {
    return read_enabled_ && not_before_ > now ? not_before_ : kNever;
  }

 private:
  End discharge(End how);

  std::optional<StopKind> stop_;
  bool away_ = false;
  Instant heard_ = kLongAgo;   ///< last, before the loss
  bool by_loss_ = false;       ///< accepted while the drive was away, or the drive was lost since
  bool uncertain_ = false;     ///< restarted, or away for long
  bool sent_ = false;          ///< at least once
  bool read_enabled_ = false;  ///< since the last attempt
  bool reported_ = false;      ///< an event has reported that it gates: its end is reported as well
  std::uint64_t after_ = 0;    ///< only samples of later exchanges count
  Instant not_before_ = kLongAgo;
};

}  // namespace axisgate::drive
