// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/motion/motion.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace axisgate::drive {
namespace {

// A reference bit may still stand from the homing before, and no sheet says when it falls: homing counts as attained
// when the bit is set and the axis stands, this long after the start at the earliest.
constexpr Duration kHomingSettle = std::chrono::milliseconds(500);
// How long a drive that does not acknowledge a set-point may take to show that it moves. A move to where the axis
// stands already shows nothing: it counts as done after this.
constexpr Duration kStartShows = std::chrono::milliseconds(500);
// At the end of a motion the position is read next. A drive that puts it off is not waited for longer: what is shown
// then carries its age. (Not the velocity: a drive may tell it late, see velocity_lag.)
constexpr Duration kPositionComes = std::chrono::milliseconds(500);

enum Target : std::size_t { kPosition, kVelocity, kTorque };

std::optional<Target> target_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::target_position:
      return kPosition;
    case Quantity::target_velocity:
      return kVelocity;
    case Quantity::target_torque:
      return kTorque;
    default:
      return std::nullopt;
  }
}

}  // namespace

bool is_continuous(const AxisFacts& facts) { return model::is_continuous(facts.mode) || facts.own_velocity_mode; }

std::optional<Quantity> followed_target(const AxisFacts& facts) {
  if (!is_continuous(facts)) return std::nullopt;
  return facts.mode == 4 || facts.mode == 10 ? Quantity::target_torque : Quantity::target_velocity;
}

// Stops -------------------------------------------------------------------------------------------------------------

void Motion::stop(bool latch, Instant now, std::optional<AxisRecord::Point> at) {
  // What stood, and was not being started, stands: no sample of it is of before.
  const bool stood = rests_ && kind_ == MotionKind::none && !raw_run_ && !target_reached_masked_;
  end(MotionState::aborted);
  record_.stop(at ? *at : record_.accepted());
  sightings_.asked();
  if (!stood) {
    stopping_ = true;
    settled_from_ = now + velocity_lag_;
  }
  if (latch) latched_ = true;
  unlatch_armed_ = false;
}

Motion::Pass Motion::pass(model::Request402 request) const {
  if (!latched_) return Pass::passes;
  switch (request) {
    case model::Request402::disable_voltage:
    case model::Request402::quick_stop:
    case model::Request402::shutdown:
    case model::Request402::switch_on:
      return Pass::passes;
    case model::Request402::enable_operation:
      return unlatch_armed_ ? Pass::passes_and_unlatches : Pass::refused;
    case model::Request402::other:
      return Pass::refused;
  }
  return Pass::refused;
}

void Motion::passed(model::Request402 request) {
  if (request == model::Request402::shutdown || request == model::Request402::switch_on) unlatch_armed_ = true;
  if (request == model::Request402::enable_operation && unlatch_armed_) enabled();
}

// What runs ---------------------------------------------------------------------------------------------------------

void Motion::start(MotionKind kind, std::uint16_t id, Instant now, std::uint64_t exchange) {
  assert(kind != MotionKind::none);
  // A motion replaced by another one is aborted, but nothing ends "for good" by it: velocity and torque stay as asked.
  kind_ = kind;
  state_ = MotionState::active;
  id_ = id;
  started_ = now;
  settled_from_ = now + velocity_lag_;
  started_by_ = exchange;
  homing_until_ = kNever;
  ended_by_.reset();
  sightings_.asked();
  raw_run_ = arrived_ = false;
  stopping_ = false;
  awaits_fall_ = kind == MotionKind::discrete && !acknowledges_;
  if (kind == MotionKind::velocity || kind == MotionKind::torque) mark_targets(true);
}

void Motion::run_raw(bool by_enable) {
  raw_run_ = true;
  if (by_enable) mark_targets(true);
}

void Motion::owner_changed() {
  const bool follows = kind_ == MotionKind::velocity || kind_ == MotionKind::torque || raw_run_;
  if (!follows) mark_targets(false);
}

void Motion::mark_targets(bool fresh) {
  for (const Target target : {kVelocity, kTorque})
    if (wanted_[target]) wanted_[target]->fresh = fresh;
}

