// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/axis_admission.hpp"

#include <utility>

#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

std::string named_before(const Ownership::ClientPtr& owner) {
  return owner ? " (before: " + owner->name + ")" : std::string();
}

}  // namespace

// --- Who asks --------------------------------------------------------------------------------------------------------

// Reads are free, and stops are open to every operator, without taking the lease. A button that is let go where nothing
// runs asks for nothing.
Errc AxisAdmission::judge(const WriteBatch& batch) const {
  if (reads_alone(batch)) return Errc::ok;
  if (holds_stop(batch) && !batch.claims) return Errc::ok;
  if (batch.command == Command::jog_end || batch.command == Command::end_run) return Errc::ok;
  // While its halt is under way an axis is on its way to its new owner: what the old one asked now would begin behind
  // the halt, under another's lease.
  const bool being_taken = taken_by_ && batch.life && batch.client != *taken_by_;
  if (batch.command == Command::take_over)
    return being_taken ? Errc::not_owner : guard_.ownership().may_take_over(batch.life);
  if (asks_nothing(batch) && !batch.jog_again) return Errc::ok;
  if (being_taken) return Errc::not_owner;
  return guard_.ownership().judge(batch.life, batch.claims);
}

Errc AxisAdmission::judge_again(Pending& pending) {
  const WriteBatch& batch = pending.batch();
  const bool claims = pending.claims_when_begun && !accepts_nothing(core_, batch);
  const bool begins =
      !pending.command_sequence->begun() && !pending.command_sequence->is_stop() && asks_to_begin(batch);
  if (!claims && !(begins && is_anothers(batch))) return Errc::ok;
  pending.claims_when_begun = false;
  const Errc code = judge(batch);
  if (code == Errc::ok && claims) claim(batch);
  return code;
}

void AxisAdmission::claim(const WriteBatch& batch) {
  if (batch.jog_velocity) image_.jog_velocity = *batch.jog_velocity;
  if (batch.claims || waits_for(batch)) make_owner(batch);
}

bool AxisAdmission::waits_for(const WriteBatch& batch) const {
  return batch.reclaims && guard_.ownership().waits_for(batch.life, batch.all_zero);
}

void AxisAdmission::make_owner(const WriteBatch& batch) {
  const auto before = guard_.ownership().owner();
  const Ownership::Taken taken = guard_.ownership().take(batch.life, core_.turn.now);
  if (taken == Ownership::Taken::nothing) return;
  owner_ = batch.client;
  if (taken != Ownership::Taken::orphan && taken != Ownership::Taken::same_origin_and_role)
    core_.motion.owner_changed();
  if (guard_.jog().client() != batch.client) guard_.end_jog("another client has taken the axis");
  events_.owner(drive::text(taken, *batch.life) + named_before(before));
}

void AxisAdmission::see_owner() {
  if (core_.model.shares.empty()) return;
  const auto& owner = guard_.ownership().owner();
  if (!owner || std::exchange(owner_, owner->id) == owner->id) return;
  core_.motion.owner_changed();
  if (guard_.jog().client() != owner->id) guard_.end_jog("another client has taken the axis");
}

// What a connection that has ended has asked for is its successor's, too.
bool AxisAdmission::is_anothers(const WriteBatch& batch) const {
  const auto& owner = guard_.ownership().owner();
  return owner && batch.life && owner->id != batch.client &&
         (batch.life->strength || !same_origin_and_role(*owner, *batch.life));
}

bool AxisAdmission::must_halt_for(const WriteBatch& batch, const PendingBatches& pending) const {
  const auto& owner = guard_.ownership().owner();
  return owner && batch.life && owner->id != batch.life->id && (may_be_enabled() || pending.writes());
}

