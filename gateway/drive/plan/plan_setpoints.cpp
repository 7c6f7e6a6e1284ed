// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

// How long a drive may take to show the mode it was given. No sheet says; two slow poll periods are ample.
constexpr Duration kModeLimit = std::chrono::milliseconds(500);

model::Condition equals(model::ObjectId object, std::int64_t number) {
  model::Condition c;
  c.object = object;
  c.values = {number};
  return c;
}

model::ObjectId mode_shown_by(const AxisCore& core) {
  return core.model.mode_display != model::kNoObject ? core.model.mode_display : core.model.mode;
}

const std::int64_t* raw_mode(const AxisCore& core, std::int16_t mode) {
  for (const auto& entry : core.model.modes)
    if (entry.first == mode) return &entry.second;
  return nullptr;
}

// New limits above the old ones: the upper one goes first, so that the pair never stands the wrong way round in the
// drive.
bool upper_limit_first(const AxisCore& core, const WriteBatch& batch) {
  const auto old_max = core.value(Quantity::position_limit_max);
  for (const Setpoint& sp : batch.setpoints)
    if (sp.quantity == Quantity::position_limit_min) return old_max && sp.value > *old_max;
  return false;
}

// What the write batch says, else what the drive holds.
std::optional<std::int64_t> limit_after(const AxisCore& core, const WriteBatch& batch, Quantity quantity) {
  for (const Setpoint& sp : batch.setpoints)
    if (sp.quantity == quantity) return sp.value;
  return core.value(quantity);
}

}  // namespace

bool limits_in_order(const AxisCore& core, const WriteBatch& batch) {
  const auto is_limit = [](const Setpoint& sp) {
    return sp.quantity == Quantity::position_limit_min || sp.quantity == Quantity::position_limit_max;
  };
  if (std::ranges::none_of(batch.setpoints, is_limit)) return true;
  const auto low = limit_after(core, batch, Quantity::position_limit_min);
  const auto high = limit_after(core, batch, Quantity::position_limit_max);
  return !low || !high || *low <= *high;
}

Range position_range(const AxisCore& core, const WriteBatch& batch) {
  const Range of_axis = core.model.binding(Quantity::target_position)->limits;
  const auto low = limit_after(core, batch, Quantity::position_limit_min);
  const auto high = limit_after(core, batch, Quantity::position_limit_max);
  if (!low || !high || *low >= *high) return of_axis;
  return {std::max(of_axis.min, *low), std::min(of_axis.max, *high)};
}

std::optional<std::int64_t> raw_of(const AxisCore& core, const model::Binding& by, const Wanted& wanted) {
  return wanted.exact ? wanted.exact : by.to_raw(wanted.value, core.object(by.object));
}

bool add_write(const AxisCore& core, Quantity quantity, const Wanted& wanted, Plan& plan) {
  const model::Binding* binding = core.model.binding(quantity);
  if (binding == nullptr || binding->object == model::kNoObject || !binding->writable) return false;
  const model::ObjectDef& object = core.object(binding->object);
  const auto raw = raw_of(core, *binding, wanted);
  if (!raw) return false;
  const ObjectState& state = core.store[binding->object];
  if (state.cached && state.number == *raw && !object.trigger && !object.composed) return true;
  if (object.nvm != model::Nvm::no && !state.cached && object.readable && !object.trigger && !state.refused) {
    // Where a write wears out the drive's memory, it is looked at first.
    plan.add(Action::read(binding->object));
    plan.add(Action::at(Mark::look_again));
    return true;
  }
  plan.add(Action::write(binding->object, *raw));
  return true;
}

namespace {

// Unconditionally, although it may be cached: a panel or a PC at the drive's other port can have changed it since it
// was read, and this is what keeps an enable from moving. Where a write wears out the drive's memory, it is looked at
// first.
void add_running_target(const AxisCore& core, model::ObjectId id, std::int64_t raw, Plan& plan, bool& look_again) {
  constexpr Duration kFresh = std::chrono::milliseconds(500);
  const ObjectState& state = core.store[id];
  if (state.refused || core.object(id).nvm == model::Nvm::no || core.object(id).trigger) {
    Action write = Action::write(id, raw);
    // One refused read proves nothing. What the drive does not have holds nothing, but that its answer has to say.
    write.optional = state.refused;
    plan.add(write);
  } else if (!state.cached || core.turn.now - state.sent_at > kFresh) {
    plan.add(Action::read(id));
    look_again = true;
  } else if (state.number != raw) {
    plan.add(Action::write(id, raw));
  }
}

}  // namespace

