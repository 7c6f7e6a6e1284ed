// SPDX-License-Identifier: Apache-2.0
// What each step of a trial is made of: one act after the other, by what the axis has. Pure data. Promises that torque
// is preceded by a consent in the same step, that the limits are written before it, and that every motion is followed
// by a stop or a disable. Never holds a motion without a bound.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "gateway/commands/try/plan/motion_check.hpp"
#include "gateway/commands/try/plan/try_report.hpp"
#include "gateway/image/command.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::commands {

/// Only the axis number and this word goes on.
struct Consent {};
/// A person's "yes" or "no" about what was seen.
struct Question {
  std::string words;
};
/// A person turns the shaft by one turn: Enter, or "skip".
struct TurnByPerson {};
/// One write batch; it must be done.
struct Write {
  std::vector<Setpoint> setpoints{};
  Command command = Command::none;
  bool may_fail = false;
};
/// The position must not move.
struct Hold {
  Duration time{};
};
/// A start, and what comes of it.
struct Motion {
  MotionAsked asked;
  Write start;
};
/// A stop, and whether the motor stands within `limit`.
struct Stop {
  Command command = Command::quick_stop;
  Duration limit{};
};
/// No heartbeat of the gateway for so long: the motor must stand within `limit`.
struct Withhold {
  Duration after{};
  Duration limit{};
};
using Act = std::variant<Consent, Question, TurnByPerson, Write, Hold, Motion, Stop, Withhold>;

/// What the acts are made from.
struct TryAxis {
  const model::DriveModel& drive;
  const model::AxisModel& axis;
  const AxisImage& image;
  std::int16_t homing_method = 0;
  const std::vector<std::string>& open_before;  ///< what open questions of the profile forbid: "position", "enable"
};
struct Acts {
  std::vector<Act> acts{};
  std::string why_not{};  ///< it cannot be tried; empty: it can
};
/// Of the steps turn to home.
[[nodiscard]] Acts acts_of(TryStep step, const TryAxis& of);

/// What the trial writes before something moves: profile velocity and ramps, max_velocity.
inline constexpr double kSlowRpm = 10;
inline constexpr double kRunRpm = 30;
[[nodiscard]] Write limits_at(const AxisImage& image, double rpm);

}  // namespace axisgate::commands
