// SPDX-License-Identifier: Apache-2.0
// What an axis is watched for (configuration key "watch" of an axis): motion that nothing explains, and a velocity that
// does not fit the position. Promises the defaults of the schema. Never says what the drive can show: its profile does.
#pragma once

#include <cstdint>

#include "gateway/core/clock.hpp"
#include "gateway/core/rational.hpp"

namespace axisgate::model {

/// Above so many times `standstill_velocity` a motor turns, whatever noise its velocity has.
inline constexpr int kTimesStandstill = 10;
/// One part in so many of its speed at the stop is slower: what a loaded motor's speed varies is not taken for it.
inline constexpr int kPartSlower = 50;

/// What is done about an unexpected motion that goes against no stop and no disable; against those it is always alarm
/// and stop.
enum class WatchReaction : std::uint8_t {
  off,    ///< nothing is said
  alarm,  ///< axis alarm and event
  stop,   ///< and a quick stop
};

struct WatchRules {
  Rational travel{1, 10};                             ///< turns of the motor, above 0: a way that is no settling
  Duration settle = std::chrono::milliseconds(1000);  ///< from the end of what explains a motion to its reference
  WatchReaction reaction = WatchReaction::alarm;
  bool units = true;  ///< velocity_actual is held against position_actual
  friend bool operator==(const WatchRules&, const WatchRules&) = default;
};

}  // namespace axisgate::model
