// SPDX-License-Identifier: Apache-2.0
// What the write batches that wait for the wire say of each other: which of them waits for a stop, and whether a run is
// on its way.
#include <algorithm>

#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
// A stop ramps down, and still shows enabled: what would enable or start comes when it is over. What came later than a
// stop's own set-points comes after them (3.3, the order of one axis).
bool Axis::waits_for_stop(const Pending& pending) const {
  return (stopping() && asks_to_begin(pending.command_sequence->batch())) || is_behind_rest_of_stop(pending);
}

bool Axis::is_behind_rest_of_stop(const Pending& pending) const {
  for (const Pending& older : pending_) {
    if (&older == &pending) return false;
    if (older.command_sequence->began_as_stop() && !stops_alone(older.command_sequence->batch())) return true;
  }
  return false;
}

// The newer stop goes first; of what stands beside the two the older set-points are not the last ones accepted.
void Axis::hold_rest(const Pending& pending) {
  CommandSequence& sequence = *pending.command_sequence;
  if (!sequence.began_as_stop() || stops_alone(sequence.batch())) return;
  sequence.hold_rest(is_behind_rest_of_stop(pending) ? core_.turn.now + kStopsFirst : kLongAgo);
}

bool Axis::stopping() const {
  return std::any_of(pending_.begin(), pending_.end(), [](const Pending& p) {
    return p.command_sequence->is_stop() && !p.command_sequence->stop_is_over();
  });
}

// An owed one that is sent again would drop what stands beside it.
bool Axis::carries_out_stop() const {
  return std::any_of(pending_.begin(), pending_.end(), [](const Pending& p) {
    return p.command_sequence->began_as_stop() && !p.command_sequence->stop_is_over();
  });
}

bool Axis::enable_is_asked(bool begun) const {
  return std::any_of(pending_.begin(), pending_.end(), [begun](const Pending& p) {
    const bool counts = p.command_sequence->begun() || !begun;
    return counts && !p.command_sequence->is_stop() && asks_to_enable(p.command_sequence->batch());
  });
}

// Bit 8 of a drive whose profile knows of no halt bit would be answered as done, and the motor would run on: what its
// profile halts by is carried out in its place.
bool Axis::asks_for_missing_halt(const WriteBatch& batch) const {
  if (!batch.controlword || batch.command != Command::none || !model::enables(*batch.controlword)) return false;
  const bool rises = (*batch.controlword & ~core_.controlword() & model::controlword::kHalt) != 0;
  return rises && core_.facts().enabled() && !halts_by_word(core_);
}

bool Axis::disable_waits() const {
  return std::any_of(pending_.begin(), pending_.end(), [](const Pending& p) {
    const WriteBatch& batch = p.command_sequence->batch();
    const bool by_word = batch.controlword && model::request_of(*batch.controlword) != model::Request402::quick_stop;
    return p.command_sequence->is_stop() && !p.command_sequence->begun() &&
           (by_word || batch.command == Command::disable);
  });
}

// Out of sight, or found running, nobody knows whether it is a run of ours that goes on: a stop too many is the smaller
// harm.
bool Axis::may_run() const {
  if (run_is_asked() || core_.motion.running() == MotionKind::velocity || core_.motion.runs_raw()) return true;
  const AxisFacts facts = core_.facts();
  const bool continuous = facts.mode == 0 || is_continuous(facts);  // 0: it is not known
  return core_.reachable() ? facts.enabled() && facts.moving && continuous : may_be_enabled();
}

// By a command, or by a word that enables in a mode that runs.
bool Axis::run_is_asked() const {
  return std::any_of(pending_.begin(), pending_.end(), [this](const Pending& p) {
    const WriteBatch& batch = p.command_sequence->batch();
    if (starts_motion(batch.command))
      return batch.command == Command::run_velocity || batch.command == Command::run_torque;
    return batch.controlword && model::request_of(*batch.controlword) == model::Request402::enable_operation &&
           core_.is_continuous(batch.mode.value_or(core_.mode_in_force()));
  });
}

// Design 3.3 Zeros: "the owner's target_velocity or target_torque 0 acts while a run is on". One that still waits for
// the wire will be; and whose connection has ended and come back is the owner by this very write.
void Axis::add_zero_speed(WriteBatch& batch) const {
  const bool owns = ownership_.rules().on && (ownership_.is_owner(batch.client) || waits_for(batch));
  if (!owns || (!run_is_asked() && image_.axis_state != AxisState::continuous_motion)) return;
  for (const Quantity target : {Quantity::target_velocity, Quantity::target_torque})
    if (image_.takes(target)) batch.setpoints.push_back({target, 0});
}

}  // namespace axisgate::drive
