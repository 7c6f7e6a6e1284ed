// SPDX-License-Identifier: Apache-2.0
// The profile's steps as actions, and what the order of writes is where several of them are one number.
#include <algorithm>

#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

// What a step that names a quantity is to write.
std::optional<Wanted> asked_for(const AxisCore& core, Quantity quantity) {
  if (quantity == Quantity::target_position) return core.target_position();
  if (quantity == Quantity::target_velocity || quantity == Quantity::target_torque)
    return core.running_target(quantity);
  if (const auto cached = core.value(quantity)) return Wanted{*cached};
  return std::nullopt;
}

// Also what the drive holds already: a request has no holes. What is not known starts nothing.
void add_joined(const AxisCore& core, const model::Step& step, Plan& plan) {
  std::optional<std::int64_t> raw = step.literal;
  if (step.source != model::Step::Source::literal) {
    const model::Binding& by = *core.model.binding(step.quantity);
    const bool of_client = step.source == model::Step::Source::quantity;
    const auto wanted = of_client ? asked_for(core, step.quantity) : Wanted{core.set_position_value};
    raw = wanted ? raw_of(core, by, *wanted) : std::nullopt;
  }
  if (!raw) plan.refusal = refusal(Errc::state_unsuitable);
  Action write = Action::write(step.object, raw.value_or(0));
  write.joined = step.joined;
  plan.add(std::move(write));
}

}  // namespace

const model::Steps* steps_of(const AxisCore& core, Command command) {
  const auto& def = core.model.command(command);
  if (!def) return nullptr;
  const int mode = core.mode_in_force();
  for (const model::CommandDef::Variant& variant : def->variants)
    if (std::find(variant.modes.begin(), variant.modes.end(), mode) != variant.modes.end()) return &variant.steps;
  return def->steps.empty() && !def->variants.empty() ? nullptr : &def->steps;
}

bool add_command_steps(const AxisCore& core, Command command, Plan& plan) {
  const model::Steps* steps = steps_of(core, command);
  if (steps == nullptr) {
    plan.refusal = {Errc::not_supported, 0};
    return false;
  }
  add_steps(core, *steps, plan);
  return true;
}

void add_steps(const AxisCore& core, const model::Steps& steps, Plan& plan) {
  bool goes_on = false;  // a request that the write before has begun
  for (const model::Step& step : steps) {
    switch (step.verb) {
      case model::Step::Verb::write:
        if (step.joined || goes_on) {
          add_joined(core, step, plan);
        } else if (step.source == model::Step::Source::literal) {
          plan.add(Action::write(step.object, step.literal));
        } else if (step.source == model::Step::Source::set_position) {
          const model::Binding* unit = core.model.binding(step.quantity);
          const auto raw = unit->to_raw(core.set_position_value, core.object(step.object));
          if (raw) plan.add(Action::write(step.object, *raw));
        } else if (step.quantity == Quantity::position_actual) {
          const model::Binding* actual = core.model.binding(Quantity::position_actual);
          if (actual == nullptr) break;
          plan.add(Action::read(actual->object));
          plan.add(Action::copy(actual->object, step.object));
        } else if (const auto wanted = asked_for(core, step.quantity)) {
          static_cast<void>(add_write(core, step.quantity, *wanted, plan));
        }
        break;
      case model::Step::Verb::wait:
        plan.add(Action::wait(step.until, step.limit, step.optional, step.otherwise));
        break;
      case model::Step::Verb::require:
        plan.add(Action::wait(step.until, Duration{}, false, step.otherwise));
        break;
    }
    goes_on = step.joined;
  }
}

std::vector<Action> with_directions(const AxisCore& core, std::vector<Action> actions, bool starts) {
  const auto is_directed = [&](const Action& each) {
    return each.kind == Action::Kind::write && core.object(each.object).is_directed();
  };
  if (std::ranges::none_of(actions, is_directed)) return actions;
  std::vector<Action> out;
  for (Action& each : actions) {
    if (is_directed(each) && each.number != 0) {
      const model::PartOf& made_of = core.object(each.object).part;
      const std::int64_t way = each.number < 0 ? made_of.negative : made_of.positive;
      const ObjectState& held = core.store[made_of.sign];
      const bool same = held.cached && held.number == way;
      if (!same) out.push_back(Action::write(made_of.whole, 0));
      if (!same || (starts && core.object(made_of.sign).trigger)) out.push_back(Action::write(made_of.sign, way));
    }
    out.push_back(std::move(each));
  }
  return out;
}

}  // namespace axisgate::drive
