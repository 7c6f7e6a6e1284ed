// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/id286pro.hpp"

#include <algorithm>

namespace axisgate::simulated {
namespace {

constexpr std::uint8_t highest_switch_address = 31;
constexpr std::uint8_t global_address = 255;

}  // namespace

Id286pro::Id286pro(const Id286proOptions& options) : options_(options), axis_(options_.mechanics, registers_.get(242)) {
  registers_.set_stored(296, options_.internal_pulses ? 1 : 0);
  registers_.set_stored(298, options_.unit);
  for (const auto& [row, value] : options_.stored) registers_.set_stored(row, value);
  power_up();
}

void Id286pro::power_up() {
  registers_.power_up(options_.unknown_are_stored);
  const bool by_register = options_.switches_off || options_.unit > highest_switch_address;
  unit_ = by_register ? static_cast<std::uint8_t>(registers_.get(298)) : options_.unit;
  internal_ = registers_.get(296) == 1;
  fault_ = cause_;
  clearable_ = clearable_ || cause_ == 0;
  axis_.redefine(0);
  axis_.forget_demand();
  inputs_.configure(registers_);
  inputs_.follow(options_.mechanics, axis_.physical());
  inputs_.forget_edges();  // what was on already triggers nothing
}

void Id286pro::restart(Time now) {
  advance(now);
  ++restarts_;
  motion_.end();
  restart_at_.reset();
  boot_until_ = now + options_.boot_time;
}

bool Id286pro::obeys_broadcast(std::uint8_t address) const {
  return address == global_address || (address == 0 && options_.obeys_address_zero);
}

bool Id286pro::quiescent() const {
  return !boot_until_ && !restart_at_ && !motion_.running() && axis_.speed() == 0 && !origin_command_;
}

void Id286pro::advance(Time now) {
  const std::int64_t until = now / one_millisecond;
  while (ticks_ < until) {
    // A drive at rest has nothing to compute; only its inputs are looked at, once.
    ticks_ = quiescent() ? until : ticks_ + 1;
    tick(ticks_ * one_millisecond);
  }
  now_ = std::max(now_, now);
  if (boot_until_ && now_ >= *boot_until_) {
    boot_until_.reset();
    power_up();
  }
}

void Id286pro::tick(Time at) {
  now_ = at;
  if (boot_until_ && at >= *boot_until_) {
    boot_until_.reset();
    power_up();
  }
  if (restart_at_ && at >= *restart_at_) {
    ++restarts_;
    motion_.end();
    restart_at_.reset();
    boot_until_ = at + options_.boot_time;
  }
  inputs_.follow(options_.mechanics, axis_.physical());
  if (!boot_until_) scan_inputs();

  const FinePosition highest = registers_.get(317) * fine_per_count;
  const FinePosition lowest = registers_.get(319) * fine_per_count;
  const Dec speed = motion_.running() ? motion_.next_speed(axis_, signals(), lowest, highest) : 0;
  axis_.step(speed, true, registers_.get(201) == 1 ? -1 : 1);
  origin_command_ = false;
  if (speed != 0) moved_at_ = at;
  // Here is 0. The counter is the generator's own: a jam leaves the rotor behind, and nobody knows.
  if (motion_.take_reference()) axis_.redefine(axis_.actual() - axis_.demand());
}

void Id286pro::scan_inputs() {
  const auto functions = inputs_.risen();
  // With external pulses the terminals are pulse, direction and free; functions have no meaning.
  if (internal_) {
    for (const std::uint16_t function : functions) obey(function, 0);
  }
  if (!enabled()) motion_.end();
}

// What a fault does to the run state is not stated; a motor without current is free, which is what 1 stands for.
bool Id286pro::enabled() const {
  if (!enable_switch_ || fault_ != 0) return false;
  if (!internal_) return !inputs_.terminal(3);  // FREE conducts
  return !inputs_.has(Id286proInputs::enable) || inputs_.active(Id286proInputs::enable);
}

Id286proSignals Id286pro::signals() const {
  return {inputs_.active(Id286proInputs::positive_limit), inputs_.active(Id286proInputs::negative_limit),
          inputs_.active(Id286proInputs::origin) || origin_command_};
}

Id286pro::RunState Id286pro::run_state() const {
  if (!enabled()) return RunState::disabled;
  return motion_.running() ? RunState::running : RunState::stopped;
}

void Id286pro::inject_fault(std::uint16_t code, bool clearable) {
  cause_ = code;
  clearable_ = clearable;
  if (boot_until_) return;
  fault_ = code;
  motion_.end();
}

void Id286pro::set_enable_switch(bool on) {
  enable_switch_ = on;
  if (!on) motion_.end();
}

void Id286pro::set_input(int input, bool on) {
  inputs_.set_terminal(input, on);
  if (!boot_until_) scan_inputs();
}

}  // namespace axisgate::simulated
