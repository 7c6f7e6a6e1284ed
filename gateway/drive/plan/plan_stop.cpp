// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

// Controlwords of a virtual axis (CiA 402-2 table 28).
constexpr std::uint16_t kSwitchedOn = 0x0007, kEnabled = 0x000F;

// How long a stop may take to be seen in the motor's speed. Then it is owed, and sent again after a pause.
constexpr Duration kSlowerLimit = std::chrono::seconds(2);

model::Condition not_enabled(const AxisCore& core) {
  model::Condition c;
  c.object = core.model.statusword;
  c.mask = 0x6F;
  c.test = model::Condition::Test::not_equals;
  c.values = {0x27};  // operation enabled
  return c;
}

// Kinco's halt word is 0x010F: its low bits ask for "enabled", also of a drive that is not.
bool hold_an_enabling_word(const AxisCore& core, const model::Steps& steps) {
  return std::ranges::any_of(steps, [&](const model::Step& s) {
    return s.verb == model::Step::Verb::write && s.source == model::Step::Source::literal &&
           is_enabling_word(core, s.object, s.literal);
  });
}

/// The controlword without which this drive heeds no other one after a restart (setup of its profile; JD 2.3).
std::optional<std::int64_t> first_controlword(const AxisCore& core) {
  for (const model::ObjectWrite& setup : core.drive.setup)
    if (setup.object == core.model.controlword && setup.object != model::kNoObject) return setup.raw;
  return std::nullopt;
}

// It was found enabled, so nobody has told it its first controlword yet: that is no enabling one, and ends the torque.
Plan first_word(const AxisCore& core, std::int64_t word) {
  Plan plan;
  plan.add(Action::write(core.model.controlword, word));
  plan.add(Action::wait(torque_off(core), kStopLimit));
  return plan;
}

// A state may show a stop that stops nothing. A long ramp goes on after the answer.
void add_motor_obeys(const AxisCore& core, Plan& plan) {
  if (stop_shows(core)) plan.add(Action::wait(Effect::stop, kSlowerLimit));
}

Plan quick_stop(const AxisCore& core) {
  Plan plan;
  if (!add_command_steps(core, Command::quick_stop, plan)) return plan;
  // As soon as it is acknowledged.
  plan.actions.insert(plan.actions.begin() + (plan.actions.empty() ? 0 : 1), Action::at(Mark::quick_stopped));
  // A gate that is the gateway's own is closed when the motor has obeyed: until then it is owed what it would tell.
  const bool own_gate = core.is_virtual() && core.model.virtual_axis->gate_only;
  if (own_gate) add_motor_obeys(core, plan);
  add_virtual_controlword(core, model::controlword::kEnableVoltage, plan);
  plan.add(Action::wait(not_enabled(core), kStopLimit));
  if (!own_gate) add_motor_obeys(core, plan);
  return plan;
}

Plan disable(const AxisCore& core) {
  Plan plan;
  if (!add_command_steps(core, Command::disable, plan)) return plan;
  // Its gate is the gateway's own: that the motor obeys, only the motor shows.
  if (core.is_virtual() && core.model.virtual_axis->gate_only) add_motor_obeys(core, plan);
  add_virtual_controlword(core, kSwitchedOn, plan);
  plan.add(Action::wait(torque_off(core), kStopLimit));
  return plan;
}

// A halt must never enable: not the axis whose disable is still on its way, not the drive that has just restarted. What
// stops without that risk is the quick stop; and an axis without torque needs no halt at all.
Plan halt(const AxisCore& core) {
  if (halt_is_quick_stop(core)) return quick_stop(core);
  const model::Steps* steps = steps_of(core, Command::halt);
  Plan plan;
  if (hold_an_enabling_word(core, *steps)) {
    const ObjectState& status = core.store[core.model.statusword];
    const ObjectState& word = core.store[core.model.controlword];
    if (core.turn.link != LinkState::online || !status.known || !word.known || word.unsure) return quick_stop(core);
    if (!status.cached) return look_at_state(core);
    const bool asked_for = model::enables(core.controlword());
    if (!asked_for || !core.state().enabled()) {
      // An enable may have gone out since that was read.
      if (asked_for && !core.state_is_of_now()) return look_at_state(core);
      plan.add(Action::read(core.model.statusword));
      plan.add(Action::wait(not_enabled(core), kStopLimit));
      add_motor_obeys(core, plan);  // in a quick stop that stops nothing it turns on
      return plan;
    }
  }
  add_steps(core, *steps, plan);
  if (core.state().enabled()) add_virtual_controlword(core, model::controlword::kHalt | kEnabled, plan);
  add_motor_obeys(core, plan);  // no state tells of it
  return plan;
}

Plan by_command(const AxisCore& core, Command command) {
  if (command == Command::halt) return halt(core);
  return command == Command::quick_stop ? quick_stop(core) : disable(core);
}