bool moves_by_write(const AxisCore& core, model::ObjectId object) {
  return core.is_virtual() && object != model::kNoObject &&
         (core.object(object).trigger || core.object(object).composed);
}

std::optional<Quantity> setpoint_of_mode(int mode) {
  switch (mode) {
    case 1:
      return Quantity::target_position;
    case 3:
      return Quantity::target_velocity;
    case 4:
      return Quantity::target_torque;
    default:
      return std::nullopt;
  }
}

bool is_target(Quantity quantity) {
  return quantity == Quantity::target_position || quantity == Quantity::target_velocity ||
         quantity == Quantity::target_torque;
}

bool same_place(const AxisCore& core, model::ObjectId a, model::ObjectId b) {
  const auto& aliases = core.object(a).aliases;
  return a == b || std::ranges::find(aliases, b) != aliases.end();
}

bool writes(const Plan& plan, model::ObjectId object) {
  return std::ranges::any_of(plan.actions,
                             [&](const Action& a) { return a.kind == Action::Kind::write && a.object == object; });
}

namespace {

void add_own_running_targets(const AxisCore& core, bool keep_wanted, Plan& plan, bool& look_again) {
  // Those without a quantity on this axis are nobody's to ask for: 0 in any unit. They go first: a drive may take two
  // of them for one set-point (Kinco: target torque and target current), and what was asked for must be the last word.
  const auto& bindings = core.model.bindings;
  for (const model::ObjectId id : core.model.zero_before_enable)
    if (std::ranges::none_of(bindings,
                             [&](const model::Binding& b) { return b.writable && same_place(core, id, b.object); }))
      add_running_target(core, id, 0, plan, look_again);
  for (const Quantity q : {Quantity::target_velocity, Quantity::target_torque}) {
    const model::Binding* binding = core.model.binding(q);
    if (binding == nullptr || !binding->writable || moves_by_write(core, binding->object)) continue;
    Wanted wanted = keep_wanted ? core.running_target(q).value_or(Wanted{}) : Wanted{};
    if (core.motion.record().set_aside_since(wanted.at) && core.state().enabled()) wanted = {};
    add_running_target(core, binding->object, raw_of(core, *binding, wanted).value_or(0), plan, look_again);
  }
}

void add_own_target_here(const AxisCore& core, Plan& plan) {
  const model::Binding* target = core.model.binding(Quantity::target_position);
  const model::Binding* actual = core.model.binding(Quantity::position_actual);
  // The target of a virtual axis starts nothing: only its command does.
  if (core.is_virtual()) return;
  if (target == nullptr || actual == nullptr || !target->writable || core.object(target->object).trigger) return;
  plan.add(Action::read(actual->object));
  plan.add(Action::copy(actual->object, target->object));
}

}  // namespace

// What gives one motor its torque, or lets it go on, gives it to all that are shared with it.
void add_running_targets(const AxisCore& core, bool keep_wanted, Plan& plan) {
  bool look_again = false;
  add_own_running_targets(core, keep_wanted, plan, look_again);
  for (const AxisCore* other : core.shared()) add_own_running_targets(*other, keep_wanted, plan, look_again);
  if (look_again) plan.add(Action::at(Mark::look_again));
}

void add_target_here(const AxisCore& core, Plan& plan) {
  add_own_target_here(core, plan);
  for (const AxisCore* other : core.shared()) add_own_target_here(*other, plan);
}

