// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/plan/try_motions.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::commands {
namespace {

constexpr double kPerRpm = 1000;
constexpr std::int64_t kAcceleration = 600;  // 60 rpm/s
constexpr double kMostRpm = 60;
/// A run must be steady before it is stopped.
constexpr Duration kRunUp = std::chrono::milliseconds(1500);
/// Of a move, beside its way: the ramp, and whatever the drive takes to say that it is there.
constexpr Duration kBesideTheWay = std::chrono::seconds(4);
constexpr double kBeside = 0.2;  // turns

/// Within the axis's limits, or not at all.
void add(Write& write, const AxisImage& image, Quantity quantity, std::int64_t value) {
  if (!image.takes(quantity)) return;
  const Range& limit = image.limits[static_cast<std::size_t>(quantity)];
  if (limit.min > limit.max) return;
  write.setpoints.push_back({quantity, std::clamp(value, limit.min, limit.max)});
}

std::int64_t in_registers(double rpm) { return std::llround(rpm * kPerRpm); }

double turns_in(double rpm, Duration time) { return std::abs(rpm) / kSecondsPerMinute * in_seconds(time); }

Duration way_time(double turns, double rpm) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(std::abs(turns / rpm) * kSecondsPerMinute));
}

}  // namespace

Write limits_at(const AxisImage& image, double rpm) {
  Write out;
  add(out, image, Quantity::profile_velocity, in_registers(rpm));
  add(out, image, Quantity::profile_acceleration, kAcceleration);
  add(out, image, Quantity::profile_deceleration, kAcceleration);
  add(out, image, Quantity::max_velocity, in_registers(kMostRpm));
  return out;
}

bool has_moves(const AxisImage& image) {
  return image.takes(Quantity::target_position) &&
         (image.supports(Command::move_relative) || image.supports(Command::move_absolute));
}

Motion move_by(const AxisImage& image, double turns, double rpm) {
  const bool relative = image.supports(Command::move_relative);
  const double units = turns * image.units_per_rev.to_double();
  Motion out;
  out.asked = {.kind = MotionAsked::Kind::move,
               .turns = turns,
               .rpm = turns < 0 ? -rpm : rpm,
               .time = way_time(turns, rpm) + kBesideTheWay,
               .most = std::abs(turns) * (1 + MotionCheck::kWithin) + kBeside};
  out.start = {.setpoints = {{Quantity::target_position, std::llround(units)}},
               .command = relative ? Command::move_relative : Command::move_absolute};
  return out;
}

Motion turn_at(const AxisImage& image, double rpm, Duration time) {
  constexpr double kLonger = 4;
  Motion out;
  if (image.supports(Command::run_velocity)) {
    out.start = {.setpoints = {{Quantity::target_velocity, in_registers(rpm)}}, .command = Command::run_velocity};
  } else {
    const double turns = std::copysign(turns_in(rpm, time) * kLonger, rpm);
    out = move_by(image, turns, std::abs(rpm));
  }
  out.asked = {.kind = MotionAsked::Kind::run,
               .rpm = rpm,
               .time = time,
               .most = turns_in(rpm, time) * (1 + MotionCheck::kWithin) + kBeside};
  return out;
}

Motion homing(Duration limit) {
  constexpr double kMostTurns = 20;
  Motion out;
  out.asked = {.kind = MotionAsked::Kind::home, .rpm = kSlowRpm, .time = limit, .most = kMostTurns};
  out.start = {.command = Command::home};
  return out;
}

Write homing_limits(const AxisImage& image, std::int16_t method) {
  Write out = limits_at(image, kSlowRpm);
  add(out, image, Quantity::homing_speed_switch, in_registers(kSlowRpm));
  add(out, image, Quantity::homing_speed_zero, in_registers(kSlowRpm / 2));
  add(out, image, Quantity::homing_acceleration, kAcceleration);
  if (image.takes(Quantity::homing_method)) out.setpoints.push_back({Quantity::homing_method, method});
  std::ranges::sort(out.setpoints, {}, &Setpoint::quantity);
  return out;
}

void add_motion(std::vector<Act>& acts, const TryAxis& of, Motion motion) {
  const bool runs = motion.asked.kind == MotionAsked::Kind::run;
  acts.emplace_back(limits_at(of.image, std::abs(motion.asked.rpm)));
  acts.emplace_back(Write{.command = Command::enable});
  acts.emplace_back(std::move(motion));
  if (runs && of.image.supports(Command::quick_stop))
    acts.emplace_back(Stop{Command::quick_stop, stop_limit(of.axis, Command::quick_stop)});
  acts.emplace_back(Write{.command = Command::disable});
}

void add_run(std::vector<Act>& acts, const TryAxis& of, double rpm) {
  Motion motion = turn_at(of.image, rpm, kRunUp);
  motion.asked.judged = false;
  acts.emplace_back(limits_at(of.image, std::abs(rpm)));
  acts.emplace_back(Write{.command = Command::enable});
  acts.emplace_back(std::move(motion));
}

Duration stop_limit(const model::AxisModel& axis, Command stop) {
  // Without torque a motor coasts: what it drives says how long.
  if (stop == Command::disable) return std::chrono::seconds(10);
  Duration longest = std::chrono::seconds(2);
  const auto look = [&](const model::Steps& steps) {
    for (const model::Step& step : steps)
      if (step.verb == model::Step::Verb::wait) longest = std::max(longest, step.limit);
  };
  if (const auto& command = axis.command(stop)) {
    look(command->steps);
    for (const auto& variant : command->variants) look(variant.steps);
  }
  return longest;
}

}  // namespace axisgate::commands
