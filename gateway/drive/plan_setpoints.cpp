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

}  // namespace

bool add_write(const AxisCore& core, Quantity quantity, std::int64_t value, Plan& plan) {
  const Binding* binding = core.model.binding(quantity);
  if (binding == nullptr || binding->object == kNoObject || !binding->writable) return false;
  const ObjectDef& object = core.object(binding->object);
  const auto raw = binding->to_raw(value, object);
  if (!raw) return false;
  const ObjectState& state = core.store[binding->object];
  const bool unchanged = state.held && state.number == *raw && !object.trigger;
  if (!unchanged) plan.add(Action::write(binding->object, *raw));
  return true;
}

void add_zero_targets(const AxisCore& core, Plan& plan) {
  for (const Quantity q : {Quantity::target_velocity, Quantity::target_torque}) {
    const Binding* binding = core.model.binding(q);
    if (binding != nullptr && binding->writable) static_cast<void>(add_write(core, q, 0, plan));
  }
}

Plan plan_setpoints(AxisCore& core, const Group& group) {
  Plan plan;
  const AxisFacts facts = core.facts();
  for (const Setpoint& sp : group.setpoints) {
    core.motion.want(sp.quantity, sp.value);
    if (sp.quantity == Quantity::homing_method) core.homing_method_given = true;
    if (!core.motion.target_acts_now(sp.quantity, facts, core.held_back(sp.quantity))) continue;
    if (sp.exact) {
      plan.add(Action::write(core.model.binding(sp.quantity)->object, *sp.exact));
    } else if (!add_write(core, sp.quantity, sp.value, plan)) {
      return Plan::refuse(Errc::bad_value);
    }
  }
  if (group.set_position_value) core.set_position_value = *group.set_position_value;
  return plan;
}

Plan plan_mode(const AxisCore& core, std::int16_t mode) {
  Plan plan;
  const auto* known = [&]() -> const std::pair<std::int16_t, std::int64_t>* {
    for (const auto& entry : core.model.modes)
      if (entry.first == mode) return &entry;
    return nullptr;
  }();
  if (known == nullptr || core.model.mode == kNoObject) return Plan::refuse(Errc::bad_value);
  const ObjectId display = core.model.mode_display != kNoObject ? core.model.mode_display : core.model.mode;
  const ObjectState& asked = core.store[core.model.mode];
  const ObjectState& shown = core.store[display];
  if (asked.held && asked.number == known->second && shown.held && shown.number == known->second) return plan;
  plan.add(Action::write(core.model.mode, known->second));
  plan.add(Action::at(Mark::values_doubtful));
  plan.add(Action::wait(equals(display, known->second), kModeLimit));
  plan.add(Action::at(Mark::mode_changed));
  return plan;
}

}  // namespace axisgate::drive
