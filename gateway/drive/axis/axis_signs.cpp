// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/axis_signs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {

void AxisSigns::on_bring_up() {
  reference_invalidated_ = false;
  counted_.reset();
}

void AxisSigns::observe(const AxisFacts& facts, const PendingBatches& pending) {
  const bool waits = !pending.empty();
  observe_counter();
  observe_reference(facts, waits);
  observe_volatile(waits);
  observe_homing_method(waits);
  observe_end_of_fault(facts, pending.enables());
}

void AxisSigns::observe_reference(const AxisFacts& facts, bool pending) {
  if (core_.is_virtual() && facts.reference && !core_.counter_wrapped) core_.homed = true;
  if (core_.turn.link != LinkState::online || !core_.model.homed || !core_.store[core_.model.homed->object].cached)
    return;
  const bool homing = core_.motion.running() == MotionKind::homing;
  if (facts.reference && !homing && !core_.counter_wrapped) core_.homed = true;
  // What says so in one mode alone says nothing in it before the homing either, unless the drive was silent since.
  const bool lasts = reference_invalidated_ || !core_.model.homed_mode;
  reference_invalidated_ = reference_invalidated_ && !facts.reference_tells;
  if (!lasts || !core_.homed || !facts.reference_tells || facts.reference || homing || pending) return;
  on_unseen_restart(
      "it has lost its reference: it has restarted, too quickly to go offline, or is homed by somebody else");
}

// No motor goes through half of its counter's numbers between two looks: it has come to their end, and goes on at the
// other. The drive says homed all the same, and every place that is told it from now on is another one.
void AxisSigns::observe_counter() {
  const model::ObjectId id = core_.object_of(Quantity::position_actual);
  const bool seen = id != model::kNoObject && core_.store[id].known && core_.reachable();
  const auto before = std::exchange(counted_, seen ? std::optional(core_.store[id].number) : std::nullopt);
  if (!before || !counted_) return;
  const std::int64_t half = std::int64_t{1} << (8 * core_.object(id).size - 1);
  if (std::abs(*counted_ - *before) <= half) return;
  core_.counter_wrapped = true;
  core_.homed = false;
  core_.machine.forget_homing();
  watch_.renumbered();
  host_.event(core_.model.number, EventKind::position_wrapped, 0,
              fmt::format("the drive's position counter has run over, from {} to {}: it is not homed any more", *before,
                          *counted_));
}

// A drive without a reference and a state machine of its own: what it forgets with its power tells that it has
// restarted. It counts from where it stood, and must be enabled anew. Who has not seen that yet may have enabled and
// started it since: an axis that is shown as disabled must not turn.
void AxisSigns::observe_volatile(bool pending) {
  const bool remembers = !core_.is_virtual() || !core_.model.virtual_axis->gate_only;
  if (remembers || core_.turn.link != LinkState::online || pending) return;
  const bool speeds_lost = has_lost_speeds(core_);
  if (std::exchange(speeds_lost_, speeds_lost) || !speeds_lost) return;
  const bool may_run = model::holds_motor(core_.state().state);
  core_.make(core_.model.controlword, 0);
  on_unseen_restart("it has restarted, too quickly to go offline: enable it anew");
  if (may_run) guard_.asks(Command::disable);
}

// A drive that no more holds what a client has written was restarted unseen, or is set up by somebody else: 3.4 wants
// the method "written or configured since bring-up".
void AxisSigns::observe_homing_method(bool pending) {
  const model::Binding* method = core_.model.binding(Quantity::homing_method);
  const bool written = core_.homing_method() && !core_.model.homing_method;
  if (!written || method == nullptr || method->object == model::kNoObject) {
    holds_method_ = false;
    return;
  }
  const ObjectState& state = core_.store[method->object];
  const bool read = state.cached && !state.unverified && !state.clamped;
  if (core_.turn.link != LinkState::online || pending || !read) return;
  const bool held = std::exchange(holds_method_, core_.value(Quantity::homing_method) == core_.homing_method());
  if (!held || holds_method_) return;
  core_.asked.forget(Quantity::homing_method);
  warn("the drive does not hold the homing_method that was written: write it again before a homing");
}

// 3.4: a fault ends every motion for good, and a fault_reset never enables. A drive with a state machine of its own may
// go on by itself as soon as its cause is gone.
void AxisSigns::observe_end_of_fault(const AxisFacts& facts, bool enables) {
  if (!core_.is_virtual() || !core_.reachable()) return;
  if (!std::exchange(faulted_, facts.faulted()) || !facts.enabled() || enables) return;
  guard_.enabled_itself("enabled by the drive itself when its fault was over: disabled", core_.store.exchange());
}

void AxisSigns::on_unseen_restart(const char* sign) {
  core_.homed = false;
  core_.machine.forget_homing();
  core_.store.invalidate_all();
  watch_.renumbered();
  warn(sign);
}

}  // namespace axisgate::drive
