// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/motion/motion.hpp"

#include <algorithm>
#include <cassert>

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

}  // namespace

bool is_continuous(const AxisFacts& facts) { return model::is_continuous(facts.mode) || facts.own_velocity_mode; }

std::optional<Quantity> followed_target(const AxisFacts& facts) {
  if (!is_continuous(facts)) return std::nullopt;
  return facts.mode == 4 || facts.mode == 10 ? Quantity::target_torque : Quantity::target_velocity;
}

// Stops -------------------------------------------------------------------------------------------------------------

void Motion::stop(bool latch, Instant now, std::optional<AxisRecord::Point> at) {
  // What stood, and was not being started, stands: no sample of it is of before.
  const bool stood = rests_since_ != kNever && run_.kind == MotionKind::none && !raw_run_ && !target_reached_masked_;
  end(MotionState::aborted);
  record_.stop(at ? *at : record_.accepted());
  sightings_.asked();
  if (!stood) {
    stopping_ = true;
    settled_from_ = now + velocity_lag_;
  }
  if (latch) latch_->set(slot_);
  latch_->disarm();
}

bool StopLatch::passes(model::Request402 request, AxisSlot axis) const {
  if (!latched()) return true;
  if (request == model::Request402::enable_operation) return armed_ && !latched_by_another(axis);
  return request != model::Request402::other;
}

bool StopLatch::passed(model::Request402 request) {
  if (request == model::Request402::shutdown || request == model::Request402::switch_on) armed_ = true;
  return request == model::Request402::enable_operation && armed_;
}

// What runs ---------------------------------------------------------------------------------------------------------

void Motion::start(MotionKind kind, std::uint16_t id, Instant now, std::uint64_t exchange) {
  assert(kind != MotionKind::none);
  // A motion replaced by another one is aborted, but nothing ends "for good" by it: velocity and torque stay as asked.
  run_ = Run{.kind = kind, .state = MotionState::active, .id = id, .since = now, .by = exchange};
  run_.awaits_fall = kind == MotionKind::discrete && !acknowledges_;
  settled_from_ = now + velocity_lag_;
  sightings_.asked();
  raw_run_ = stopping_ = false;
}

void Motion::run_raw(bool by_enable) {
  raw_run_ = true;
  if (by_enable) record_.run();
}

void Motion::owner_changed() {
  if (!follows_target() && !raw_run_) record_.set_aside();
}

void Motion::mode_changed() {
  over(MotionState::aborted);
  raw_run_ = false;
  sightings_.asked();
}

// What was at its target before has been completed, whatever comes before its position is read.
void Motion::over(MotionState how) {
  if (run_.kind != MotionKind::none) run_.state = run_.end ? MotionState::completed : how;
  run_.kind = MotionKind::none;
  run_.end.reset();
  run_.homing_until = kNever;
}

// What survives: nothing. A fault, a drive restart, a disable, the loss of the drive and a stop end every motion for
// good; velocity, torque and start are needed anew.
void Motion::end(MotionState how) {
  over(how);
  raw_run_ = run_.arrived = false;
  record_.end();
}

void Motion::complete(Instant now) {
  over(MotionState::completed);
  run_.arrived = true;
  settled_from_ = now + velocity_lag_;
}

void Motion::complete_with_position(const AxisFacts& facts) {
  if (!run_.end) run_.end = {facts.statusword_exchange, facts.at + kPositionComes};
  const bool newer = facts.position_exchange.value_or(run_.end->exchange) >= run_.end->exchange;
  if (newer || facts.at >= run_.end->until) complete(facts.at);
}

void Motion::observe(const AxisFacts& facts, Duration homing_timeout) {
  seen_ = facts.at;
  acknowledges_ = facts.acknowledges;
  if (!facts.reachable || stands(facts)) stopping_ = false;
  look_for_end(facts, homing_timeout);
  rests_since_ = at_rest(facts) ? std::min(rests_since_, facts.at) : kNever;
}

void Motion::look_for_end(const AxisFacts& facts, Duration homing_timeout) {
  // Targets written while it is disabled or faulted are kept for the start that follows: only the change ends things.
  const Sightings::Changes changes = sightings_.see(facts);
  if (changes.faulted) record_.faulted();
  if (changes.lost) record_.lost();
  if (!facts.enabled()) {
    // A start is given to an enabled axis alone. A raw 15 is what enables it: the statusword from before it, and those
    // of the time that the drive needs, end nothing.
    if (changes.any() || run_.kind != MotionKind::none) end(MotionState::failed);
    return;
  }
  const bool seen_after_start = facts.statusword_exchange > run_.by && !target_reached_masked_;
  if (run_.awaits_fall && seen_after_start &&
      (!facts.target_reached || (stands(facts) && facts.at - run_.since >= kStartShows)))
    run_.awaits_fall = false;
  if (run_.kind == MotionKind::discrete && seen_after_start) {
    if (facts.target_reached && !run_.awaits_fall) {
      complete_with_position(facts);
    } else {
      run_.end.reset();  // it has left the window again
      if (facts.motion_failed) end(MotionState::failed);
    }
  }
  if (run_.kind == MotionKind::velocity && seen_after_start && facts.motion_failed) end(MotionState::failed);
  if (run_.kind == MotionKind::homing && seen_after_start) observe_homing(facts, homing_timeout);
}

