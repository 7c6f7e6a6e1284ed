#include "gateway/drive/motion.hpp"

#include <cassert>

namespace axisgate::drive {
namespace {

// A reference bit may still stand from the homing before, and no sheet says when it falls: homing counts as attained when the
// bit is set and the axis stands, this long after the start at the earliest.
constexpr Duration kHomingSettle = std::chrono::milliseconds(500);

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

// Stops ---------------------------------------------------------------------------------------------------------------

void Motion::stop(bool latch) {
  end(MotionState::aborted);
  stopping_ = true;
  if (latch) latched_ = true;
  unlatch_armed_ = false;
}

Motion::Pass Motion::pass(Request402 request) const {
  if (!latched_) return Pass::passes;
  switch (request) {
    case Request402::disable_voltage:
    case Request402::quick_stop:
    case Request402::shutdown:
    case Request402::switch_on:
      return Pass::passes;
    case Request402::enable_operation:
      return unlatch_armed_ ? Pass::passes_and_unlatches : Pass::refused;
    case Request402::other:
      return Pass::refused;
  }
  return Pass::refused;
}

void Motion::passed(Request402 request) {
  if (request == Request402::shutdown || request == Request402::switch_on) unlatch_armed_ = true;
  if (request == Request402::enable_operation && unlatch_armed_) enabled();
}

// What runs -----------------------------------------------------------------------------------------------------------

void Motion::start(MotionKind kind, std::uint16_t id, Instant now, std::uint64_t exchange) {
  assert(kind != MotionKind::none);
  if (kind_ != MotionKind::none) end(MotionState::aborted);
  kind_ = kind;
  state_ = MotionState::active;
  id_ = id;
  started_ = now;
  started_by_ = exchange;
  homing_until_ = kNever;
  raw_run_ = false;
}

void Motion::mode_changed() {
  if (kind_ != MotionKind::none) end(MotionState::aborted);
  raw_run_ = false;
}

// What survives: nothing. A fault, a drive restart, a disable, the loss of the drive and a stop end every motion for good;
// velocity, torque and start are needed anew.
void Motion::end(MotionState how) {
  if (kind_ != MotionKind::none) state_ = how;
  kind_ = MotionKind::none;
  homing_until_ = kNever;
  raw_run_ = false;
  wanted_[kVelocity].reset();
  wanted_[kTorque].reset();
}

void Motion::observe(const AxisFacts& facts, Duration homing_timeout, Instant now) {
  if (!facts.moving || !facts.reachable) stopping_ = false;
  const bool newly_lost = (facts.faulted() && !was_faulted_) || (!facts.reachable && was_reachable_);
  was_faulted_ = facts.faulted();
  was_reachable_ = facts.reachable;
  if (!facts.reachable || !facts.enabled()) {
    // Targets written while it is disabled or faulted are kept for the start that follows: only the change ends things.
    if (newly_lost || kind_ != MotionKind::none || raw_run_) end(MotionState::failed);
    return;
  }
  const bool seen_after_start = facts.statusword_exchange > started_by_;
  if (kind_ == MotionKind::discrete && seen_after_start && facts.target_reached && !target_reached_masked_) {
    kind_ = MotionKind::none;
    state_ = MotionState::completed;
  }
  if (kind_ == MotionKind::homing && seen_after_start && !target_reached_masked_) {
    if (homing_until_ == kNever) homing_until_ = started_ + homing_timeout;
    if (facts.homing_failed) {
      end(MotionState::failed);
    } else if (facts.reference && !facts.moving && now - started_ >= kHomingSettle) {
      kind_ = MotionKind::none;
      homing_until_ = kNever;
      state_ = MotionState::completed;
    } else if (now >= homing_until_) {
      end(MotionState::failed);
      homing_timed_out_ = true;
    }
  }
}

bool Motion::take_homing_timeout() {
  const bool out = homing_timed_out_;
  homing_timed_out_ = false;
  return out;
}

AxisState Motion::axis_state(const AxisFacts& facts) const {
  if (facts.faulted()) return AxisState::error_stop;
  if (latched_ || facts.state == State402::quick_stop_active || (stopping_ && facts.moving)) return AxisState::stopping;
  if (!facts.enabled()) return AxisState::disabled;
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
  return raw_run_ && facts.moving ? AxisState::continuous_motion : AxisState::standstill;
}

// Set-points ----------------------------------------------------------------------------------------------------------

void Motion::want(Quantity target, std::int64_t value) {
  if (const auto t = target_of(target)) wanted_[*t] = value;
}

std::optional<std::int64_t> Motion::wanted(Quantity target) const {
  const auto t = target_of(target);
  return t ? wanted_[*t] : std::nullopt;
}

bool Motion::target_acts_now(Quantity target, const AxisFacts& facts, bool held_back) const {
  if (latched_) return false;  // kept, not sent
  switch (target) {
    case Quantity::target_position:
      // In modes 7 and 8 the target is the demand of every cycle; elsewhere a write must not disturb or start a move.
      if (facts.mode == 7 || facts.mode == 8) return true;
      return !held_back && kind_ != MotionKind::discrete;
    case Quantity::target_velocity:
      return !facts.enabled() || kind_ == MotionKind::velocity || raw_run_;
    case Quantity::target_torque:
      return !facts.enabled() || kind_ == MotionKind::torque || raw_run_;
    default:
      return true;
  }
}

}  // namespace axisgate::drive
