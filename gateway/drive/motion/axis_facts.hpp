// SPDX-License-Identifier: Apache-2.0
// What the drive of one axis shows, for the rules of what may move. Pure. Promises that an axis out of reach is not
// enabled. Never says what that means for a motion: the motion rules do.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/core/clock.hpp"
#include "gateway/image/axis_image.hpp"
#include "gateway/model/cia402.hpp"

namespace axisgate::drive {

/// What its newest statusword shows.
struct ShownState {
  bool reachable = false;  ///< link_state online or suspect
  model::State402 state = model::State402::not_ready_to_switch_on;

  [[nodiscard]] bool enabled() const { return reachable && state == model::State402::operation_enabled; }
  [[nodiscard]] bool faulted() const {
    return state == model::State402::fault || state == model::State402::fault_reaction_active;
  }
};

/// What the drive shows, from its newest samples.
struct AxisFacts : ShownState {
  Instant at = kLongAgo;           ///< now
  int mode = 0;                    ///< mode in force, unified number
  bool own_velocity_mode = false;  ///< and it is, or may be, one of the drive's own that follows a target velocity
  /// The controlword in effect has the bits of operation enabled: without them the axis is on its way out of it,
  /// however long its ramp takes, and only shows it still.
  bool commanded = true;
  bool moving = false;
  std::optional<Instant> moving_at{};  ///< when that was asked for; none: nothing is sampled for it, it is of now
  /// The velocity or torque set-point in the drive makes it turn, as far as it tells.
  bool follows = false;
  bool target_reached = false;
  bool acknowledges = true;     ///< bit 12 tells in mode 1 that a set-point was taken
  bool reference_tells = true;  ///< what says that it is homed means that in the mode in force
  bool reference = false;       ///< the drive says that it is homed
  bool homing_failed = false;
  bool motion_failed = false;             ///< a move has ended elsewhere than at its target, a run by its drive
  std::uint64_t statusword_exchange = 0;  ///< the exchange that gave the newest statusword
  std::optional<std::uint64_t> position_exchange{};  ///< and the newest position; none: nothing tells of it
};

/// A target velocity or torque acts at once in the mode in force.
[[nodiscard]] bool is_continuous(const AxisFacts& facts);
/// Which of the two: a torque in modes 4 and 10; none where is_continuous() is false.
[[nodiscard]] std::optional<Quantity> followed_target(const AxisFacts& facts);

}  // namespace axisgate::drive
