#include <algorithm>

#include "gateway/drive/planner.hpp"

namespace axisgate::drive {
namespace {

// How long a drive may take to show the mode it was given. No sheet says; two slow poll periods are ample.
constexpr Duration kModeLimit = std::chrono::milliseconds(500);

Condition equals(ObjectId object, std::int64_t number) {
  Condition c;
  c.object = object;
  c.values = {number};
  return c;
}

const std::int64_t* raw_mode(const AxisCore& core, std::int16_t mode) {
  for (const auto& entry : core.model.modes)
    if (entry.first == mode) return &entry.second;
  return nullptr;
}

// New limits above the old ones: the upper one goes first, so that the pair never stands the wrong way round in the drive.
bool upper_limit_first(const AxisCore& core, const Group& group) {
  const auto old_max = core.value(Quantity::position_limit_max);
  for (const Setpoint& sp : group.setpoints)
    if (sp.quantity == Quantity::position_limit_min) return old_max && sp.value > *old_max;
  return false;
}

}  // namespace

bool limits_in_order(const AxisCore& core, const Group& group) {
  std::optional<std::int64_t> low, high;
  for (const Setpoint& sp : group.setpoints) {
    if (sp.quantity == Quantity::position_limit_min) low = sp.value;
    if (sp.quantity == Quantity::position_limit_max) high = sp.value;
  }
  if (!low && !high) return true;
  if (!low) low = core.value(Quantity::position_limit_min);
  if (!high) high = core.value(Quantity::position_limit_max);
  return !low || !high || *low <= *high;
}

bool add_write(const AxisCore& core, Quantity quantity, const Wanted& wanted, Plan& plan) {
  const Binding* binding = core.model.binding(quantity);
  if (binding == nullptr || binding->object == kNoObject || !binding->writable) return false;
  const ObjectDef& object = core.object(binding->object);
  const auto raw = wanted.exact ? wanted.exact : binding->to_raw(wanted.value, object);
  if (!raw) return false;
  const ObjectState& state = core.store[binding->object];
  const bool unchanged = state.held && state.number == *raw && !object.trigger;
  if (!unchanged) plan.add(Action::write(binding->object, *raw));
  return true;
}

void add_running_targets(const AxisCore& core, bool keep_wanted, Plan& plan) {
  for (const Quantity q : {Quantity::target_velocity, Quantity::target_torque}) {
    const Binding* binding = core.model.binding(q);
    if (binding != nullptr && binding->writable)
      static_cast<void>(add_write(core, q, keep_wanted ? core.running_target(q) : Wanted{}, plan));
  }
  // Those without a quantity on this axis are nobody's to ask for: 0 in any unit. What the drive does not have holds none.
  for (const ObjectId id : core.model.zero_before_enable) {
    const auto& bindings = core.model.bindings;
    if (std::any_of(bindings.begin(), bindings.end(), [&](const Binding& b) { return b.object == id && b.writable; }))
      continue;
    const ObjectState& state = core.store[id];
    if (!state.refused && !(state.held && state.number == 0)) plan.add(Action::write(id, 0));
  }
}

void add_target_here(const AxisCore& core, Plan& plan) {
  const Binding* target = core.model.binding(Quantity::target_position);
  const Binding* actual = core.model.binding(Quantity::position_actual);
  if (target == nullptr || actual == nullptr || !target->writable || core.object(target->object).trigger) return;
  plan.add(Action::read(actual->object));
  plan.add(Action::copy(actual->object, target->object));
}

void remember_setpoints(AxisCore& core, const Group& group) {
  for (const Setpoint& sp : group.setpoints) {
    core.motion.want(sp.quantity, {sp.value, sp.exact});
    if (sp.quantity == Quantity::homing_method) core.homing_method = sp.value;
    if (sp.quantity == Quantity::homing_offset) core.offset_owed.reset();
  }
  if (group.set_position_value) core.set_position_value = *group.set_position_value;
}

Plan plan_setpoints(const AxisCore& core, const Group& group) {
  // Judged again: another client's limit may have been written since this one was admitted.
  if (!limits_in_order(core, group)) return Plan::refuse(Errc::bad_value);
  Plan plan;
  const AxisFacts facts = core.facts();
  const auto add = [&](const Setpoint& sp) {
    if (!core.motion.target_acts_now(sp.quantity, facts, core.held_back(sp.quantity))) return true;
    return add_write(core, sp.quantity, {sp.value, sp.exact}, plan);
  };
  const bool max_first = upper_limit_first(core, group);
  for (const Setpoint& sp : group.setpoints)
    if (max_first && sp.quantity == Quantity::position_limit_max && !add(sp)) return Plan::refuse(Errc::bad_value);
  for (const Setpoint& sp : group.setpoints)
    if (!(max_first && sp.quantity == Quantity::position_limit_max) && !add(sp)) return Plan::refuse(Errc::bad_value);
  return plan;
}

Plan plan_mode(const AxisCore& core, std::int16_t mode) {
  Plan plan;
  const std::int64_t* raw = raw_mode(core, mode);
  if (raw == nullptr || core.model.mode == kNoObject) return Plan::refuse(Errc::bad_value);
  const ObjectId display = core.model.mode_display != kNoObject ? core.model.mode_display : core.model.mode;
  const ObjectState& asked = core.store[core.model.mode];
  const ObjectState& shown = core.store[display];
  if (asked.held && asked.number == *raw && shown.held && shown.number == *raw) return plan;
  plan.add(Action::write(core.model.mode, *raw));
  plan.add(Action::at(Mark::values_doubtful, core.model.mode));
  plan.add(Action::wait(equals(display, *raw), kModeLimit));
  plan.add(Action::at(Mark::mode_changed));
  return plan;
}

Plan plan_raw_mode(const AxisCore& core, std::int16_t mode) {
  Plan change = plan_mode(core, mode);
  Plan plan;
  if (!change.refused() && !change.actions.empty() && core.facts().enabled()) {
    if (is_continuous(mode)) add_running_targets(core, true, plan);
    // In modes 7 and 8 the target is the demand of every cycle: the change itself must not be a step.
    if (mode == 7 || mode == 8) add_target_here(core, plan);
  }
  static_cast<void>(append(plan, std::move(change)));
  return plan;
}

bool nothing_to_send(const AxisCore& core, const Group& group) {
  if (group.command != Command::none || group.controlword || group.object) return false;
  const Plan setpoints = plan_setpoints(core, group);
  if (setpoints.refused() || !setpoints.actions.empty()) return false;
  if (!group.mode) return true;
  const Plan mode = plan_raw_mode(core, *group.mode);
  return !mode.refused() && mode.actions.empty();
}

}  // namespace axisgate::drive
