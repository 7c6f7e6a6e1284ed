// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/state/effect_watch.hpp"

#include <algorithm>
#include <cstdlib>

namespace axisgate::drive {
namespace {

// What a standing servo hunts, as the drive counts; as profiles have it for "within".
constexpr std::int64_t kHunts = 10;

model::ObjectId object_of(const AxisCore& core, const std::optional<model::Condition>& condition) {
  return condition && !core.store[condition->object].refused ? condition->object : model::kNoObject;
}

bool fresh(const AxisCore& core, model::ObjectId id, std::uint64_t after) {
  return id != model::kNoObject && core.store[id].known && core.store[id].exchange > after;
}

// Limit and home switches are looked for by moving. On an index pulse, against an end stop or "here" an axis may stand
// already.
bool must_move(std::int64_t method) { return (method >= 1 && method <= 14) || (method >= 17 && method <= 30); }

}  // namespace

void EffectWatch::sending(const AxisCore& core) {
  sent_at_ = core.turn.now;
  const AxisFacts facts = core.facts();
  before_ = {.moving = facts.moving, .homed = facts.reference, .homing_failed = facts.homing_failed};
  if (const model::ObjectId id = core.object_of(Quantity::position_actual);
      id != model::kNoObject && core.store[id].known)
    before_.position = core.store[id].number;
  const model::ObjectId id = core.object_of(Quantity::velocity_actual);
  const auto speed = core.value(Quantity::velocity_actual);
  if (id != model::kNoObject && speed && core.store[id].cached &&
      core.turn.now - core.store[id].sent_at <= core.model.velocity_lag)
    fall_.before(*speed);
}

model::ObjectId EffectWatch::to_read(const AxisCore& core, Effect effect) {
  model::ObjectId oldest = model::kNoObject;
  const auto consider = [&](model::ObjectId id) {
    if (id == model::kNoObject) return;
    id = core.to_read(id);
    if (oldest == model::kNoObject || core.store[id].exchange < core.store[oldest].exchange) oldest = id;
  };
  consider(core.motion_object());
  consider(core.object_of(effect == Effect::stop ? Quantity::velocity_actual : Quantity::position_actual));
  if (effect == Effect::homing && !core.is_virtual()) consider(object_of(core, core.model.homed));
  return oldest;
}

bool EffectWatch::shown(const AxisCore& core, Effect effect, std::uint64_t after) {
  return effect == Effect::stop ? stops(core, after) : homes(core, after);
}

// A sampled velocity of 0 may be of before a start that the stop has ended, and so may noise about it; one that falls
// is of now. Without torque a motor coasts as it may: the state alone shows the stop. A bit that says that it stands is
// not believed while it turns.
bool EffectWatch::stops(const AxisCore& core, std::uint64_t after) {
  if (fresh(core, core.model.statusword, after) && !core.shows_torque()) return true;
  const auto velocity = core.value(Quantity::velocity_actual);
  const model::ObjectId sampled = core.object_of(Quantity::velocity_actual);
  const std::int64_t standstill = core.model.standstill_velocity;
  const bool tells = velocity && fresh(core, sampled, after);
  if (tells && fall_.falls(*velocity, core.store[sampled].sent_at, standstill)) return true;
  const model::ObjectId moves = core.motion_object();
  if (!fresh(core, moves, after)) return false;
  if (moves == sampled)
    return (!core.moving() || fall_.turned_round()) && core.turn.now - sent_at_ >= core.model.velocity_lag;
  return !core.moving() && (sampled == model::kNoObject || (tells && std::abs(*velocity) <= standstill));
}

// It moves, its bits have changed, or it is elsewhere. What moved before nobody can tell from what homes; and a drive
// that was homed, and need not move for it, may have homed again.
bool EffectWatch::homes(const AxisCore& core, std::uint64_t after) const {
  const AxisFacts facts = core.facts();
  if (fresh(core, core.motion_object(), after) && facts.moving) return true;
  const model::ObjectId position = core.object_of(Quantity::position_actual);
  if (before_.position && !before_.moving && fresh(core, position, after) &&
      std::abs(core.store[position].number - *before_.position) > kHunts)
    return true;
  if (core.is_virtual() || !fresh(core, object_of(core, core.model.homed), after)) return false;
  if (facts.reference != before_.homed || (facts.homing_failed && !before_.homing_failed)) return true;
  return facts.reference && !must_move(core.homing_method().value_or(0));
}

bool stop_shows(const AxisCore& core) {
  const model::ObjectId id = core.motion_object();
  const bool keeps_torque = core.is_virtual() && core.model.virtual_axis->gate_only;
  if (id == model::kNoObject || (!core.shows_torque() && !keeps_torque)) return false;
  return core.motion.stopping() || core.moving() || !core.store[id].cached;
}

}  // namespace axisgate::drive
