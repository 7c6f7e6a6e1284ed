// SPDX-License-Identifier: Apache-2.0
// A jog of an axis (design 3.4): how it begins, and the halt that must come before a position limit.
#include <algorithm>
#include <cstdlib>
#include <utility>

#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

bool outcome_unknown(Errc code) { return command_result(code) == CommandResult::outcome_unknown; }

}  // namespace

// A jog is a run at the jog velocity that needs its button: what the drive is told is the same.
Errc Axis::begin_jog(WriteBatch& batch) {
  const model::Binding* velocity = core_.model.binding(Quantity::target_velocity);
  if (velocity == nullptr || !core_.model.command(Command::run_velocity)) return Errc::not_supported;
  const Command direction = batch.command;
  const auto speed = static_cast<std::int64_t>(image_.jog_velocity);
  const std::int64_t signed_speed = direction == Command::jog_forward ? speed : -speed;
  if (speed == 0 || !velocity->limits.holds(signed_speed)) return Errc::bad_value;
  // At its full speed: what is pressed close to the limit must end before it as well.
  const auto travel = jog_travel(signed_speed);
  if (travel && time_left(*travel, direction) <= 2 * usual_position_gap()) return Errc::state_unsuitable;
  // The speed is the button's: refused with it, and no target that a later start could use.
  batch.setpoints.push_back({.quantity = Quantity::target_velocity, .value = signed_speed, .with_command = true});
  batch.command = Command::run_velocity;
  batch.jogs = true;
  if (!jog_.active()) core_.velocity_beside_jog = core_.motion.wanted(Quantity::target_velocity).value_or(Wanted{});
  jog_.start(direction, batch.client, core_.turn.now, core_.model.jog_timeout, core_.motion.record().accepted());
  return Errc::ok;
}

// Nobody has seen it move yet: of a position that is polled, the poll cycle as it is; of one that its drive sends as
// soon as it changes, a moment.
Duration Axis::usual_position_gap() const {
  constexpr Duration kSent = std::chrono::milliseconds(50), kLeast = std::chrono::milliseconds(20);
  const bool sent = core_.store.period(core_.model.binding(Quantity::position_actual)->object) > Duration{};
  return sent ? kSent : std::max(shown_.cycle(), kLeast);
}

std::optional<JogTravel> Axis::jog_travel(std::int64_t velocity) const {
  const model::Binding* target = core_.model.binding(Quantity::target_position);
  const model::Binding* actual = core_.model.binding(Quantity::position_actual);
  if (!core_.homed || target == nullptr || actual == nullptr || actual->object == model::kNoObject) return std::nullopt;
  // What its register cannot show lies beyond the limits all the same.
  const ObjectState& state = core_.store[actual->object];
  const auto position = state.known ? actual->to_register_or_bound(state.number) : std::nullopt;
  if (!position) return std::nullopt;
  JogTravel travel;
  travel.position = *position;
  travel.velocity = velocity;
  travel.deceleration = core_.value(Quantity::profile_deceleration);
  travel.units_per_rev = core_.model.units_per_rev;
  travel.limits = position_range(core_);
  return travel;
}

// A halt waits for what is on the wire: as long as the position was not heard of, at least once. The position counts
// from when it was sampled, and of an axis that stood until now from its start.
Instant Axis::jog_limit_due() const {
  if (!jog_.active() || !core_.reachable() || pending_.jogs()) return kNever;
  const std::int64_t shown = std::llabs(core_.value(Quantity::velocity_actual).value_or(0));
  const auto travel = jog_travel(std::max<std::int64_t>(shown, image_.jog_velocity));
  if (!travel) return kNever;
  return std::max(position_at_, jog_started_) + time_left(*travel, jog_.direction()) - position_gap_;
}

void Axis::watch_position() {
  const model::Binding* position = core_.model.binding(Quantity::position_actual);
  if (position == nullptr || position->object == model::kNoObject) return;
  const Instant newest = core_.store[position->object].sent_at;
  if (!jog_.active() || pending_.jogs()) {
    jog_started_ = core_.turn.now;
    position_gap_ = usual_position_gap();
  } else if (newest > position_at_) {
    // The longest one counts, for some samples more.
    position_gap_ = std::max(newest - std::max(position_at_, jog_started_), position_gap_ / 2);
  }
  position_at_ = std::max(position_at_, newest);
}

void Axis::observe_jog() {
  watch_position();
  jog_ended_without_halt_ = jog_ended_without_halt_ && core_.motion.running() == MotionKind::none;
  if (!jog_.active()) return;
  if (!core_.reachable()) {
    jog_.carry();
    return;
  }
  const bool goes_on = jog_.carried() && core_.facts().enabled();
  if (!pending_.jogs() && !goes_on && core_.motion.running() != MotionKind::velocity) {
    end_jog();  // a fault, a stop, or another command: only a new press jogs again
    jog_ended_without_halt_ = true;
    return;
  }
  end_jog_at_limit();
}

void Axis::end_jog_at_limit() {
  if (core_.turn.now >= jog_limit_due()) stop_jog("jog: halted at the position limit");
}

void Axis::note_jog(const Pending& pending, Errc code) {
  if (pending.jogs && outcome_unknown(code))
    jog_.carry();
  else if (pending.jogs && code != Errc::ok && !pending.command_sequence->begun() && !core_.reachable())
    end_jog();
  if (code == Errc::ok && pending.ends_jog != 0 && pending.ends_jog == jog_.pressed()) end_jog();
  const bool no_other_jog = !jog_.active() || pending.ends_jog == jog_.pressed();
  if (code != Errc::ok && pending.ends_jog != 0 && !pending.stopped_by && no_other_jog && runs_unwatched())
    stop_jog("jog: another command has taken its mode and failed: halted");
}

// The mode of a jog was taken from it, so nobody watches its button, and nothing has begun in its place.
bool Axis::runs_unwatched() const {
  const AxisFacts facts = core_.facts();
  return facts.enabled() && facts.moving && core_.motion.running() == MotionKind::none &&
         core_.motion.axis_state(facts) != AxisState::stopping;
}

// What a client has asked for before or beside the jog is the target again; a stop has left none.
void Axis::end_jog() {
  jog_.end();
  if (core_.velocity_beside_jog && core_.motion.wanted(Quantity::target_velocity))
    core_.motion.want(Quantity::target_velocity, *core_.velocity_beside_jog);
  core_.velocity_beside_jog.reset();
}

// Its motor has no other dead man.
void Axis::stop_jog(std::string event_text) {
  end_jog();
  host_.event(image_.number, EventKind::warning, 0, std::move(event_text));
  stop_by_itself(Command::halt, false, [](const BatchResult&) {});
}

void Axis::halt_jog(const std::string& why) {
  if (jog_.active()) stop_jog("jog: " + why + ": halted");
}

}  // namespace axisgate::drive