namespace {

void add_own_quiet_setpoint(const AxisCore& core, const model::Steps* steps, Plan& plan) {
  const auto quantity = setpoint_of_mode(core.mode_in_force());
  const model::Binding* target = quantity ? core.model.binding(*quantity) : nullptr;
  if (target == nullptr || !target->writable || !moves_by_write(core, target->object)) return;
  const auto by_step = [&](const model::Step& step) {
    return step.verb == model::Step::Verb::write && step.object == target->object;
  };
  if (steps != nullptr && std::any_of(steps->begin(), steps->end(), by_step)) return;
  if (quantity != Quantity::target_position) {
    plan.add(Action::write(target->object, 0));
    return;
  }
  const model::Binding* actual = core.model.binding(Quantity::position_actual);
  if (actual == nullptr || actual->object == model::kNoObject) return;
  plan.add(Action::read(actual->object));
  plan.add(Action::copy(actual->object, target->object));
}

}  // namespace

void add_quiet_setpoint(const AxisCore& core, const model::Steps* steps, Plan& plan) {
  add_own_quiet_setpoint(core, steps, plan);
  for (const AxisCore* other : core.shared()) add_own_quiet_setpoint(*other, nullptr, plan);
}

// 3.4: a target_velocity acts at once while commands 8 and 9 or raw modes run, and not on a jog.
bool waits_for_jog(const AxisCore& core, const WriteBatch& batch, Quantity quantity) {
  return core.jog.active() && quantity == Quantity::target_velocity && batch.command != Command::run_velocity;
}

void remember_setpoints(AxisCore& core, const WriteBatch& batch) {
  for (const Setpoint& sp : batch.setpoints) {
    if (batch.jogs && sp.quantity == Quantity::target_velocity)
      core.jog.runs_at({sp.value, sp.exact, batch.client, core.motion.record().now()});
    else
      core.asked.take(sp.quantity, {sp.value, sp.exact, batch.client}, holds_stop(batch));
  }
  if (batch.command == Command::run_velocity && !batch.jogs) core.jog.give_way();
  if (batch.set_position_value) core.set_position_value = *batch.set_position_value;
}

namespace {

// A set-point that changed while the axis runs acts on some drives only if they are told to run once more.
void add_changed_run(const AxisCore& core, const WriteBatch& batch, Plan& plan) {
  const auto& run = core.model.command(Command::run_velocity);
  if (!run || !run->repeat_on_change || !core.state().enabled() || batch.command == Command::run_velocity) return;
  const model::Binding* binding = core.model.binding(Quantity::target_velocity);
  if (!writes(plan, binding->object)) return;
  // Nobody has seen it for a moment: it may have ended, by a restart perhaps, and would be started anew.
  if (!core.store[core.model.statusword].cached) {
    plan = {};
    plan.add(Action::read(core.model.statusword));
    plan.add(Action::at(Mark::look_again));
    return;
  }
  add_steps(core, run->steps, plan);
  plan.add(Action::at(Mark::start_velocity));
}

// What moves the axis by being written is kept for a start of its own mode, and acts at once only while that runs. The
// drive is not asked for the number that it holds once more: keep-alive does that (profile key "keepalive").
bool may_be_written(const AxisCore& core, const Setpoint& sp, const AxisFacts& facts) {
  const model::Binding* binding = core.model.binding(sp.quantity);
  const bool held_back = core.held_back(sp.quantity);
  if (binding == nullptr || !moves_by_write(core, binding->object) || !is_target(sp.quantity))
    return core.motion.target_acts_now(sp.quantity, facts, held_back);
  const bool runs = facts.enabled() && facts.commanded && setpoint_of_mode(facts.mode) == sp.quantity;
  if (!runs || !core.motion.target_acts_now(sp.quantity, facts, true)) return false;
  const auto raw = raw_of(core, *binding, {sp.value, sp.exact});
  const ObjectState& state = core.store[binding->object];
  const auto& repeated = core.model.keep_alive;
  const bool kept_alive = std::ranges::any_of(
      repeated, [&](const auto& row) { return row.first == facts.mode && row.second == binding->object; });
  return !(kept_alive && state.cached && raw && state.number == *raw);
}

}  // namespace