Plan by_controlword(const AxisCore& core, std::uint16_t word) {
  Plan plan;
  if (core.is_virtual()) {
    plan = by_command(
        core, model::request_of(word) == model::Request402::quick_stop ? Command::quick_stop : Command::disable);
    if (plan.refused()) return plan;
  }
  plan.add(Action::write(core.model.controlword, word));
  plan.add(Action::at(Mark::controlword_passed));
  const model::Request402 request = model::request_of(word);
  // A drive that stays in quick stop active (605Ah 5 to 7) leaves it by neither 6 nor 7 (CiA 402-2, figure 2): that it
  // is not enabled is all that they can be seen by.
  const bool stays =
      core.state().state == model::State402::quick_stop_active && request != model::Request402::disable_voltage;
  const bool torque_may_stay = request == model::Request402::quick_stop || stays;
  plan.add(Action::wait(torque_may_stay ? not_enabled(core) : torque_off(core), kStopLimit));
  if (torque_may_stay && !core.is_virtual()) add_motor_obeys(core, plan);
  return plan;
}

}  // namespace

// Bit 8 of a drive whose profile knows of no halt bit would be answered as done, and the motor would run on: what its
// profile halts by is carried out in its place.
bool asks_for_missing_halt(const AxisCore& core, const WriteBatch& batch) {
  if (!batch.controlword || batch.command != Command::none || !model::enables(*batch.controlword)) return false;
  const bool rises = (*batch.controlword & ~core.controlword() & model::controlword::kHalt) != 0;
  return rises && core.state().enabled() && !halts_by_word(core);
}

Plan look_at_state(const AxisCore& core) {
  Plan plan;
  plan.add(Action::read(core.model.statusword));
  plan.add(Action::at(Mark::look_again));
  return plan;
}

bool is_enabling_word(const AxisCore& core, model::ObjectId object, std::int64_t number) {
  return object == core.model.controlword && model::enables(number);
}

model::Condition torque_off(const AxisCore& core) {
  model::Condition c = not_enabled(core);
  c.test = model::Condition::Test::not_in;
  c.values = {0x27, 0x07};
  return c;
}

Plan plan_stop(const AxisCore& core, const WriteBatch& batch, bool unheeded) {
  if (const auto word = first_controlword(core); unheeded && word && !model::enables(*word))
    return first_word(core, *word);
  const bool commanded = is_stop(batch.command);
  if (!stops_by_word(batch)) return by_command(core, batch.command);
  Plan plan = by_controlword(core, *batch.controlword);
  // Both: in the order of the write batch. A halt asks for less than any stop by controlword does.
  if (commanded && batch.command != Command::halt) static_cast<void>(append(plan, by_command(core, batch.command)));
  return plan;
}

bool halt_is_quick_stop(const AxisCore& core) {
  const auto& halt_def = core.model.command(Command::halt);
  if (!halt_def) return true;
  const int mode = core.mode_in_force();
  for (const model::CommandDef::Variant& variant : halt_def->variants)
    for (const std::int16_t m : variant.modes)
      if (m == mode) return false;
  return halt_def->quick_stop_otherwise || halt_def->steps.empty();
}

bool halts_by_position(const AxisCore& core) {
  const model::Steps* steps = halt_is_quick_stop(core) ? nullptr : steps_of(core, Command::halt);
  return steps != nullptr && std::any_of(steps->begin(), steps->end(), [](const model::Step& step) {
           return step.source == model::Step::Source::quantity && step.quantity == Quantity::position_actual;
         });
}

bool halts_by_word(const AxisCore& core) {
  return core.is_virtual() ||
         (!halt_is_quick_stop(core) && hold_an_enabling_word(core, *steps_of(core, Command::halt)));
}

void add_end_of_halt(const AxisCore& core, int mode_after, Plan& plan) {
  const std::uint16_t word = core.controlword();
  if ((word & model::controlword::kHalt) == 0) return;
  constexpr std::uint16_t kShutdown = 0x0006, kTake = 0x0030;  // new set-point, change at once
  if (core.is_virtual()) {
    // Bit 8 falling does nothing: what was halted is over.
    plan.add(Action::write(core.model.controlword, word & static_cast<std::uint16_t>(~model::controlword::kHalt)));
    return;
  }
  if (!core.state().enabled()) {
    plan.add(Action::write(core.model.controlword, kShutdown));  // ending a halt never enables
    return;
  }
  add_running_targets(core, false, plan);
  const model::Binding* target = core.model.binding(Quantity::target_position);
  const bool takes_target =
      !core.is_continuous(core.mode_in_force()) && target != nullptr && !core.object(target->object).trigger;
  const bool leaves_mode = takes_target && core.mode_in_force() != 1;
  if (takes_target) {
    // A halted homing would go on, and so would a move whose target was merely overwritten: the drive must have taken
    // the new set-point, the present position, before bit 8 falls.
    if (leaves_mode) add_mode(core, 1, plan);
    plan.add(Action::write(core.model.controlword, model::controlword::kHalt | kEnabled));
    add_target_here(core, plan);
    plan.add(Action::write(core.model.controlword, model::controlword::kHalt | kEnabled | kTake));
  }
  plan.add(Action::write(core.model.controlword, kEnabled));
  if (leaves_mode && mode_after != 1) add_mode(core, mode_after, plan);
}

}  // namespace axisgate::drive
