// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/pending_batches.hpp"

#include <algorithm>

#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {

Pending* PendingBatches::find(bus::JobId id) {
  const auto found = std::find_if(begin(), end(), [&](const Pending& p) { return p.id == id; });
  return found == end() ? nullptr : &*found;
}

bus::JobId PendingBatches::chain_job() const {
  for (const Pending& p : *this)
    if (p.command_sequence->chain_open()) return p.id;
  return 0;
}

// --- What is asked of the axis ---------------------------------------------------------------------------------------

bool PendingBatches::starts_motion() const {
  return std::any_of(begin(), end(), [](const Pending& p) { return p.starts_motion; });
}

bool PendingBatches::jogs() const {
  return std::any_of(begin(), end(), [](const Pending& p) { return p.jogs; });
}

bool PendingBatches::runs(const AxisCore& core) const {
  return std::any_of(begin(), end(), [&core](const Pending& p) {
    const WriteBatch& batch = p.batch();
    if (axisgate::starts_motion(batch.command))
      return batch.command == Command::run_velocity || batch.command == Command::run_torque;
    return batch.controlword && model::request_of(*batch.controlword) == model::Request402::enable_operation &&
           core.is_continuous(batch.mode.value_or(core.mode_in_force()));
  });
}

bool PendingBatches::moves_zero() const {
  return std::any_of(begin(), end(), [](const Pending& p) {
    return p.batch().command == Command::home || p.batch().command == Command::set_position;
  });
}

bool PendingBatches::enables(bool begun) const {
  return std::any_of(begin(), end(), [begun](const Pending& p) {
    const bool counts = p.command_sequence->begun() || !begun;
    return counts && !p.command_sequence->is_stop() && asks_to_enable(p.batch());
  });
}

bool PendingBatches::disables() const {
  return std::any_of(begin(), end(), [](const Pending& p) {
    const WriteBatch& batch = p.batch();
    const bool by_word = batch.controlword && model::request_of(*batch.controlword) != model::Request402::quick_stop;
    return p.command_sequence->is_stop() && !p.command_sequence->begun() &&
           (by_word || batch.command == Command::disable);
  });
}

bool PendingBatches::writes() const {
  return std::any_of(begin(), end(), [](const Pending& p) {
    const WriteBatch& batch = p.batch();
    const bool only_clears = batch.command == Command::fault_reset && !batch.controlword;  // which enables nothing
    return !p.command_sequence->is_stop() && !reads_alone(batch) && !only_clears;
  });
}

bool PendingBatches::ends_owed_stop(bool halt) const {
  return std::any_of(begin(), end(), [halt](const Pending& p) {
    return !p.command_sequence->is_stop() &&
           (asks_to_enable(p.batch()) || (halt && axisgate::starts_motion(p.batch().command)));
  });
}

// --- Stops go first --------------------------------------------------------------------------------------------------

bool PendingBatches::stopping() const {
  return std::any_of(begin(), end(), [](const Pending& p) {
    return p.command_sequence->is_stop() && !p.command_sequence->stop_is_over();
  });
}

bool PendingBatches::carries_out_stop() const {
  return std::any_of(begin(), end(), [](const Pending& p) {
    return p.command_sequence->began_as_stop() && !p.command_sequence->stop_is_over();
  });
}

// A stop ramps down, and still shows enabled: what would enable or start comes when it is over. What came later than a
// stop's own set-points comes after them (3.3, the order of one axis).
bool PendingBatches::waits_for_stop(const Pending& pending) const {
  return (stopping() && asks_to_begin(pending.batch())) || is_behind_rest_of_stop(pending);
}

bool PendingBatches::is_behind_rest_of_stop(const Pending& pending) const {
  for (const Pending& older : *this) {
    if (&older == &pending) return false;
    if (older.command_sequence->began_as_stop() && !stops_alone(older.batch())) return true;
  }
  return false;
}

bool PendingBatches::insists(bus::JobId id) const {
  return std::any_of(begin(), end(), [&](const Pending& p) {
    return p.command_sequence->is_stop() &&
           (p.id == id ? p.command_sequence->would_repeat() : !p.command_sequence->begun());
  });
}

}  // namespace axisgate::drive
