// SPDX-License-Identifier: Apache-2.0
// Controlword and mode of a virtual axis: the drive has neither, so their bits become its commands (design 3.4).
#include <algorithm>
#include <array>

#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

// 6 or 7 in a block of registers is no stop, but what was enabled ends by it all the same.
Plan plan_close(const AxisCore& core) {
  Plan plan;
  if (core.state().enabled()) static_cast<void>(add_command_steps(core, Command::disable, plan));
  return plan;
}

// The steps before it were gone, and nothing stands against it: the word enables.
bool opens(const AxisFacts& facts) { return !facts.faulted() && facts.state != model::State402::switch_on_disabled; }

Plan plan_open(const AxisCore& core) {
  if (core.alarm(AxisAlarm::local_control)) return Plan::refuse(Errc::state_unsuitable);
  Plan plan;
  const AxisFacts facts = core.facts();
  if (facts.faulted()) return plan;  // as a servo does: the word is taken, and nothing comes of it
  // Nor without the steps before it, where it is the drive that would be enabled.
  if (!core.model.virtual_axis->gate_only && !opens(facts)) return plan;
  add_quiet_setpoint(core, steps_of(core, Command::enable), plan);
  static_cast<void>(add_command_steps(core, Command::enable, plan));
  return plan;
}

// Bit 4 rising, by the mode in force.
std::optional<Command> start_of(const AxisCore& core, std::uint16_t word) {
  const int mode = core.mode_in_force();
  if (mode == 1) return (word & model::controlword::kRelative) != 0 ? Command::move_relative : Command::move_absolute;
  return mode == 6 ? std::optional(Command::home) : std::nullopt;
}

// In velocity or torque mode an enabled axis follows its target: what was asked for since the last stop, else nothing.
Plan plan_follow(const AxisCore& core) {
  Plan plan;
  plan.add(Action::run_raw(true));
  const auto quantity = setpoint_of_mode(core.mode_in_force());
  if (!quantity) return plan;
  const Wanted wanted = core.running_target(*quantity).value_or(Wanted{});
  if (wanted.value == 0 && wanted.exact.value_or(0) == 0) return plan;
  if (quantity == Quantity::target_velocity) {
    static_cast<void>(append(plan, plan_command(core, Command::run_velocity, core.mode_in_force())));
  } else if (!add_write(core, *quantity, wanted, plan)) {
    return Plan::refuse(Errc::bad_value);
  }
  return plan;
}

}  // namespace

void add_virtual_controlword(const AxisCore& core, std::uint16_t controlword, Plan& plan) {
  if (core.is_virtual()) plan.add(Action::write(core.model.controlword, controlword));
}

// CiA 402-2 table 28: shutdown, switch on, enable operation.
void add_virtual_enable(const AxisCore& core, Plan& plan) {
  constexpr std::array<std::uint16_t, 3> kSteps{0x0006, 0x0007, 0x000F};
  for (const std::uint16_t word : kSteps) {
    add_virtual_controlword(core, word, plan);
    for (const AxisCore* other : core.shared()) add_virtual_controlword(*other, word, plan);
  }
}

Plan plan_virtual_mode(const AxisCore& core, std::int16_t mode, bool asked_for) {
  const auto& modes = core.model.modes;
  if (std::ranges::none_of(modes, [&](const auto& m) { return m.first == mode; })) return Plan::refuse(Errc::bad_value);
  Plan plan;
  if (core.mode_in_force() == mode) return plan;
  const AxisFacts facts = core.facts();
  if (core.model.mode_needs_disabled && facts.enabled()) return Plan::refuse(Errc::state_unsuitable);
  if (core.another_runs()) return Plan::refuse(Errc::busy);
  // A command replaces what runs by itself; a mode alone would leave it running unseen.
  if (asked_for && facts.enabled() && (facts.moving || core.motion.running() != MotionKind::none) &&
      !add_command_steps(core, Command::halt, plan))
    return plan;
  plan.add(Action::write(core.model.mode, mode));
  for (const AxisCore* other : core.shared()) plan.add(Action::write(other->model.mode, mode));
  plan.add(Action::at(Mark::mode_changed));
  return plan;
}

Plan plan_virtual_controlword(const AxisCore& core, std::uint16_t word) {
  Plan plan;
  const AxisFacts facts = core.facts();
  const std::uint16_t before = core.controlword();
  const model::Request402 request = model::request_of(word);
  const bool enables = request == model::Request402::enable_operation;
  const bool halts = facts.enabled() && model::rising(before, word, model::controlword::kHalt);

  // What is "so already" is not sent: by a state that was read after the last sending alone.
  const bool so_already = enables ? facts.enabled() && !word_starts(core, word, true)
                                  : request != model::Request402::other && !facts.enabled();
  if (so_already && !core.state_is_of_now()) return look_at_state(core);
  if (model::rising(before, word, model::controlword::kFaultReset) && facts.faulted() &&
      !append(plan, plan_command(core, Command::fault_reset, 0)))
    return plan;
  if (!enables && request != model::Request402::other && !append(plan, plan_close(core))) return plan;
  if (enables && !facts.enabled() && !append(plan, plan_open(core))) return plan;
  if (halts && !add_command_steps(core, Command::halt, plan)) return plan;
  plan.add(Action::write(core.model.controlword, word));
  plan.add(Action::at(Mark::controlword_passed));
  if (halts) plan.add(Action::at(Mark::halted));

  const bool halted = (word & model::controlword::kHalt) != 0;
  if (!enables || halted) return plan;
  if (facts.enabled() && word_starts(core, word, true)) {
    if (const auto command = start_of(core, word)) {
      const Plan judged = plan_preparation(core, *command);
      if (judged.refused()) return judged;
      static_cast<void>(append(plan, plan_command(core, *command, core.mode_in_force())));
    }
  } else if (!facts.enabled() && opens(facts) && core.is_continuous(core.mode_in_force())) {
    static_cast<void>(append(plan, plan_follow(core)));
  }
  return plan;
}

}  // namespace axisgate::drive
