// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

constexpr Duration kSaveLimit = std::chrono::seconds(2);  // design 3.4, command 12
constexpr Duration kHomingShows = std::chrono::seconds(2);
constexpr std::int16_t kModePosition = 1, kModeVelocity = 3, kModeTorque = 4, kModeHoming = 6;
constexpr std::uint16_t kEnabledBits = 0x000F;

// What the command requires before anything else.
void add_requirements(const AxisCore& core, Command command, Plan& plan) {
  const model::Steps* const steps = steps_of(core, command);
  if (steps == nullptr) return;
  const auto end = std::ranges::find_if(*steps, [](auto& s) { return s.verb != model::Step::Verb::require; });
  add_steps(core, model::Steps(steps->begin(), end), plan);
}

// homing_method must have been written or configured since bring-up and be in the profile's list.
std::optional<std::int64_t> homing_method(const AxisCore& core) {
  const auto& list = core.model.homing_methods;
  const auto method = core.homing_method();
  return method && std::ranges::find(list, *method) != list.end() ? method : std::nullopt;
}

// The drive runs on and on towards a switch that no input listens to.
bool switch_is_there(const AxisCore& core, std::int64_t method) {
  return std::ranges::all_of(core.model.homing_needs, [&](const model::HomingNeed& need) {
    const auto has = [&](model::ObjectId id) { return core.store[id].known && core.store[id].number == need.equals; };
    return need.method != method || std::ranges::any_of(need.any_of, has);
  });
}

std::optional<std::int16_t> mode_needed(const AxisCore& core, Command command) {
  switch (command) {
    case Command::move_absolute:
    case Command::move_relative:
      return kModePosition;
    case Command::run_velocity:
      return kModeVelocity;
    case Command::run_torque:
      return kModeTorque;
    case Command::home:
      return kModeHoming;
    case Command::set_position:
      // Whatever the profile's steps are: in a mode that moves, a controlword among them would start the target that
      // the drive still holds, and a position that jumps is a way to go. A drive without CiA 402 has means of its own.
      return core.is_virtual() ? std::nullopt : std::optional(kModeHoming);
    case Command::enable:
      break;
    default:
      return std::nullopt;
  }
  if (core.state().enabled() || core.mode_chosen || core.model.mode == model::kNoObject) return std::nullopt;
  // Enabling in a mode that nobody chose must not follow pulses, as a drive's own mode may that it has left its factory
  // in. The first that the drive has: a frequency converter has the velocity alone.
  static constexpr std::array kQuiet{kModePosition, kModeVelocity, kModeTorque, kModeHoming};
  const int mode = core.mode_in_force();
  if (std::ranges::find(kQuiet, mode) != kQuiet.end() || core.model.is_own_velocity_mode(mode)) return std::nullopt;
  const auto has = [&](std::int16_t each) {
    return std::ranges::any_of(core.model.modes, [each](const auto& row) { return row.first == each; });
  };
  const auto* const quiet = std::ranges::find_if(kQuiet, has);
  return quiet == kQuiet.end() ? kModePosition : *quiet;
}

// Nothing has ended motions for good since its target was asked for; one that waits for its turn counts.
Errc judge_run(const AxisCore& core, Quantity target) {
  if (core.model.binding(target) == nullptr) return Errc::not_supported;
  return core.running_target(target) || core.asked.accepted(target) ? Errc::ok : Errc::state_unsuitable;
}