void Motion::mode_changed() {
  if (kind_ != MotionKind::none) state_ = ended_by_ ? MotionState::completed : MotionState::aborted;
  kind_ = MotionKind::none;
  ended_by_.reset();
  raw_run_ = false;
  sightings_.asked();
}

// What survives: nothing. A fault, a drive restart, a disable, the loss of the drive and a stop end every motion for
// good; velocity, torque and start are needed anew.
void Motion::end(MotionState how) {
  // What was at its target before has been completed, whatever comes before its position is read.
  if (kind_ != MotionKind::none) state_ = ended_by_ ? MotionState::completed : how;
  kind_ = MotionKind::none;
  ended_by_.reset();
  homing_until_ = kNever;
  raw_run_ = arrived_ = false;
  wanted_[kVelocity].reset();
  wanted_[kTorque].reset();
  record_.end();
}

void Motion::complete(Instant now) {
  kind_ = MotionKind::none;
  state_ = MotionState::completed;
  arrived_ = true;
  ended_by_.reset();
  homing_until_ = kNever;
  settled_from_ = now + velocity_lag_;
}

void Motion::complete_with_position(const AxisFacts& facts) {
  if (!ended_by_) {
    ended_by_ = facts.statusword_exchange;
    position_until_ = facts.at + kPositionComes;
  }
  const bool newer = facts.position_exchange.value_or(*ended_by_) >= *ended_by_;
  if (newer || facts.at >= position_until_) complete(facts.at);
}

void Motion::observe(const AxisFacts& facts, Duration homing_timeout) {
  seen_ = facts.at;
  const bool rested = std::exchange(rests_, at_rest(facts));
  if (rests_ && !rested) rests_since_ = facts.at;
  acknowledges_ = facts.acknowledges;
  if (!facts.reachable || stands(facts)) stopping_ = false;
  // Targets written while it is disabled or faulted are kept for the start that follows: only the change ends things.
  const Sightings::Changes changes = sightings_.see(facts);
  if (changes.faulted) record_.faulted();
  if (changes.lost) record_.lost();
  if (!facts.enabled()) {
    // A start is given to an enabled axis alone. A raw 15 is what enables it: the statusword from before it, and those
    // of the time that the drive needs, end nothing.
    if (changes.any() || kind_ != MotionKind::none) end(MotionState::failed);
    return;
  }
  const bool seen_after_start = facts.statusword_exchange > started_by_ && !target_reached_masked_;
  if (awaits_fall_ && seen_after_start &&
      (!facts.target_reached || (stands(facts) && facts.at - started_ >= kStartShows)))
    awaits_fall_ = false;
  if (kind_ == MotionKind::discrete && seen_after_start) {
    if (facts.target_reached && !awaits_fall_) {
      complete_with_position(facts);
    } else {
      ended_by_.reset();  // it has left the window again
      if (facts.motion_failed) end(MotionState::failed);
    }
  }
  if (kind_ == MotionKind::velocity && seen_after_start && facts.motion_failed) end(MotionState::failed);
  if (kind_ == MotionKind::homing && seen_after_start) observe_homing(facts, homing_timeout);
}

bool Motion::end_wants_sample(const AxisFacts& facts) const {
  if (facts.statusword_exchange > started_by_ || !facts.enabled()) return false;
  if (kind_ == MotionKind::discrete) return facts.target_reached;
  return kind_ == MotionKind::homing && (facts.reference || facts.homing_failed);
}

void Motion::observe_homing(const AxisFacts& facts, Duration timeout) {
  homing_until_ = started_ + timeout;
  if (facts.homing_failed) {
    end(MotionState::failed);
  } else if (facts.reference && stands(facts) && facts.at - started_ >= kHomingSettle) {
    complete_with_position(facts);
  } else if (facts.at >= homing_until_) {
    end(MotionState::failed);
    homing_timed_out_ = true;
  } else {
    ended_by_.reset();
  }
}

// Values that come by TPDO come on change: what time alone decides must not wait for one.
Instant Motion::deadline() const {
  Instant next = kNever;
  const auto at = [&](Instant instant) {
    if (instant > seen_) next = std::min(next, instant);
  };
  at(settled_from_);
  if (ended_by_) at(position_until_);
  if (awaits_fall_ && kind_ == MotionKind::discrete) at(started_ + kStartShows);
  if (kind_ != MotionKind::homing) return next;
  at(started_ + kHomingSettle);
  at(homing_until_);
  return next;
}

