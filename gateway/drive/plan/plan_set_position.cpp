// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

constexpr std::int64_t kMethodPresentPosition = 35;  // CiA 402-2 table 100: homing on the present position
constexpr Duration kCounterLimit = std::chrono::milliseconds(500);

// Read back: the counter itself says so.
bool add_wait_for_counter(const AxisCore& core, Plan& plan) {
  const model::Binding* actual = core.model.binding(Quantity::position_actual);
  if (actual == nullptr || actual->object == model::kNoObject) return true;
  const auto raw = actual->to_raw(core.set_position_value, core.object(actual->object));
  if (!raw) return false;
  model::Condition there;
  there.object = actual->object;
  there.test = model::Condition::Test::in;
  constexpr std::int64_t kHunting = 5;  // a standing servo hunts a few counts around its set-point
  for (std::int64_t d = -kHunting; d <= kHunting; ++d) there.values.push_back(*raw + d);
  plan.add(Action::wait(there, kCounterLimit));
  return true;
}

bool writes_at(const AxisCore& core, const Plan& plan, model::ObjectId object) {
  return object != model::kNoObject && std::ranges::any_of(plan.actions, [&](const Action& a) {
           return a.kind == Action::Kind::write && same_place(core, a.object, object);
         });
}

std::int64_t last_controlword(const AxisCore& core, const Plan& plan) {
  std::int64_t word = 0;
  for (const Action& a : plan.actions)
    if (a.kind == Action::Kind::write && same_place(core, a.object, core.model.controlword)) word = a.number;
  return word;
}

}  // namespace

Plan plan_set_position(const AxisCore& core, int mode_before) {
  if (core.is_virtual()) {
    Plan plan;
    if (!add_command_steps(core, Command::set_position, plan)) return plan;
    if (!add_wait_for_counter(core, plan)) return Plan::refuse(Errc::bad_value);
    plan.add(Action::at(Mark::values_invalidated));
    return plan;
  }
  struct Borrowed {
    Quantity quantity;
    std::int64_t during;
    std::optional<std::int64_t> before;
  };
  const auto owed = core.asked.owed(Quantity::homing_offset), asked = core.homing_method();
  const auto offset = owed ? owed : core.value(Quantity::homing_offset);
  const auto method = asked ? asked : core.value(Quantity::homing_method);
  const std::array<Borrowed, 2> borrowed{
      {{Quantity::homing_offset, 0, offset}, {Quantity::homing_method, kMethodPresentPosition, method}}};
  // The mode that moves was left before; no step may bring it back, nor leave a start in the controlword for it.
  constexpr int kHoming = 6;
  constexpr std::int64_t kCommandBits = 0x000F;
  Plan steps;
  if (!add_command_steps(core, Command::set_position, steps)) return steps;
  if (core.mode_in_force() != kHoming || writes_at(core, steps, core.model.mode))
    return Plan::refuse(Errc::state_unsuitable);
  if (writes_at(core, steps, core.model.controlword) && last_controlword(core, steps) != kCommandBits)
    steps.add(Action::write(core.model.controlword, kCommandBits));
  Plan plan;
  plan.add(Action::at(Mark::borrow_homing));
  for (const Borrowed& b : borrowed)
    if (core.model.binding(b.quantity) != nullptr && !add_write(core, b.quantity, {b.during}, plan))
      return Plan::refuse(Errc::bad_value);
  append(plan, std::move(steps));
  if (!add_wait_for_counter(core, plan)) return Plan::refuse(Errc::bad_value);
  plan.add(Action::at(Mark::values_invalidated));
  for (const Borrowed& b : borrowed) {
    const model::Binding* binding = core.model.binding(b.quantity);
    if (binding == nullptr || !b.before || *b.before == b.during) continue;
    // Unconditionally: what is cached now says nothing about what is cached then.
    if (const auto raw = binding->to_raw(*b.before, core.object(binding->object)))
      plan.add(Action::write(binding->object, *raw));
  }
  plan.add(Action::at(Mark::return_homing));
  const int mode_now = core.mode_in_force();
  if (mode_before != 0 && mode_before != mode_now) {
    if (core.is_continuous(mode_before)) add_running_targets(core, false, plan);
    Plan back = plan_mode(core, static_cast<std::int16_t>(mode_before));
    if (!back.refused()) append(plan, std::move(back));
  }
  return plan;
}

}  // namespace axisgate::drive