Errc AxisAdmission::release(const WriteBatch& batch, bool enables) {
  const auto owner = guard_.ownership().owner();
  const Errc code = guard_.ownership().release(batch.life, may_be_enabled() || enables, core_.turn.now);
  if (code != Errc::ok) return code;
  guard_.end_jog("its owner has released the axis");
  if (!owner) return code;
  const bool enabled = guard_.ownership().until() != kNever;
  events_.owner(owner->name + (enabled ? " has released the axis, which is enabled: open to every operator for now"
                                       : " has released the axis"));
  return code;
}

// --- What stands against it ------------------------------------------------------------------------------------------

bool AxisAdmission::stop_comes_first(const WriteBatch& batch) const {
  const LinkState link = core_.turn.link;
  const bool back = link != LinkState::offline && link != LinkState::link_down;
  return guard_.owed().gates() && back && !reads_alone(batch) && !stops_at_most(batch);
}

Errc AxisAdmission::link_admits(bool stop, bool reads_alone) const {
  const bool unlike_profile = core_.alarm(AxisAlarm::profile_mismatch);
  const bool another = unlike_profile || core_.alarm(AxisAlarm::identity_mismatch);
  switch (core_.turn.link) {
    case LinkState::online:
    case LinkState::suspect:
      // A drive that is not the configured one is read-only.
      return another && !stop && !reads_alone ? Errc::identity_mismatch : Errc::ok;
    case LinkState::setup:
    case LinkState::unknown:
      // Nothing is known of it yet, and it may be running: a stop is worth its try. What a device is that refuses what
      // its profile needs, a person finds out by reading.
      return stop || (unlike_profile && reads_alone) ? Errc::ok : Errc::still_in_setup;
    case LinkState::offline:
    case LinkState::link_down:
      break;
  }
  return Errc::offline;
}

// Out of sight, or found running, nobody knows whether it is a run of ours that goes on: a stop too many is the smaller
// harm.
bool AxisAdmission::may_run(const PendingBatches& pending) const {
  if (pending.runs(core_) || core_.motion.running() == MotionKind::velocity || core_.motion.runs_raw()) return true;
  const AxisFacts facts = core_.facts();
  const bool continuous = facts.mode == 0 || is_continuous(facts);  // 0: it is not known
  return core_.reachable() ? facts.enabled() && facts.moving && continuous : may_be_enabled();
}

// Design 3.3 Zeros: "the owner's target_velocity or target_torque 0 acts while a run is on". One that still waits for
// the wire will be; and whose connection has ended and come back is the owner by this very write.
void AxisAdmission::add_zero_speed(WriteBatch& batch, const PendingBatches& pending) const {
  const Ownership& ownership = guard_.ownership();
  const bool owns = ownership.rules().on && (ownership.is_owner(batch.client) || waits_for(batch));
  if (!owns || (!pending.runs(core_) && image_.axis_state != AxisState::continuous_motion)) return;
  for (const Quantity target : {Quantity::target_velocity, Quantity::target_torque})
    if (image_.takes(target)) batch.setpoints.push_back({target, 0});
}

// --- Which rows ask --------------------------------------------------------------------------------------------------

bool AxisAdmission::holds(Quantity quantity, std::int64_t value) const {
  if (quantity == Quantity::mode)
    return core_.model.mode != model::kNoObject && core_.store[core_.model.mode].cached &&
           core_.mode_in_force() == value;
  const model::Binding* binding = core_.model.binding(quantity);
  if (binding == nullptr || binding->object == model::kNoObject || !core_.store[binding->object].cached) return false;
  return core_.value(quantity) == value;
}

bool AxisAdmission::owner_asks(ClientId client, Quantity quantity, std::int64_t value) const {
  const Ownership& ownership = guard_.ownership();
  if (!ownership.rules().on || !ownership.is_owner(client) || !image_.reachable()) return false;
  const auto last = core_.asked.accepted(quantity);
  if (last) return *last != value;
  // Nobody has asked for anything since the drive came up: what it holds is what counts; but a velocity or torque that
  // has lapsed is needed anew.
  const bool lapses = quantity == Quantity::target_velocity || quantity == Quantity::target_torque;
  return lapses || !holds(quantity, value);
}

}  // namespace axisgate::drive
