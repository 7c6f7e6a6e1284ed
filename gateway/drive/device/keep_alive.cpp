// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/keep_alive.hpp"

#include <algorithm>

namespace axisgate::drive {

KeepAlive::KeepAlive(const model::DriveModel& model)
    : model_(model), written_(model.axes.size(), kLongAgo), not_before_(model.axes.size(), kLongAgo) {}

void KeepAlive::reset() {
  std::fill(written_.begin(), written_.end(), kLongAgo);
  std::fill(not_before_.begin(), not_before_.end(), kLongAgo);
}

void KeepAlive::written(model::ObjectId object, Instant sent_at) {
  const model::ObjectDef& def = model_.object(object);
  if (def.emulated || (!def.trigger && !def.composed)) return;
  for (std::size_t slot = 0; slot < written_.size(); ++slot) {
    // A composed frame commands both motors.
    if (!def.composed && def.slot != slot) continue;
    written_[slot] = std::max(written_[slot], sent_at);
    not_before_[slot] = kLongAgo;
  }
}

void KeepAlive::failed(AxisSlot slot, Instant now) {
  constexpr int kTriesPerPeriod = 8;
  not_before_[slot] = now + model_.keep_alive / kTriesPerPeriod;
}

std::optional<KeepAlive::Repeat> KeepAlive::repeat(const AxisCore& core, bool stopping, bool live) const {
  if (!wanted() || !live) return std::nullopt;
  const AxisFacts facts = core.facts();
  if (!facts.enabled() || !facts.commanded) return std::nullopt;
  for (const auto& [mode, object] : core.model.keep_alive) {
    if (mode != facts.mode) continue;
    const ObjectState& told = core.store[object];
    if (!told.known || told.unsure || told.refused) return std::nullopt;
    // A stop makes void what ran before. The 0 that it has written is repeated: a ramp of its that takes longer than
    // the drive waits would end without torque.
    const bool runs_by_it = core.is_continuous(mode);
    const bool stands = told.number == 0 && runs_by_it;
    if (stopping && !stands) return std::nullopt;
    // A speed whose run has ended is nobody's any more: who has enabled the axis since, by another way than the
    // gateway, has not asked for it.
    if (runs_by_it && !stands && core.motion.running() == MotionKind::none) return std::nullopt;
    return Repeat{object, told.number};
  }
  return std::nullopt;
}

Instant KeepAlive::due(AxisSlot slot) const {
  const Instant next = written_[slot] == kLongAgo ? kLongAgo : written_[slot] + model_.keep_alive / 2;
  return std::max(next, not_before_[slot]);
}

}  // namespace axisgate::drive