bool Motion::end_wants_sample(const AxisFacts& facts) const {
  if (facts.statusword_exchange > run_.by || !facts.enabled()) return false;
  if (run_.kind == MotionKind::discrete) return facts.target_reached;
  return run_.kind == MotionKind::homing && (facts.reference || facts.homing_failed);
}

void Motion::observe_homing(const AxisFacts& facts, Duration timeout) {
  run_.homing_until = run_.since + timeout;
  if (facts.homing_failed) {
    end(MotionState::failed);
  } else if (facts.reference && stands(facts) && facts.at - run_.since >= kHomingSettle) {
    complete_with_position(facts);
  } else if (facts.at >= run_.homing_until) {
    end(MotionState::failed);
    homing_timed_out_ = true;
  } else {
    run_.end.reset();
  }
}

// Values that come by TPDO come on change: what time alone decides must not wait for one.
Instant Motion::deadline() const {
  Instant next = kNever;
  const auto at = [&](Instant instant) {
    if (instant > seen_) next = std::min(next, instant);
  };
  at(settled_from_);
  if (run_.end) at(run_.end->until);
  if (run_.awaits_fall && run_.kind == MotionKind::discrete) at(run_.since + kStartShows);
  if (run_.kind != MotionKind::homing) return next;
  at(run_.since + kHomingSettle);
  at(run_.homing_until);
  return next;
}

bool Motion::at_rest(const AxisFacts& facts) const {
  // What follows a velocity or torque turns, or is about to: a raw run's sampled velocity may be of before.
  if (run_.kind != MotionKind::none || facts.follows) return false;
  // In mode 1 the drive itself says so, before the sampled velocity does; but not of a stop, of which some show bit 10
  // while they still slow down.
  if (facts.mode == 1 && facts.enabled() && facts.target_reached && !stopping_) return true;
  // Its motion has ended where it should: the sampled velocity may be of before.
  if (run_.arrived && facts.moving_at.value_or(facts.at) < settled_from_) return true;
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
  if (latched() || facts.state == model::State402::quick_stop_active) return AxisState::stopping;
  if (!facts.enabled()) return AxisState::disabled;  // it may coast: nothing of ours stops it any more
  if (at_rest(facts)) return AxisState::standstill;
  // A raw run that was begun since is no stop, although the axis was never seen to stand between the two.
  if (stopping_ && !raw_run_) return AxisState::stopping;
  // Or it moves, or may, without a start of ours: found running, run in a raw mode, or by a start whose outcome is
  // unknown.
  const bool ours = run_.kind != MotionKind::none;
  if (ours ? follows_target() : is_continuous(facts)) return AxisState::continuous_motion;
  return (ours ? run_.kind == MotionKind::homing : facts.mode == 6) ? AxisState::homing : AxisState::discrete_motion;
}

// Set-points ----------------------------------------------------------------------------------------------------------

bool Motion::move_under_way(const AxisFacts& facts) const {
  if (run_.kind != MotionKind::none) return run_.kind == MotionKind::discrete;
  return facts.enabled() && facts.moving && facts.at >= settled_from_ && !is_continuous(facts);
}

// It was started before anybody could see it: its target acts as that of any run. What stands is not told from what
// has ended, and needs a start.
bool Motion::goes_on(Quantity target, const AxisFacts& facts) const {
  const bool fits = followed_target(facts) == target;
  return sightings_.found() && fits && run_.kind == MotionKind::none && !raw_run_ && !latched() && facts.enabled() &&
         facts.follows;
}

bool Motion::target_acts_now(Quantity target, const AxisFacts& facts, bool held_back) const {
  const bool follows = target == Quantity::target_velocity || target == Quantity::target_torque;
  if (!follows && target != Quantity::target_position) return true;  // a parameter
  if (latched()) return false;                                       // kept, not sent
  if (goes_on(target, facts)) return true;
  if (follows)
    return !facts.enabled() || raw_run_ ||
           run_.kind == (target == Quantity::target_velocity ? MotionKind::velocity : MotionKind::torque);
  // In modes 7 and 8 the target is the demand of every cycle; elsewhere a write must not disturb or start a move.
  return facts.mode == 7 || facts.mode == 8 || (!held_back && !move_under_way(facts));
}

}  // namespace axisgate::drive
