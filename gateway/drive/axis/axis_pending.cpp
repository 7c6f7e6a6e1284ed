// SPDX-License-Identifier: Apache-2.0
// What a write batch becomes by what the axis does, or may do: halts that a drive does not have, zeros that end a run.
#include <algorithm>

#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
// A stop ramps down, and still shows enabled: what would enable or start comes when it is over. What came later than a
// stop's own set-points comes after them (3.3, the order of one axis).
// The newer stop goes first; of what stands beside the two the older set-points are not the last ones accepted.
void Axis::hold_rest(const Pending& pending) {
  CommandSequence& sequence = *pending.command_sequence;
  if (!sequence.began_as_stop() || stops_alone(sequence.batch())) return;
  sequence.hold_rest(pending_.is_behind_rest_of_stop(pending) ? core_.turn.now + kStopsFirst : kLongAgo);
}

// Out of sight, or found running, nobody knows whether it is a run of ours that goes on: a stop too many is the smaller
// harm.
bool Axis::may_run() const {
  if (pending_.runs(core_) || core_.motion.running() == MotionKind::velocity || core_.motion.runs_raw()) return true;
  const AxisFacts facts = core_.facts();
  const bool continuous = facts.mode == 0 || is_continuous(facts);  // 0: it is not known
  return core_.reachable() ? facts.enabled() && facts.moving && continuous : may_be_enabled();
}

// Design 3.3 Zeros: "the owner's target_velocity or target_torque 0 acts while a run is on". One that still waits for
// the wire will be; and whose connection has ended and come back is the owner by this very write.
void Axis::add_zero_speed(WriteBatch& batch) const {
  const bool owns = ownership_.rules().on && (ownership_.is_owner(batch.client) || waits_for(batch));
  if (!owns || (!pending_.runs(core_) && image_.axis_state != AxisState::continuous_motion)) return;
  for (const Quantity target : {Quantity::target_velocity, Quantity::target_torque})
    if (image_.takes(target)) batch.setpoints.push_back({target, 0});
}

}  // namespace axisgate::drive