// What can be told before anything is sent.
Errc admissible(const AxisCore& core, Command command) {
  const AxisFacts facts = core.facts();
  const bool at_rest = core.motion.at_rest(facts);
  switch (command) {
    case Command::enable:
      return facts.faulted() || core.alarm(AxisAlarm::local_control) ? Errc::state_unsuitable : Errc::ok;
    case Command::move_absolute:
      return judge_move(core, false);
    case Command::move_relative:
      return at_rest ? judge_move(core, true) : Errc::busy;
    case Command::run_velocity:
      return judge_run(core, Quantity::target_velocity);
    case Command::run_torque: {
      if (const Errc code = judge_run(core, Quantity::target_torque); code != Errc::ok) return code;
      const model::Binding* limit = core.model.binding(Quantity::max_velocity);
      const bool there = limit != nullptr && limit->object != model::kNoObject && !core.store[limit->object].refused;
      return there ? Errc::ok : Errc::bad_value;
    }
    case Command::home:
      if (!homing_method(core)) return Errc::bad_value;
      return switch_is_there(core, *homing_method(core)) ? Errc::ok : Errc::state_unsuitable;
    case Command::set_position: {
      const auto& def = core.model.command(command);
      if (def && def->zero_only && core.set_position_value != 0) return Errc::bad_value;
      return at_rest ? Errc::ok : Errc::busy;
    }
    case Command::save_parameters:
      return facts.enabled() || facts.state == model::State402::quick_stop_active ||
                     facts.state == model::State402::fault_reaction_active
                 ? Errc::busy
                 : Errc::ok;
    default:
      return Errc::ok;
  }
}

// A drive leaves the quick stop at the ramp's end or stays in it (605Ah): either ends the wait, and then it is planned
// anew.
void add_look_at_ramp(const AxisCore& core, Plan& plan) {
  constexpr Duration kBetweenLooks = std::chrono::milliseconds(20);
  model::Condition left;
  left.object = core.model.statusword;
  left.mask = 0x6F;
  left.test = model::Condition::Test::not_equals;
  left.values = {0x07};
  plan.add(Action::wait(left, kBetweenLooks, true));
  const model::ObjectId speed = core.motion_object();
  if (speed != model::kNoObject) plan.add(Action::read(speed));
  plan.add(Action::at(Mark::look_again));
}

Plan plan_enable(const AxisCore& core) {
  Plan plan;
  const AxisFacts facts = core.facts();
  if (facts.enabled()) {
    // A stop may have gone out since that was read.
    if (!core.state_is_of_now()) return look_at_state(core);
    // Found so, or enabled by somebody else: from now on it is so by our word.
    if (!facts.commanded) add_virtual_controlword(core, kEnabledBits, plan);
    plan.add(Action::at(Mark::found_enabled));
    return plan;
  }
  // The first step takes the torque away: a ramp under way is let to its end before, however long the client waits.
  if (facts.state == model::State402::quick_stop_active && facts.moving) {
    add_look_at_ramp(core, plan);
    return plan;
  }
  // Before torque comes on, velocity and torque set-points are made 0 and a position set-point the actual position.
  add_running_targets(core, false, plan);
  add_target_here(core, plan);
  add_quiet_setpoint(core, steps_of(core, Command::enable), plan);
  if (!add_command_steps(core, Command::enable, plan)) return plan;
  add_virtual_enable(core, plan);
  plan.add(Action::at(Mark::enabled));
  return plan;
}

Plan plan_fault_reset(const AxisCore& core) {
  Plan plan;
  if (!core.state().faulted()) return core.state_is_of_now() ? plan : look_at_state(core);
  if (add_command_steps(core, Command::fault_reset, plan)) plan.add(Action::at(Mark::values_invalidated));
  return plan;
}

