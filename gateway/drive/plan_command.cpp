#include <algorithm>

#include "gateway/drive/planner.hpp"

namespace axisgate::drive {
namespace {

constexpr Duration kSaveLimit = std::chrono::seconds(2);  // design 3.4, command 12
constexpr std::int16_t kModePosition = 1, kModeVelocity = 3, kModeTorque = 4, kModeHoming = 6;
constexpr std::int64_t kMethodPresentPosition = 35;  // CiA 402-2 table 100: homing on the present position

// Appends another plan; false where that one is refused (its refusal becomes this plan's).
bool append(Plan& plan, Plan more) {
  if (more.refused()) {
    plan.refusal = more.refusal;
    return false;
  }
  for (Action& a : more.actions) plan.add(std::move(a));
  return true;
}

bool add_command_steps(const AxisCore& core, Command command, Plan& plan) {
  const Steps* steps = steps_of(core, command);
  if (steps == nullptr) {
    plan.refusal = {Errc::not_supported, 0};
    return false;
  }
  add_steps(core, *steps, plan);
  return true;
}

// homing_method must have been written or configured since bring-up and be in the profile's list.
std::optional<std::int64_t> homing_method(const AxisCore& core) {
  const auto chosen = core.homing_method_given ? core.value(Quantity::homing_method)
                                               : std::optional<std::int64_t>(core.model.homing_method);
  const auto& list = core.model.homing_methods;
  if (!chosen || std::find(list.begin(), list.end(), *chosen) == list.end()) return std::nullopt;
  return chosen;
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
    case Command::set_position:
      return kModeHoming;
    case Command::enable:
      break;
    default:
      return std::nullopt;
  }
  if (core.facts().enabled() || core.mode_chosen || core.model.mode == kNoObject) return std::nullopt;
  // Enabling in a mode that nobody chose must not follow pulses: Kinco leaves the factory in -4 (pulse train).
  const int mode = core.mode_in_force();
  const bool quiet = mode == 1 || mode == 3 || mode == 4 || mode == 6 || mode == -3;
  return quiet ? std::nullopt : std::optional(kModePosition);
}

// What can be told before anything is sent.
Errc admissible(const AxisCore& core, Command command) {
  const AxisFacts facts = core.facts();
  const bool at_rest = !facts.moving && core.motion.running() == MotionKind::none;
  switch (command) {
    case Command::enable:
      return facts.faulted() || core.alarm(AxisAlarm::local_control) ? Errc::state_unsuitable : Errc::ok;
    case Command::move_relative:
      return at_rest ? Errc::ok : Errc::busy;
    case Command::run_torque: {
      // Torque without a speed limit runs away: max_velocity must be one the drive is known to hold.
      const Binding* limit = core.model.binding(Quantity::max_velocity);
      const bool held = limit != nullptr && limit->object != kNoObject && core.store[limit->object].held;
      return held ? Errc::ok : Errc::bad_value;
    }
    case Command::home:
      return homing_method(core) ? Errc::ok : Errc::bad_value;
    case Command::set_position: {
      const auto& def = core.model.command(command);
      if (def && def->zero_only && core.set_position_value != 0) return Errc::bad_value;
      return at_rest ? Errc::ok : Errc::busy;
    }
    case Command::save_parameters:
      return facts.enabled() || facts.state == State402::quick_stop_active ? Errc::busy : Errc::ok;
    default:
      return Errc::ok;
  }
}

Plan plan_enable(const AxisCore& core) {
  Plan plan;
  if (core.facts().enabled()) {
    plan.add(Action::at(Mark::enabled));
    return plan;
  }
  // Before torque comes on, velocity and torque set-points are made 0 and a position set-point the actual position.
  add_zero_targets(core, plan);
  const Binding* target = core.model.binding(Quantity::target_position);
  const Binding* actual = core.model.binding(Quantity::position_actual);
  if (target != nullptr && actual != nullptr && target->writable && !core.held_back(Quantity::target_position)) {
    plan.add(Action::read(actual->object));
    plan.add(Action::copy(actual->object, target->object));
  }
  if (!add_command_steps(core, Command::enable, plan)) return plan;
  plan.add(Action::at(Mark::enabled));
  return plan;
}

Plan plan_fault_reset(const AxisCore& core) {
  Plan plan;
  if (!core.facts().faulted()) return plan;
  if (add_command_steps(core, Command::fault_reset, plan)) plan.add(Action::at(Mark::values_doubtful));
  return plan;
}

Plan plan_move(const AxisCore& core, Command command) {
  const auto wanted = core.target(Quantity::target_position);
  const Binding* target = core.model.binding(Quantity::target_position);
  if (!wanted || target == nullptr) return Plan::refuse(Errc::state_unsuitable);
  std::int64_t value = *wanted;
  std::int64_t end = value;
  if (command == Command::move_relative) {
    const auto actual = core.value(Quantity::position_actual);
    if (!actual) return Plan::refuse(Errc::state_unsuitable);
    end += *actual;
    if (steps_of(core, Command::move_relative) == nullptr) {
      // No relative move documented as edge-triggered: carried out as an absolute one.
      value = end;
      command = Command::move_absolute;
    }
  }
  if (!target->limits.holds(end)) return Plan::refuse(Errc::bad_value);
  Plan plan;
  if (!add_write(core, Quantity::target_position, value, plan)) return Plan::refuse(Errc::bad_value);
  if (add_command_steps(core, command, plan)) plan.add(Action::at(Mark::start_discrete));
  return plan;
}

// Commands 8 and 9: the set-point was 0 while the mode changed, and is what was asked for once it runs.
Plan plan_run(const AxisCore& core, Command command) {
  const bool velocity = command == Command::run_velocity;
  const Quantity quantity = velocity ? Quantity::target_velocity : Quantity::target_torque;
  const auto wanted = core.target(quantity);
  const Binding* binding = core.model.binding(quantity);
  if (!wanted || binding == nullptr) return Plan::refuse(Errc::state_unsuitable);
  const auto raw = binding->to_raw(*wanted, core.object(binding->object));
  if (!raw) return Plan::refuse(Errc::bad_value);
  Plan plan;
  if (!add_command_steps(core, command, plan)) return plan;
  const bool written = std::any_of(plan.actions.begin(), plan.actions.end(), [&](const Action& a) {
    return a.kind == Action::Kind::write && a.object == binding->object;
  });
  if (!written && !add_write(core, quantity, *wanted, plan)) return Plan::refuse(Errc::bad_value);
  plan.add(Action::at(velocity ? Mark::start_velocity : Mark::start_torque));
  return plan;
}

Plan plan_home(const AxisCore& core) {
  const auto method = homing_method(core);
  if (!method) return Plan::refuse(Errc::bad_value);
  Plan plan;
  if (!add_write(core, Quantity::homing_method, *method, plan)) return Plan::refuse(Errc::bad_value);
  plan.add(Action::at(Mark::not_homed));
  if (add_command_steps(core, Command::home, plan)) plan.add(Action::at(Mark::start_homing));
  return plan;
}

// By the drive's own homing on the present position; what it needs for that is put back afterwards.
Plan plan_set_position(const AxisCore& core, int mode_before) {
  const Binding* actual = core.model.binding(Quantity::position_actual);
  Plan plan;
  struct Saved {
    Quantity quantity;
    std::int64_t during;
    std::optional<std::int64_t> before;
  };
  std::array<Saved, 2> saved{{{Quantity::homing_offset, 0, core.value(Quantity::homing_offset)},
                              {Quantity::homing_method, kMethodPresentPosition, core.value(Quantity::homing_method)}}};
  for (const Saved& s : saved)
    if (core.model.binding(s.quantity) != nullptr && !add_write(core, s.quantity, s.during, plan))
      return Plan::refuse(Errc::bad_value);
  if (!add_command_steps(core, Command::set_position, plan)) return plan;
  if (actual != nullptr && actual->object != kNoObject) {
    Condition there;  // read back: the counter itself says so
    there.object = actual->object;
    const auto raw = actual->to_raw(core.set_position_value, core.object(actual->object));
    if (!raw) return Plan::refuse(Errc::bad_value);
    // A standing servo hunts a few counts around its set-point.
    constexpr std::int64_t kHunting = 5;
    there.test = Condition::Test::in;
    for (std::int64_t d = -kHunting; d <= kHunting; ++d) there.values.push_back(*raw + d);
    plan.add(Action::wait(there, std::chrono::milliseconds(500)));
  }
  plan.add(Action::at(Mark::values_doubtful));
  // Unconditionally: what is held now says nothing about what is held then.
  constexpr std::int64_t kEnabled = 0x0F;
  plan.add(Action::write(core.model.controlword, kEnabled));
  for (const Saved& s : saved) {
    const Binding* binding = core.model.binding(s.quantity);
    if (binding == nullptr || !s.before || *s.before == s.during) continue;
    if (const auto raw = binding->to_raw(*s.before, core.object(binding->object)))
      plan.add(Action::write(binding->object, *raw));
  }
  if (mode_before != 0 && mode_before != kModeHoming) {
    Plan back = plan_mode(core, static_cast<std::int16_t>(mode_before));
    if (!back.refused()) static_cast<void>(append(plan, std::move(back)));
  }
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

const Steps* steps_of(const AxisCore& core, Command command) {
  const auto& def = core.model.command(command);
  if (!def) return nullptr;
  const int mode = core.mode_in_force();
  for (const CommandDef::Variant& variant : def->variants)
    if (std::find(variant.modes.begin(), variant.modes.end(), mode) != variant.modes.end()) return &variant.steps;
  return def->steps.empty() && !def->variants.empty() ? nullptr : &def->steps;
}

void add_steps(const AxisCore& core, const Steps& steps, Plan& plan) {
  for (const Step& step : steps) {
    switch (step.verb) {
      case Step::Verb::write:
        if (step.source == Step::Source::literal) {
          plan.add(Action::write(step.object, step.literal));
        } else if (step.quantity == Quantity::position_actual) {
          const Binding* actual = core.model.binding(Quantity::position_actual);
          if (actual == nullptr) break;
          plan.add(Action::read(actual->object));
          plan.add(Action::copy(actual->object, step.object));
        } else if (const auto value = core.target(step.quantity)) {
          static_cast<void>(add_write(core, step.quantity, *value, plan));
        }
        break;
      case Step::Verb::wait:
        plan.add(Action::wait(step.until, step.limit, step.optional, step.otherwise));
        break;
      case Step::Verb::require:
        plan.add(Action::wait(step.until, Duration{}, false, step.otherwise));
        break;
    }
  }
}

Plan plan_preparation(const AxisCore& core, Command command) {
  const bool is_motion = command >= Command::move_absolute && command <= Command::set_position;
  if (is_motion && !core.motion.may_start(core.facts())) return Plan::refuse(Errc::state_unsuitable);
  if (const Errc code = admissible(core, command); code != Errc::ok) return Plan::refuse(code);
  Plan plan;
  if (is_motion) add_end_of_halt(core, plan);
  const auto mode = mode_needed(core, command);
  if (!mode) return plan;
  if (is_continuous(*mode) && core.mode_in_force() != *mode) add_zero_targets(core, plan);
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
      add_end_of_halt(core, plan);
      return plan;
    }
    default:
      return Plan::refuse(Errc::not_supported);
  }
}

}  // namespace axisgate::drive