bool Motion::take_homing_timeout() {
  const bool out = homing_timed_out_;
  homing_timed_out_ = false;
  return out;
}

bool Motion::at_rest(const AxisFacts& facts) const {
  // What follows a velocity or torque turns, or is about to: a raw run's sampled velocity may be of before.
  if (kind_ != MotionKind::none || facts.follows) return false;
  // In mode 1 the drive itself says so, before the sampled velocity does; but not of a stop, of which some show bit 10
  // while they still slow down.
  if (facts.mode == 1 && facts.enabled() && facts.target_reached && !stopping_) return true;
  // Its motion has ended where it should: the sampled velocity may be of before.
  if (arrived_ && facts.moving_at.value_or(facts.at) < settled_from_) return true;
  return stands(facts);
}

bool Motion::stands(const AxisFacts& facts) const {
  return !facts.moving && facts.moving_at.value_or(facts.at) >= settled_from_;
}

bool Motion::rest_wants_sample(const AxisFacts& facts) const {
  return stopping_ && facts.at >= settled_from_ && facts.moving_at.value_or(facts.at) < settled_from_;
}

AxisState Motion::axis_state(const AxisFacts& facts) const {
  if (!facts.reachable) return AxisState::unknown;
  if (facts.faulted()) return AxisState::error_stop;
  if (latched_ || facts.state == model::State402::quick_stop_active) return AxisState::stopping;
  if (!facts.enabled()) return AxisState::disabled;  // it may coast: nothing of ours stops it any more
  if (at_rest(facts)) return AxisState::standstill;
  // A raw run that was begun since is no stop, although the axis was never seen to stand between the two.
  if (stopping_ && !raw_run_) return AxisState::stopping;
  switch (kind_) {
    case MotionKind::discrete:
      return AxisState::discrete_motion;
    case MotionKind::homing:
      return AxisState::homing;
    case MotionKind::velocity:
    case MotionKind::torque:
      return AxisState::continuous_motion;
    case MotionKind::none:
      break;
  }
  // It moves, or may, without a start of ours: found running, run in a raw mode, or by a start whose outcome is
  // unknown.
  if (is_continuous(facts)) return AxisState::continuous_motion;
  return facts.mode == 6 ? AxisState::homing : AxisState::discrete_motion;
}

// Set-points ----------------------------------------------------------------------------------------------------------

void Motion::want(Quantity target, Wanted wanted) {
  if (const auto t = target_of(target)) wanted_[*t] = wanted;
}

std::optional<Wanted> Motion::wanted(Quantity target) const {
  const auto t = target_of(target);
  return t ? wanted_[*t] : std::nullopt;
}

bool Motion::move_under_way(const AxisFacts& facts) const {
  if (kind_ != MotionKind::none) return kind_ == MotionKind::discrete;
  return facts.enabled() && facts.moving && facts.at >= settled_from_ && !is_continuous(facts);
}

// It was started before anybody could see it: its target acts as that of any run. What stands is not told from what
// has ended, and needs a start.
bool Motion::goes_on(Quantity target, const AxisFacts& facts) const {
  const bool fits = followed_target(facts) == target;
  return sightings_.found() && fits && kind_ == MotionKind::none && !raw_run_ && !latched_ && facts.enabled() &&
         facts.follows;
}

bool Motion::target_acts_now(Quantity target, const AxisFacts& facts, bool held_back) const {
  const auto t = target_of(target);
  if (!t) return true;         // a parameter
  if (latched_) return false;  // kept, not sent
  if (goes_on(target, facts)) return true;
  switch (*t) {
    case kPosition:
      // In modes 7 and 8 the target is the demand of every cycle; elsewhere a write must not disturb or start a move.
      if (facts.mode == 7 || facts.mode == 8) return true;
      return !held_back && !move_under_way(facts);
    case kVelocity:
      return !facts.enabled() || kind_ == MotionKind::velocity || raw_run_;
    case kTorque:
      return !facts.enabled() || kind_ == MotionKind::torque || raw_run_;
  }
  return false;
}

}  // namespace axisgate::drive
