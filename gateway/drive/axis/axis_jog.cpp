// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/axis_jog.hpp"

#include <algorithm>
#include <cstdlib>

#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {

// A jog is a run at the jog velocity that needs its button: what the drive is told is the same.
Errc AxisJog::begin(WriteBatch& batch, Duration cycle) {
  const model::Binding* velocity = core_.model.binding(Quantity::target_velocity);
  if (velocity == nullptr || !core_.model.command(Command::run_velocity)) return Errc::not_supported;
  const Command direction = batch.command;
  const auto speed = static_cast<std::int64_t>(image_.jog_velocity);
  const std::int64_t signed_speed = direction == Command::jog_forward ? speed : -speed;
  if (speed == 0 || !velocity->limits.holds(signed_speed)) return Errc::bad_value;
  // At its full speed: what is pressed close to the limit must end before it as well.
  const auto way = travel(signed_speed);
  if (way && time_left(*way, direction) <= 2 * usual_gap(cycle)) return Errc::state_unsuitable;
  // The speed is the button's: refused with it, and no target that a later start could use.
  batch.setpoints.push_back({.quantity = Quantity::target_velocity, .value = signed_speed, .with_command = true});
  batch.command = Command::run_velocity;
  batch.jogs = true;
  jog_.start(direction, batch.client, core_.turn.now, core_.model.jog_timeout, core_.motion.record().accepted());
  waits_ = true;
  return Errc::ok;
}

// Nobody has seen it move yet: of a position that is polled, the poll cycle as it is; of one that its drive sends as
// soon as it changes, a moment.
Duration AxisJog::usual_gap(Duration cycle) const {
  constexpr Duration kSent = std::chrono::milliseconds(50), kLeast = std::chrono::milliseconds(20);
  const bool sent = core_.store.period(core_.model.binding(Quantity::position_actual)->object) > Duration{};
  return sent ? kSent : std::max(cycle, kLeast);
}

std::optional<JogTravel> AxisJog::travel(std::int64_t velocity) const {
  const model::Binding* target = core_.model.binding(Quantity::target_position);
  const model::Binding* actual = core_.model.binding(Quantity::position_actual);
  if (!core_.homed || target == nullptr || actual == nullptr || actual->object == model::kNoObject) return std::nullopt;
  // What its register cannot show lies beyond the limits all the same.
  const ObjectState& state = core_.store[actual->object];
  const auto position = state.known ? actual->to_register_or_bound(state.number) : std::nullopt;
  if (!position) return std::nullopt;
  return JogTravel{.position = *position,
                   .velocity = velocity,
                   .deceleration = core_.value(Quantity::profile_deceleration),
                   .units_per_rev = core_.model.units_per_rev,
                   .limits = position_range(core_)};
}

// A halt waits for what is on the wire: as long as the position was not heard of, at least once. The position counts
// from when it was sampled, and of an axis that stood until now from its start.
Instant AxisJog::limit_due() const {
  if (!jog_.active() || waits_ || !core_.reachable()) return kNever;
  const std::int64_t shown = std::llabs(core_.value(Quantity::velocity_actual).value_or(0));
  const auto way = travel(std::max<std::int64_t>(shown, image_.jog_velocity));
  if (!way) return kNever;
  return std::max(position_at_, started_) + time_left(*way, jog_.direction()) - position_gap_;
}

void AxisJog::observe(bool waits, Duration cycle) {
  waits_ = waits;
  const model::Binding* position = core_.model.binding(Quantity::position_actual);
  if (position != nullptr && position->object != model::kNoObject) {
    const Instant newest = core_.store[position->object].sent_at;
    if (!jog_.active() || waits_) {
      started_ = core_.turn.now;
      position_gap_ = usual_gap(cycle);
    } else if (newest > position_at_) {
      // The longest one counts, for some samples more.
      position_gap_ = std::max(newest - std::max(position_at_, started_), position_gap_ / 2);
    }
    position_at_ = std::max(position_at_, newest);
  }
  ended_without_halt_ = ended_without_halt_ && core_.motion.running() == MotionKind::none;
  if (!jog_.active()) return;
  if (!core_.reachable()) return jog_.carry();
  const bool goes_on = jog_.carried() && core_.state().enabled();
  if (waits_ || goes_on || core_.motion.running() == MotionKind::velocity) return;
  jog_.end();  // a fault, a stop, or another command: only a new press jogs again
  ended_without_halt_ = true;
}

bool AxisJog::finished(const Pending& pending, Errc code) {
  const bool unknown = command_result(code) == CommandResult::outcome_unknown;
  const bool never_sent = code != Errc::ok && !pending.command_sequence->begun() && !core_.reachable();
  if (pending.jogs && unknown)
    jog_.carry();
  else if (pending.jogs && never_sent)
    jog_.end();
  if (pending.ends_jog == 0) return false;
  const bool this_jog = pending.ends_jog == jog_.pressed();
  if (code == Errc::ok && this_jog) jog_.end();
  return code != Errc::ok && !pending.stopped_by && (this_jog || !jog_.active()) && runs_unwatched();
}

// The mode of a jog was taken from it.
bool AxisJog::runs_unwatched() const {
  const AxisFacts facts = core_.facts();
  return facts.enabled() && facts.moving && core_.motion.running() == MotionKind::none &&
         core_.motion.axis_state(facts) != AxisState::stopping;
}

// A gateway that died has told nobody that a button was held, and what runs since before may be its jog. So may what
// another master has let go on since a jog has ended without a halt. Whoever lets a button go means it. The iD286pro
// does not tell in which mode it runs, nor does a Keya on CANopen.
bool AxisJog::may_be_jog() const {
  const AxisFacts facts = core_.facts();
  if (ended_without_halt_ && runs_unwatched()) return true;
  if (!core_.motion.found_at_start() || !facts.enabled()) return false;
  const bool tells_mode = !core_.is_virtual() || (!core_.model.virtual_axis->gate_only && facts.mode != 0);
  return tells_mode ? core_.motion.goes_on(Quantity::target_velocity, facts) : facts.moving;
}

}  // namespace axisgate::drive
