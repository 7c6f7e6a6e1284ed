// SPDX-License-Identifier: Apache-2.0
// The motions that a trial makes, with their bounds: numbers of the person's units become those of the registers.
// Promises that each has a way, a speed and a time that it must not go beyond. Pure. Never writes what the axis does
// not take.
#pragma once

#include "gateway/commands/try/plan/try_acts.hpp"

namespace axisgate::commands {

/// A move by some turns can be asked for.
[[nodiscard]] bool has_moves(const AxisImage& image);
/// `rpm` above 0. Its target is a way: of move_absolute the present position is added when it starts.
[[nodiscard]] Motion move_by(const AxisImage& image, double turns, double rpm);
/// At `rpm`, signed, for `time`; where the axis has no such command by a move that is longer.
[[nodiscard]] Motion turn_at(const AxisImage& image, double rpm, Duration time);
[[nodiscard]] Motion homing(Duration limit);
[[nodiscard]] Write homing_limits(const AxisImage& image, std::int16_t method);

/// Limits, enable, the motion, a stop where it goes on by itself, disable.
void add_motion(std::vector<Act>& acts, const TryAxis& of, Motion motion);
/// Limits, enable, and turning at `rpm`.
void add_run(std::vector<Act>& acts, const TryAxis& of, double rpm);
/// How long the profile gives this stop.
[[nodiscard]] Duration stop_limit(const model::AxisModel& axis, Command stop);

}  // namespace axisgate::commands