Plan plan_move(const AxisCore& core, Command command) {
  auto wanted = core.target_position();
  if (!wanted) return Plan::refuse(Errc::state_unsuitable);
  const bool relative = command == Command::move_relative;
  if (const Errc code = judge_move(core, relative); code != Errc::ok) return Plan::refuse(code);
  if (relative && steps_of(core, Command::move_relative) == nullptr) {
    // No relative move documented as edge-triggered: carried out as an absolute one.
    const auto base = core.setpoint_position();
    if (!base) {
      Plan look;
      look.add(Action::read(core.object_of(Quantity::position_actual)));
      look.add(Action::at(Mark::look_again));
      return look;
    }
    wanted = Wanted{wanted->value + *base};
    command = Command::move_absolute;
  }
  const model::Binding* target = core.model.binding(Quantity::target_position);
  const auto raw = raw_of(core, *target, *wanted);
  if (!raw) return Plan::refuse(Errc::bad_value);
  Plan plan;
  // A drive that follows its target would take even a distance for one.
  if (core.state().enabled() && (core.controlword() & core.model.cia402.follow_bits) != 0)
    plan.add(Action::write(core.model.controlword, core.controlword() & kEnabledBits));
  add_speeds(core, 1, plan);
  Plan steps;
  if (!add_command_steps(core, command, steps)) return steps;
  bool written = false;
  for (Action& a : steps.actions) {
    if (a.kind != Action::Kind::write || a.object != target->object) continue;
    a.number = *raw;
    written = true;
  }
  if (!written && !add_write(core, Quantity::target_position, *wanted, plan)) return Plan::refuse(Errc::bad_value);
  const bool distance = command == Command::move_relative;
  // A virtual axis tells by the position whether it arrived: where it starts must be known for that.
  if (distance && core.is_virtual()) plan.add(Action::read(core.model.binding(Quantity::position_actual)->object));
  append(plan, std::move(steps));
  Action start = Action::at(Mark::start_discrete);
  start.number = distance ? 1 : 0;
  if (!distance) start.ends_at = wanted->exact ? target->to_register(*raw) : wanted->value;
  plan.add(std::move(start));
  return plan;
}

// Commands 8 and 9: the set-point was 0 while the mode changed, and is what was asked for once it runs.
Plan plan_run(const AxisCore& core, Command command) {
  const bool velocity = command == Command::run_velocity;
  const Quantity quantity = velocity ? Quantity::target_velocity : Quantity::target_torque;
  const model::Binding* binding = core.model.binding(quantity);
  const auto wanted = core.running_target(quantity);
  if (!wanted) return Plan::refuse(binding == nullptr ? Errc::not_supported : Errc::state_unsuitable);
  Plan steps;
  if (!add_command_steps(core, command, steps)) return steps;
  Plan plan;
  add_speeds(core, velocity ? 3 : 4, plan);
  const bool by_steps = writes(steps, binding->object);
  // Where the drive must be told to run, it must know how fast before.
  if (core.is_virtual() && !by_steps && !add_write(core, quantity, *wanted, plan)) return Plan::refuse(Errc::bad_value);
  append(plan, std::move(steps));
  if (!core.is_virtual() && !by_steps && !add_write(core, quantity, *wanted, plan))
    return Plan::refuse(Errc::bad_value);
  plan.add(Action::at(velocity ? Mark::start_velocity : Mark::start_torque));
  return plan;
}

Plan plan_home(const AxisCore& core) {
  const auto method = homing_method(core);
  if (!method) return Plan::refuse(Errc::bad_value);
  Plan plan;
  add_speeds(core, 6, plan);
  if (!add_write(core, Quantity::homing_method, {*method}, plan)) return Plan::refuse(Errc::bad_value);
  // A set_position that failed half-way may have left 0 there.
  if (const auto offset = core.asked.owed(Quantity::homing_offset)) {
    if (!add_write(core, Quantity::homing_offset, {*offset}, plan)) return Plan::refuse(Errc::bad_value);
    plan.add(Action::at(Mark::return_homing));
  }
  plan.add(Action::at(Mark::not_homed));
  // What tells of a homing in this mode may have meant something else in the mode before.
  if (core.model.homed && !core.is_virtual()) plan.add(Action::read(core.model.homed->object));
  if (!add_command_steps(core, Command::home, plan)) return plan;
  // A virtual axis tells from what it sees since the start whether it has homed; of another an old bit may stand still.
  if (core.is_virtual()) plan.add(Action::at(Mark::start_homing));
  plan.add(Action::wait(Effect::homing, kHomingShows));
  if (!core.is_virtual()) plan.add(Action::at(Mark::start_homing));
  return plan;
}

