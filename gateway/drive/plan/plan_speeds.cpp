// SPDX-License-Identifier: Apache-2.0
// Speeds and ramps that a motion goes by.
#include <algorithm>
#include <array>

#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

// What says how fast an axis moves in this mode, and how it gets there.
std::vector<Quantity> speeds_of(int motion_mode) {
  using enum Quantity;
  switch (motion_mode) {
    case 1:
      return {profile_velocity, profile_acceleration, profile_deceleration, max_torque};
    case 3:
      return {profile_acceleration, profile_deceleration, max_torque};
    case 4:
      return {max_velocity, max_torque};
    case 6:
      return {homing_speed_switch, homing_speed_zero, homing_acceleration, max_torque};
    default:
      return {};
  }
}

// As it was asked for last; where two of them are one object, the later one. None: the drive cannot hold it.
std::optional<Wanted> asked_speed(const AxisCore& core, model::ObjectId object) {
  std::optional<Wanted> newest;
  for (const model::Binding& each : core.model.bindings) {
    if (each.object != object || !is_speed(each.quantity)) continue;
    auto wanted = core.asked.taken(each.quantity);
    if (!wanted || (newest && newest->at > wanted->at)) continue;
    wanted->exact = raw_of(core, each, *wanted);
    newest = wanted;
  }
  return newest && newest->exact ? newest : std::nullopt;
}

}  // namespace

bool is_speed_of_motion(Quantity quantity) {
  constexpr std::array kModes{1, 3, 4, 6};
  return std::ranges::any_of(kModes, [quantity](int mode) {
    const auto speeds = speeds_of(mode);
    return std::ranges::find(speeds, quantity) != speeds.end();
  });
}

void forget_speeds(AxisCore& core, const WriteBatch& batch) {
  for (const Setpoint& sp : batch.setpoints) {
    const model::Binding* binding = core.model.binding(sp.quantity);
    for (const model::Binding& each : core.model.bindings)
      if (binding != nullptr && each.object == binding->object && is_speed(each.quantity))
        core.asked.forget(each.quantity);
  }
}

void rescale(AxisCore& core) {
  core.motion.record().rescaled();
  for (const model::Binding& each : core.model.bindings)
    if (is_speed(each.quantity) && !asked_speed(core, each.object)) core.asked.forget(each.quantity);
}

bool has_lost_speeds(const AxisCore& core) {
  return std::ranges::any_of(core.model.bindings, [&](const model::Binding& each) {
    const auto told = is_speed(each.quantity) ? asked_speed(core, each.object) : std::nullopt;
    if (!told || core.object(each.object).nvm != model::Nvm::no) return false;
    const ObjectState& state = core.store[each.object];
    return state.known && !state.unverified && !state.unsure && !state.clamped && state.number != told->exact;
  });
}

bool holds_asked_speeds(const AxisCore& core, int mode) {
  return std::ranges::all_of(speeds_of(mode), [&](Quantity each) {
    const model::Binding* binding = core.model.binding(each);
    const auto told = binding != nullptr && core.model.takes(each) ? asked_speed(core, binding->object) : std::nullopt;
    if (!told) return true;
    const ObjectState& state = core.store[binding->object];
    return !state.known || state.clamped || state.number == told->exact;
  });
}

// A drive that was silent may have restarted while nobody heard it: what a limit is held against is read again then.
void add_speeds(const AxisCore& core, int mode, Plan& plan) {
  bool look_again = false;
  for (const Quantity each : speeds_of(mode)) {
    const model::Binding* binding = core.model.binding(each);
    if (binding == nullptr || !core.model.takes(each)) continue;
    const ObjectState& state = core.store[binding->object];
    const auto told = asked_speed(core, binding->object);
    if (told && !state.clamped) {
      // After a mode change it is taken to be as it was: what a start takes longer is a button's time.
      if (!state.known || state.out_of_sight || state.number != told->exact)
        static_cast<void>(add_write(core, each, *told, plan));
      continue;
    }
    // Nobody knows what it holds, and it may be beyond the limit.
    if (binding->limited && state.unresponsive) plan.refusal = refusal(Errc::state_unsuitable);
    const bool limited = binding->limits.max < range_of(row(each).type).max;
    if (state.out_of_sight && limited && state.known && core.state().enabled()) {
      plan.add(Action::read(binding->object));
      look_again = true;
      continue;
    }
    const auto held = core.value(each);
    if (held && *held > binding->limits.max) static_cast<void>(add_write(core, each, {binding->limits.max}, plan));
  }
  if (look_again) plan.add(Action::at(Mark::look_again));
}

}  // namespace axisgate::drive