Plan plan_setpoints(const AxisCore& core, const WriteBatch& batch) {
  // Judged again: another client's limit may have been written since this one was admitted.
  if (!limits_in_order(core, batch)) return Plan::refuse(Errc::bad_value);
  Plan plan;
  const AxisFacts facts = core.facts();
  const auto add = [&](const Setpoint& sp) {
    // A target that comes with its own start goes with it, once the mode is the right one: a change of mode would
    // invalidate it.
    if (target_of(batch.command) == sp.quantity || waits_for_jog(core, batch, sp.quantity)) return true;
    if (!may_be_written(core, sp, facts)) return true;
    const std::size_t before = plan.actions.size();
    if (!add_write(core, sp.quantity, {sp.value, sp.exact}, plan)) return false;
    // From now on it is a run of ours, also at no speed.
    if (plan.actions.size() != before && core.motion.goes_on(sp.quantity, facts)) plan.add(Action::at(Mark::run_raw));
    return true;
  };
  const bool max_first = upper_limit_first(core, batch);
  for (const Setpoint& sp : batch.setpoints)
    if (max_first && sp.quantity == Quantity::position_limit_max && !add(sp)) return Plan::refuse(Errc::bad_value);
  for (const Setpoint& sp : batch.setpoints)
    if (!(max_first && sp.quantity == Quantity::position_limit_max) && !add(sp)) return Plan::refuse(Errc::bad_value);
  add_changed_run(core, batch, plan);
  return plan;
}

void add_mode(const AxisCore& core, int mode, Plan& plan) {
  const std::int64_t* raw = raw_mode(core, static_cast<std::int16_t>(mode));
  if (raw == nullptr || core.model.mode == model::kNoObject) return;
  plan.add(Action::write(core.model.mode, *raw));
  plan.add(Action::at(Mark::values_invalidated, core.model.mode));
  plan.add(Action::wait(equals(mode_shown_by(core), *raw), kModeLimit));
  plan.add(Action::at(Mark::mode_changed));
}

Plan plan_mode(const AxisCore& core, std::int16_t mode) {
  if (core.is_virtual()) return plan_virtual_mode(core, mode, false);
  Plan plan;
  const std::int64_t* raw = raw_mode(core, mode);
  if (raw == nullptr || core.model.mode == model::kNoObject) return Plan::refuse(Errc::bad_value);
  const model::ObjectId display = mode_shown_by(core);
  const ObjectState& asked = core.store[core.model.mode];
  const ObjectState& shown = core.store[display];
  if (asked.cached && asked.number == *raw && shown.cached && shown.number == *raw) return plan;
  if (asked.known && asked.number == *raw && shown.known && shown.number == *raw && !asked.unsure) {
    // Invalidated only: to look is better than to write a mode in which something may be running.
    plan.add(Action::read(core.model.mode));
    if (display != core.model.mode) plan.add(Action::read(display));
    plan.add(Action::at(Mark::look_again));
    return plan;
  }
  if (core.another_runs()) return Plan::refuse(Errc::busy);
  add_mode(core, mode, plan);
  return plan;
}

Plan plan_raw_mode(const AxisCore& core, std::int16_t mode) {
  if (core.is_virtual()) return plan_virtual_mode(core, mode, true);
  Plan change = plan_mode(core, mode);
  Plan plan;
  if (!change.refused() && !change.actions.empty() && core.state().enabled()) {
    if (core.is_continuous(mode)) {
      add_running_targets(core, true, plan);
      add_speeds(core, mode, plan);
    }
    // In modes 7 and 8 the target is the demand of every cycle: the change itself must not be a step.
    if (mode == 7 || mode == 8) add_target_here(core, plan);
  }
  static_cast<void>(append(plan, std::move(change)));
  return plan;
}

bool nothing_to_send(const AxisCore& core, const WriteBatch& batch) {
  if (batch.command != Command::none || batch.controlword || batch.object) return false;
  const Plan setpoints = plan_setpoints(core, batch);
  if (setpoints.refused() || !setpoints.actions.empty()) return false;
  if (!batch.mode) return true;
  const Plan mode = plan_raw_mode(core, *batch.mode);
  return !mode.refused() && mode.actions.empty();
}

}  // namespace axisgate::drive
