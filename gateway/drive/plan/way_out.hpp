// SPDX-License-Identifier: Apache-2.0
// The way out of one axis: every write that is about to leave is judged once more by what it could do to the motor, by
// its profile and by what the drive shows, not by who has planned it. Pure. Promises that nothing which enables or
// moves leaves after a newer stop, too late, beyond a limit, at another speed than was accepted, without having been
// asked for, or as a stop of an axis that has no torque. Never changes a write: it passes or does not.
#pragma once

#include <optional>

#include "gateway/drive/plan/write_exchange.hpp"
#include "gateway/drive/state/axis_core.hpp"

namespace axisgate::drive {

/// What an exchange brings the drive: what it writes, and the directed objects whose magnitude or direction that is.
[[nodiscard]] std::vector<Written> sent_by(const AxisCore& core, const bus::Exchange& exchange);

/// What a write could do to the motor, from the least to the most.
enum class Reach : std::uint8_t { nothing, enables, moves };
[[nodiscard]] Reach reach_of(const AxisCore& core, model::ObjectId object, std::int64_t number);

/// Who sends it.
struct Sender {
  /// The point up to which its write batch knows of stops; none: the gateway itself (bring-up, keep-alive, end).
  std::optional<AxisRecord::Point> asked{};
  bool stops = false;   ///< a stop under way
  bool begins = false;  ///< its client has asked for an enable or a start
  bool keeps = false;   ///< the keep-alive: what the drive was last known to take
  /// What enables or moves leaves by then: its client's time to begin, as long as nothing was sent, and to be answered.
  Instant by = kNever;
};

/// Errc::ok: it passes. dropped_by_stop: a stop is newer. never_started: it is too late. bad_value: beyond a limit, or
/// at another speed. state_unsuitable: nobody has asked for what it would do.
[[nodiscard]] Errc held_on_way_out(const AxisCore& core, model::ObjectId object, std::int64_t number,
                                   const Sender& sender);

}  // namespace axisgate::drive
