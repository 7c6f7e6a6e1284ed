// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

constexpr Duration kEnableShows = std::chrono::milliseconds(300);

model::Condition torque_on(const AxisCore& core) {
  model::Condition c = torque_off(core);
  c.test = model::Condition::Test::equals;
  c.values = {0x27};  // operation enabled
  return c;
}

// A raw start: the set-point held back until now goes first, and the move must lie within the limits.
Plan plan_raw_move(const AxisCore& core, std::uint16_t word) {
  const bool relative = (word & model::controlword::kRelative) != 0;
  if (relative && !core.motion.at_rest(core.facts())) return Plan::refuse(Errc::busy);  // never added
  if (const Errc code = judge_move(core, relative); code != Errc::ok) return Plan::refuse(code);
  Plan plan;
  add_speeds(core, 1, plan);
  const auto target = core.asked.taken(Quantity::target_position);
  if (target && !add_write(core, Quantity::target_position, *target, plan)) return Plan::refuse(Errc::bad_value);
  return plan;
}

Plan plan_raw_homing(const AxisCore& core) {
  const auto method = core.homing_method();
  if (!method) return Plan::refuse(Errc::bad_value);
  Plan plan;
  add_speeds(core, 6, plan);
  if (!add_write(core, Quantity::homing_method, {*method}, plan)) return Plan::refuse(Errc::bad_value);
  plan.add(Action::at(Mark::not_homed));
  return plan;
}

}  // namespace

// The words of an enable and of a fault reset go through "disable": a motor that runs beside would lose its torque.
Errc judge_shared(const AxisCore& core, Command command) {
  if (command == Command::fault_reset) return core.another_runs() ? Errc::busy : Errc::ok;
  if (command != Command::enable) return Errc::ok;
  if (core.motion.latched_by_another()) return Errc::state_unsuitable;
  for (const AxisCore* other : core.shared())
    if (other->state().faulted() || other->alarm(AxisAlarm::local_control)) return Errc::state_unsuitable;
  return !core.state().enabled() && core.another_runs() ? Errc::busy : Errc::ok;
}

// Bit 4 rising starts; so does the maker's bit that makes the drive follow its target, even in the word that enables.
bool word_starts(const AxisCore& core, std::uint16_t word, bool enabled) {
  const std::uint16_t before = core.controlword();
  const std::uint16_t follow_bits = core.is_virtual() ? std::uint16_t{0} : core.model.cia402.follow_bits;
  const bool follows = (word & model::controlword::kStart) != 0 && (word & follow_bits) != 0;
  if (!enabled) return follows && model::enables(word);
  return model::rising(before, word, model::controlword::kStart) ||
         (follows && model::rising(before, word, follow_bits));
}

Plan plan_controlword(const AxisCore& core, std::uint16_t word, bool command_follows) {
  const model::Request402 request = model::request_of(word);
  if (!core.motion.passes(request)) return Plan::refuse(Errc::state_unsuitable);
  if (core.is_virtual()) return plan_virtual_controlword(core, word);
  Plan plan;
  const AxisFacts facts = core.facts();
  const std::uint16_t before = core.controlword();
  const bool enables = request == model::Request402::enable_operation;
  const bool halts = facts.enabled() && model::rising(before, word, model::controlword::kHalt);
  const bool moves = facts.mode == 1 && word_starts(core, word, facts.enabled());
  const bool homes = facts.enabled() && facts.mode == 6 && model::rising(before, word, model::controlword::kStart);

  // Whether a drive takes bit 4 of the word that enables it for a start no sheet says.
  const bool may_move = !moves && facts.mode == 1 && enables && (word & model::controlword::kStart) != 0;
  if (may_move && !facts.enabled() && judge_move(core, (word & model::controlword::kRelative) != 0) == Errc::bad_value)
    return Plan::refuse(Errc::bad_value);

  const bool halted = (word & model::controlword::kHalt) != 0;
  const bool runs = enables && !halted && is_continuous(facts);

  if (model::rising(word, before, model::controlword::kHalt)) {
    add_end_of_halt(core, facts.mode, plan);  // bit 8 falls: nothing resumes
  } else if (enables && (runs || !facts.enabled())) {
    // What survives: velocity and torque that nobody has written anew since the last stop, fault or disable are made 0.
    add_running_targets(core, true, plan);
    if (!facts.enabled() && (facts.mode == 7 || facts.mode == 8)) add_target_here(core, plan);
  }
  if (runs) add_speeds(core, facts.mode, plan);
  if (moves && !append(plan, plan_raw_move(core, word))) return plan;
  if (homes && !append(plan, plan_raw_homing(core))) return plan;

  plan.add(Action::write(core.model.controlword, word));
  plan.add(Action::at(Mark::controlword_passed));
  if (model::rising(before, word, model::controlword::kFaultReset))
    plan.add(Action::at(Mark::values_invalidated, core.model.controlword));
  if (halts) plan.add(Action::at(Mark::halted));
  if (moves) plan.add(Action::at(Mark::start_discrete));
  if (homes) plan.add(Action::at(Mark::start_homing));
  if (runs) plan.add(Action::run_raw(!facts.enabled()));
  // A command that finds the axis as enabled as before would be told done, and the axis is disabled.
  const bool disables = !enables && request != model::Request402::other && facts.enabled();
  if (disables && command_follows) plan.add(Action::wait(torque_off(core), kStopLimit));
  // And one that finds it as disabled as before would take the torque away once more.
  if (enables && !facts.enabled() && command_follows) plan.add(Action::wait(torque_on(core), kEnableShows, true));
  return plan;
}

}  // namespace axisgate::drive