Plan plan_save(const AxisCore& core) {
  Plan plan;
  static_cast<void>(add_command_steps(core, Command::save_parameters, plan));
  for (Action& a : plan.actions)
    if (a.kind == Action::Kind::wait) a.limit = std::min(a.limit, kSaveLimit);
  return plan;
}

}  // namespace

bool append(Plan& plan, Plan more) {
  if (more.refused()) {
    plan.refusal = more.refusal;
    return false;
  }
  for (Action& a : more.actions) plan.add(std::move(a));
  return true;
}

Errc judge_move(const AxisCore& core, bool relative) {
  const model::Binding* target = core.model.binding(Quantity::target_position);
  const auto wanted = core.target_position();
  if (target == nullptr || !wanted) return Errc::state_unsuitable;
  std::int64_t end = wanted->value;
  if (relative) {
    const auto known = core.setpoint_position();
    const auto base = known ? known : core.value(Quantity::position_actual);
    if (!base) return Errc::state_unsuitable;
    end += *base;
  }
  return position_range(core).holds(end) ? Errc::ok : Errc::bad_value;
}

bool refused_by_state(const AxisCore& core, Command command) {
  const bool needs_rest = command == Command::move_relative || command == Command::set_position;
  const AxisFacts facts = core.facts();
  return needs_ready(command) && !(core.motion.may_start(facts) && (!needs_rest || core.motion.at_rest(facts)));
}

bool accepts_nothing(const AxisCore& core, const WriteBatch& batch) {
  const bool value_alone = batch.set_position_value && batch.command != Command::set_position;
  if (batch.command == Command::none || is_stop(batch.command) || batch.mode || batch.controlword || batch.object ||
      value_alone || batch.jog_velocity)
    return false;
  const bool with_command =
      std::all_of(batch.setpoints.begin(), batch.setpoints.end(), [](const Setpoint& sp) { return sp.with_command; });
  if (!batch.setpoints.empty() && !(with_command && refused_by_state(core, batch.command))) return false;
  return plan_preparation(core, batch.command).refused();
}

Plan plan_preparation(const AxisCore& core, Command command) {
  const bool is_motion = needs_ready(command);
  if (is_motion && !core.motion.may_start(core.facts())) return Plan::refuse(Errc::state_unsuitable);
  if (const Errc code = admissible(core, command); code != Errc::ok) return Plan::refuse(code);
  if (const Errc code = judge_shared(core, command); code != Errc::ok) return Plan::refuse(code);
  Plan plan;
  // Torque without a speed limit runs away: what was invalidated since is read back before it counts as cached.
  const model::Binding* limit = core.model.binding(Quantity::max_velocity);
  if (command == Command::run_torque && !core.store[limit->object].cached) plan.add(Action::read(limit->object));
  const auto mode = mode_needed(core, command);
  // Refused, it must leave what runs as it was, its mode too.
  if (mode && *mode != core.mode_in_force()) add_requirements(core, command, plan);
  if (is_motion) add_end_of_halt(core, mode.value_or(core.mode_in_force()), plan);
  if (!mode || writes(plan, core.model.mode)) return plan;
  if (core.is_continuous(*mode) && core.mode_in_force() != *mode) add_running_targets(core, false, plan);
  static_cast<void>(append(plan, plan_mode(core, *mode)));
  return plan;
}

Plan plan_command(const AxisCore& core, Command command, int mode_before) {
  switch (command) {
    case Command::enable:
      return plan_enable(core);
    case Command::fault_reset:
      return plan_fault_reset(core);
    case Command::move_absolute:
    case Command::move_relative:
      return plan_move(core, command);
    case Command::run_velocity:
    case Command::run_torque:
      return plan_run(core, command);
    case Command::home:
      return plan_home(core);
    case Command::set_position:
      return plan_set_position(core, mode_before);
    case Command::save_parameters:
      return plan_save(core);
    case Command::end_halt: {
      Plan plan;
      add_end_of_halt(core, core.mode_in_force(), plan);
      return plan;
    }
    default:
      return Plan::refuse(Errc::not_supported);
  }
}

}  // namespace axisgate::drive
