#include "gateway/drive/planner.hpp"

namespace axisgate::drive {
namespace {

// How long a stop may take to show before it is repeated (design 3.4: up to 3 times).
constexpr Duration kStopLimit = std::chrono::milliseconds(250);

Condition not_enabled(const AxisCore& core) {
  Condition c;
  c.object = core.model.statusword;
  c.mask = 0x6F;
  c.test = Condition::Test::not_equals;
  c.values = {0x27};  // operation enabled
  return c;
}

// Disabled: neither operation enabled nor still in quick stop.
Condition torque_off(const AxisCore& core) {
  Condition c = not_enabled(core);
  c.test = Condition::Test::not_in;
  c.values = {0x27, 0x07};
  return c;
}

bool rising(std::uint16_t before, std::uint16_t now, std::uint16_t mask) { return (now & ~before & mask) != 0; }

// A raw start: the set-point held back until now goes first, and it must lie within the limits.
bool add_raw_start(const AxisCore& core, std::uint16_t word, Plan& plan) {
  const int mode = core.mode_in_force();
  if (mode == 1) {
    const auto target = core.motion.wanted(Quantity::target_position);
    if (target && !add_write(core, Quantity::target_position, *target, plan)) return false;
    if ((word & controlword::kRelative) != 0 && target) {
      const auto actual = core.value(Quantity::position_actual);
      const Binding* binding = core.model.binding(Quantity::target_position);
      if (!actual || binding == nullptr || !binding->limits.holds(*actual + *target)) return false;
    }
    return true;
  }
  if (mode == 6) return core.homing_method_given;
  return true;
}

}  // namespace

void add_end_of_halt(const AxisCore& core, Plan& plan) {
  const std::uint16_t word = core.controlword();
  if ((word & controlword::kHalt) == 0) return;
  add_zero_targets(core, plan);
  const Binding* target = core.model.binding(Quantity::target_position);
  const Binding* actual = core.model.binding(Quantity::position_actual);
  if (target != nullptr && actual != nullptr && target->writable && !core.held_back(Quantity::target_position)) {
    plan.add(Action::read(actual->object));
    plan.add(Action::copy(actual->object, target->object));
  }
  constexpr std::uint16_t kKeep = 0x000F;
  plan.add(Action::write(core.model.controlword, word & kKeep));
}

Plan plan_controlword(const AxisCore& core, std::uint16_t word) {
  const Request402 request = request_of(word);
  if (core.motion.pass(request) == Motion::Pass::refused) return Plan::refuse(Errc::state_unsuitable);
  Plan plan;
  const AxisFacts facts = core.facts();
  const std::uint16_t before = core.controlword();

  const bool enables = request == Request402::enable_operation && !facts.enabled();
  if (enables) {
    // What survives: velocity and torque that nobody has written anew since the last stop, fault or disable are made 0.
    for (const Quantity q : {Quantity::target_velocity, Quantity::target_torque}) {
      const Binding* binding = core.model.binding(q);
      if (binding == nullptr || !binding->writable) continue;
      if (!add_write(core, q, core.motion.wanted(q).value_or(0), plan)) return Plan::refuse(Errc::bad_value);
    }
  }
  if (rising(word, before, controlword::kHalt)) add_end_of_halt(core, plan);  // bit 8 falls: nothing resumes
  const bool starts = facts.enabled() && rising(before, word, controlword::kStart);
  if (starts && !add_raw_start(core, word, plan)) return Plan::refuse(Errc::bad_value);

  plan.add(Action::write(core.model.controlword, word));
  plan.add(Action::at(Mark::controlword_passed));
  if (rising(before, word, controlword::kFaultReset)) plan.add(Action::at(Mark::values_doubtful));
  if (starts && facts.mode == 1) plan.add(Action::at(Mark::start_discrete));
  if (starts && facts.mode == 6) plan.add(Action::at(Mark::start_homing));
  if (request == Request402::enable_operation && is_continuous(facts.mode)) plan.add(Action::at(Mark::run_raw));
  return plan;
}

Plan plan_stop_controlword(const AxisCore& core, std::uint16_t word) {
  Plan plan;
  plan.add(Action::write(core.model.controlword, word));
  plan.add(Action::at(Mark::controlword_passed));
  const bool quick = request_of(word) == Request402::quick_stop;
  plan.add(Action::wait(quick ? not_enabled(core) : torque_off(core), kStopLimit));
  return plan;
}

Plan plan_stop(const AxisCore& core, Command command) {
  const Command carried_out = command == Command::halt && halt_is_quick_stop(core) ? Command::quick_stop : command;
  const Steps* steps = steps_of(core, carried_out);
  if (steps == nullptr) return Plan::refuse(Errc::not_supported);
  Plan plan;
  add_steps(core, *steps, plan);
  switch (carried_out) {
    case Command::disable:
      plan.add(Action::wait(torque_off(core), kStopLimit));
      break;
    case Command::quick_stop:
      plan.add(Action::wait(not_enabled(core), kStopLimit));
      break;
    default:
      break;  // halt: the acknowledgement and the statusword read after it
  }
  return plan;
}

bool halt_is_quick_stop(const AxisCore& core) {
  const auto& halt = core.model.command(Command::halt);
  if (!halt) return true;
  const int mode = core.mode_in_force();
  for (const CommandDef::Variant& variant : halt->variants)
    for (const std::int16_t m : variant.modes)
      if (m == mode) return false;
  return halt->quick_stop_otherwise || halt->steps.empty();
}

}  // namespace axisgate::drive
