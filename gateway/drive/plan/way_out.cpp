// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/plan/way_out.hpp"

#include <algorithm>
#include <array>

#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

// A step of the profile writes exactly this.
bool has_write(const model::Steps& steps, model::ObjectId object, std::int64_t number) {
  return std::ranges::any_of(steps, [&](const model::Step& step) {
    return step.verb == model::Step::Verb::write && step.source == model::Step::Source::literal &&
           step.object == object && step.literal == number;
  });
}

bool writes(const AxisCore& core, Command command, model::ObjectId object, std::int64_t number) {
  const auto& def = core.model.command(command);
  if (!def) return false;
  return has_write(def->steps, object, number) ||
         std::ranges::any_of(def->variants, [&](const model::CommandDef::Variant& variant) {
           return has_write(variant.steps, object, number);
         });
}

// What a stop or a fault_reset of this drive writes too is no start: two commands may begin alike.
bool is_harmless(const AxisCore& core, model::ObjectId object, std::int64_t number) {
  return std::ranges::any_of(std::array{Command::disable, Command::quick_stop, Command::halt, Command::fault_reset},
                             [&](Command command) { return writes(core, command, object, number); });
}

// The set-point that this object is; none.
std::optional<Quantity> target_of(const AxisCore& core, model::ObjectId object) {
  for (const Quantity target : {Quantity::target_position, Quantity::target_velocity, Quantity::target_torque})
    if (core.object_of(target) != model::kNoObject && same_place(core, core.object_of(target), object)) return target;
  return std::nullopt;
}

// A set-point moves what is enabled where the drive follows it, or where the write itself is the start.
bool moves_as_target(const AxisCore& core, model::ObjectId object, std::int64_t number) {
  const auto target = target_of(core, object);
  const AxisFacts facts = core.facts();
  if (!target || !facts.enabled()) return false;
  const bool acts = followed_target(facts) == target || moves_by_write(core, object);
  return acts && (target == Quantity::target_position || number != 0);
}

bool within_limits(const AxisCore& core, Quantity target, std::int64_t number) {
  const model::Binding& binding = *core.model.binding(target);
  const model::ObjectDef& object = core.object(binding.object);
  const Range range = target == Quantity::target_position ? position_range(core) : binding.limits;
  const auto least = binding.to_raw(range.min, object), most = binding.to_raw(range.max, object);
  if (!least || !most) return true;
  return number >= std::min(*least, *most) && number <= std::max(*least, *most);
}

// A word that starts a move: to the target that the drive holds, at the speeds that it holds.
bool starts_within_limits(const AxisCore& core, model::ObjectId object, std::int64_t number) {
  constexpr std::int64_t kNewSetPoint = 0x10, kRelative = 0x40, kHalt = 0x100;
  constexpr int kProfilePosition = 1;
  const bool word = object == core.model.controlword && !core.is_virtual();
  if (!word || (number & (kNewSetPoint | kHalt)) != kNewSetPoint || core.mode_in_force() != kProfilePosition)
    return true;
  const model::ObjectId target = core.object_of(Quantity::target_position);
  const bool goes_there = (number & kRelative) == 0 && target != model::kNoObject && core.store[target].cached;
  if (goes_there && !within_limits(core, Quantity::target_position, core.store[target].number)) return false;
  return holds_asked_speeds(core, kProfilePosition);
}

}  // namespace

std::vector<Written> sent_by(const AxisCore& core, const bus::Exchange& exchange) {
  const AllWritten plain = all_written(core.drive, exchange);
  std::vector<Written> out(plain.begin(), plain.end());
  for (const Written& write : plain)
    for (const model::ObjectId id : core.drive.with_parts(write.object)) {
      const model::PartOf& made_of = core.object(id).part;
      if (!core.object(id).is_directed()) continue;
      const bool is_way = write.object == made_of.sign;
      const std::int64_t way = is_way ? write.number : core.store[made_of.sign].number;
      const std::int64_t magnitude = is_way ? core.store[made_of.whole].number : write.number;
      if (is_way && way != made_of.positive && way != made_of.negative) continue;
      out.push_back({id, way == made_of.negative ? -magnitude : magnitude});
    }
  return out;
}

Reach reach_of(const AxisCore& core, model::ObjectId object, std::int64_t number) {
  if (is_enabling_word(core, object, number)) return Reach::enables;
  if (moves_as_target(core, object, number)) return Reach::moves;
  if (!core.is_virtual() || is_harmless(core, object, number)) return Reach::nothing;
  if (writes(core, Command::enable, object, number)) return Reach::enables;
  for (std::size_t i = 0; i <= kLastCommand; ++i)
    if (const auto command = static_cast<Command>(i);
        starts_motion(command) && core.object(object).trigger && writes(core, command, object, number))
      return Reach::moves;
  return Reach::nothing;
}

Errc held_on_way_out(const AxisCore& core, model::ObjectId object, std::int64_t number, const Sender& sender) {
  const Reach reach = reach_of(core, object, number);
  if (reach == Reach::nothing) return Errc::ok;
  const AxisFacts facts = core.facts();
  const bool keeps_enabled = facts.enabled() && facts.commanded;
  if (sender.keeps) {
    const ObjectState& held = core.store[object];
    return keeps_enabled && held.known && held.number == number ? Errc::ok : Errc::state_unsuitable;
  }
  if (!sender.asked) return Errc::state_unsuitable;
  // A word that halts holds the torque and never gives it. A target of a stop is the place where it was asked for.
  if (sender.stops) return reach == Reach::moves || keeps_enabled ? Errc::ok : Errc::state_unsuitable;
  if (core.motion.record().stopped_since(*sender.asked)) return Errc::dropped_by_stop;
  if (core.turn.now > sender.by) return Errc::never_started;
  const auto target = target_of(core, object);
  if (target && !within_limits(core, *target, number)) return Errc::bad_value;
  if (!starts_within_limits(core, object, number)) return Errc::bad_value;
  if (sender.begins) return Errc::ok;
  if (reach == Reach::enables) return keeps_enabled ? Errc::ok : Errc::state_unsuitable;
  // A new speed acts on the run that is on: by itself, or by the run's start once more (CommandDef::repeat_on_change).
  return core.motion.target_acts_now(target.value_or(Quantity::target_velocity), facts, false) ? Errc::ok
                                                                                               : Errc::state_unsuitable;
}

}  // namespace axisgate::drive
