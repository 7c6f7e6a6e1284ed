// SPDX-License-Identifier: Apache-2.0
// What an axis sees in its drive's newest samples, and shows in its image.
#include <algorithm>
#include <string>

#include "gateway/drive/axis/axis.hpp"

namespace axisgate::drive {

void Axis::on_samples() { core_.refresh_virtual(); }

void Axis::on_scale() { shown_.show_model(); }

void Axis::observe() {
  const AxisFacts facts = core_.facts();
  shown_.watch_fault();
  core_.motion.observe(facts, core_.model.homing_timeout);
  if (core_.is_virtual() && facts.reference) core_.homed = true;
  const bool homing = core_.motion.running() == MotionKind::homing;
  if (core_.turn.link == LinkState::online && core_.model.homed && core_.store[core_.model.homed->object].cached) {
    if (facts.reference && !homing) core_.homed = true;
    // A drive that was silent and has lost its reference since has restarted, too quickly to go offline.
    if (reference_invalidated_ && facts.reference_tells && !facts.reference) core_.homed = false;
    reference_invalidated_ = reference_invalidated_ && !facts.reference_tells;
  }
  bool clamped = false;
  for (const Binding& binding : core_.model.bindings)
    if (binding.object != kNoObject && binding.object != core_.model.controlword)
      clamped = clamped || core_.store[binding.object].clamped;
  set_alarm(AxisAlarm::clamped, clamped);
  observe_jog();
  observe_owed();
  if (!core_.motion.take_homing_timeout()) return;
  host_.event(image_.number, EventKind::warning, 0, "homing took longer than its timeout: halted");
  stop_by_itself(Command::halt, false, [](const BatchResult&) {});
}

// --- The image -----------------------------------------------------------------------------------------------------

void Axis::publish() {
  ownership_.set_armed(core_.turn.link != LinkState::online || holds_motor(core_.facts().state));
  shown_.publish(jog_);
}

}  // namespace axisgate::drive
