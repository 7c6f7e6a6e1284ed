// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/plan/try_acts.hpp"

#include <algorithm>

#include "gateway/commands/try/plan/try_motions.hpp"

namespace axisgate::commands {
namespace {

constexpr Duration kHold = std::chrono::seconds(2);

void add_torque(std::vector<Act>& acts, const TryAxis& of) {
  acts.emplace_back(Write{.command = Command::enable});
  acts.emplace_back(Hold{kHold});
  acts.emplace_back(Write{.command = Command::disable});
  if (!of.image.supports(Quantity::position_actual)) acts.emplace_back(Question{"did the shaft stay where it was"});
}

void add_moves(std::vector<Act>& acts, const TryAxis& of) {
  if (has_moves(of.image)) {
    add_motion(acts, of, move_by(of.image, 0.05, kSlowRpm));
    acts.emplace_back(Question{"did the shaft turn a little and stop"});
    add_motion(acts, of, move_by(of.image, 1, kSlowRpm));
    acts.emplace_back(Question{"was it one turn"});
    add_motion(acts, of, move_by(of.image, -1, kSlowRpm));
  }
  add_motion(acts, of, turn_at(of.image, kRunRpm, std::chrono::seconds(2)));
}

void add_stops(std::vector<Act>& acts, const TryAxis& of) {
  double rpm = kRunRpm;
  for (const Command stop : {Command::quick_stop, Command::halt, Command::disable}) {
    if (!of.image.supports(stop)) continue;
    add_run(acts, of, rpm);
    acts.emplace_back(Stop{stop, stop_limit(of.axis, stop)});
    acts.emplace_back(Write{.command = Command::disable});
    if (!of.image.supports(Quantity::position_actual)) acts.emplace_back(Question{"does the shaft stand"});
    rpm = -rpm;
  }
}

void add_loss(std::vector<Act>& acts, const TryAxis& of) {
  constexpr Duration kRampDown = std::chrono::milliseconds(1000);
  add_run(acts, of, kRunRpm);
  acts.emplace_back(Withhold{of.drive.loss_after, of.drive.loss_after + kRampDown});
  if (!of.image.supports(Quantity::position_actual)) acts.emplace_back(Question{"did the shaft stand by itself"});
  acts.emplace_back(Write{.command = Command::disable, .may_fail = true});
  if (of.image.supports(Command::fault_reset))
    acts.emplace_back(Write{.command = Command::fault_reset, .may_fail = true});
}

void add_home(std::vector<Act>& acts, const TryAxis& of) {
  acts.emplace_back(homing_limits(of.image, of.homing_method));
  acts.emplace_back(Write{.command = Command::enable});
  acts.emplace_back(homing(of.axis.homing_timeout));
  acts.emplace_back(Write{.command = Command::disable});
}

/// Why nothing may be moved by this profile: what the drive's units are is not known.
std::string unknown_units(const TryAxis& of) {
  for (const Quantity quantity : {Quantity::position_actual, Quantity::velocity_actual}) {
    if (!of.image.supports(quantity) || of.image[quantity].valid) continue;
    return std::string(row(quantity).name) +
           " has no value: a constant that its unit needs is not known, or the drive does not answer it";
  }
  return {};
}

std::string obstacle(TryStep step, const TryAxis& of) {
  if (step == TryStep::turn && !of.image.supports(Quantity::position_actual)) return "the drive tells no position";
  if (step <= TryStep::turn) return {};
  if (!of.image.supports(Command::enable)) return "the profile has no enable";
  const std::string open = "an open question of the profile forbids ";
  if (step == TryStep::torque)
    return std::ranges::find(of.open_before, "enable") == of.open_before.end() ? "" : open + "enable";
  if (!of.open_before.empty()) return open + of.open_before.front();
  if (std::string why = unknown_units(of); !why.empty()) return why;
  if (step == TryStep::home) return of.image.supports(Command::home) ? "" : "the profile has no homing";
  if (!of.image.supports(Command::run_velocity) && !has_moves(of.image)) return "the profile has no motion to try";
  if (step != TryStep::loss) return {};
  if (!model::is_canopen(of.drive) || of.drive.canopen.own_heartbeat == Duration{})
    return "the profile does not say that the drive watches the gateway's heartbeats: see axisgate check";
  return of.drive.loss_after == Duration{} ? "the profile does not say how soon it stops" : "";
}

}  // namespace

Acts acts_of(TryStep step, const TryAxis& of) {
  Acts out{.why_not = obstacle(step, of)};
  if (!out.why_not.empty()) return out;
  if (step == TryStep::turn) {
    out.acts.emplace_back(TurnByPerson{});
    return out;
  }
  out.acts.emplace_back(Consent{});
  if (step == TryStep::torque) add_torque(out.acts, of);
  if (step == TryStep::moves) add_moves(out.acts, of);
  if (step == TryStep::stops) add_stops(out.acts, of);
  if (step == TryStep::loss) add_loss(out.acts, of);
  if (step == TryStep::home) add_home(out.acts, of);
  return out;
}

}  // namespace axisgate::commands
