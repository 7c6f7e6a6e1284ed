// SPDX-License-Identifier: Apache-2.0
// What an axis sees in its drive's newest samples, and shows in its image.
#include <algorithm>
#include <string>

#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/axis/publisher.hpp"

namespace axisgate::drive {

void Axis::on_samples() {
  core_.now = host_.now();
  core_.link = host_.link_state();
  core_.refresh_virtual();
}

void Axis::on_scale() { show_model(core_.model, image_); }

void Axis::observe(Instant now) {
  core_.now = now;
  core_.link = host_.link_state();
  const AxisFacts facts = core_.facts();
  watch_fault();
  core_.motion.observe(facts, core_.model.homing_timeout);
  if (core_.is_virtual() && facts.reference) core_.homed = true;
  const bool homing = core_.motion.running() == MotionKind::homing;
  if (core_.link == LinkState::online && core_.model.homed && core_.store[core_.model.homed->object].cached) {
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

void Axis::publish(Instant now) {
  const Instant statusword_at = core_.store[core_.model.statusword].sent_at;
  if (statusword_at > last_statusword_) {
    if (last_statusword_ != kLongAgo) cycle_ = statusword_at - last_statusword_;
    last_statusword_ = statusword_at;
  }
  core_.now = now;
  core_.link = host_.link_state();
  watch_fault();
  core_.motion.observe(core_.facts(), core_.model.homing_timeout);
  tell_endings();
  const AxisImage before = image_;
  image_.link_state = host_.link_state();
  show_state(core_, image_, now);
  constexpr std::uint16_t kJogForward = 1U << 8, kJogReverse = 1U << 9;
  if (jog_.active())
    image_.level_coils = static_cast<std::uint16_t>(
        image_.level_coils | (jog_.direction() == Command::jog_forward ? kJogForward : kJogReverse));
  if (!shows_the_same(before, image_)) {
    ++image_.sequence;
    if (image_.board != nullptr) image_.board->mark(image_.number);
    tell_changes(before);
  }
}

void Axis::watch_fault() {
  core_.watch_fault();
  if (core_.fault.take_missed())
    host_.event(image_.number, EventKind::fault, 0, "a fault came and was gone before its cause could be read");
}

// What the servers must know of it: what was commanded before is over, and its client must ask anew.
void Axis::tell_endings() {
  if (core_.motion.faults() != faults_told_) image_.endings.faulted();
  if (core_.motion.losses() != losses_told_) image_.endings.lost();
  faults_told_ = core_.motion.faults();
  losses_told_ = core_.motion.losses();
  const AxisFacts facts = core_.facts();
  ownership_.set_armed(core_.link != LinkState::online || holds_motor(facts.state));
}

void Axis::tell_changes(const AxisImage& before) {
  if (before.link_state != image_.link_state)
    host_.event(image_.number, EventKind::link, static_cast<std::uint32_t>(image_.link_state),
                "link " + std::string(text(before.link_state)) + " -> " + std::string(text(image_.link_state)));
  if (!image_.reachable()) return;
  tell_fault(before);
  if (image_.has(AxisInput::homed) && !before.has(AxisInput::homed))
    host_.event(image_.number, EventKind::homed, 0, "homed");
  const std::uint32_t raised = image_.alarms & ~before.alarms;
  for (std::size_t i = 0; i < kAxisAlarmCount; ++i) {
    const auto alarm = static_cast<AxisAlarm>(i);
    const bool told = alarm == AxisAlarm::profile_mismatch;  // by its drive, with what it lacks
    if ((raised & bit(alarm)) != 0 && !told)
      host_.event(image_.number, EventKind::warning, static_cast<std::uint32_t>(i), alarm_text(core_, alarm));
  }
}

}  // namespace axisgate::drive
