// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/axis_publisher.hpp"

#include <fmt/format.h>

#include <utility>

namespace axisgate::drive {

AxisPublisher::AxisPublisher(AxisCore& core, AxisImage& image, AxisHost& host)
    : core_(core), image_(image), host_(host), writer_(core, image), shown_(view_of(image)) {}

void AxisPublisher::measure_cycle() {
  const Instant statusword_at = core_.store[core_.model.statusword].sent_at;
  if (statusword_at <= last_statusword_) return;
  if (last_statusword_ != kLongAgo) cycle_ = statusword_at - last_statusword_;
  last_statusword_ = statusword_at;
}

void AxisPublisher::publish(const Jog& jog, bool zero_may_move) {
  if (zero_may_move || zero_moves_) image_.zero_moved = core_.turn.now;
  zero_moves_ = zero_may_move;
  measure_cycle();
  image_.link_state = core_.turn.link;
  writer_.show_state();
  if (jog.active())
    image_.level_coils = static_cast<std::uint16_t>(image_.level_coils | (1U << jog_coil(jog.direction())));
  count();
  const AxisView before = std::exchange(shown_, view_of(image_));
  const bool changed = before != shown_;
  if (changed) {
    ++image_.sequence;
    if (image_.board != nullptr) image_.board->mark(image_.number);
    tell_link(before.link_state);
  }
  if (!image_.reachable()) return;
  tell_fault(before);
  if (changed) tell_changes(before);
}

void AxisPublisher::count() {
  AxisCounts& counts = *image_.counts;
  const Instant now = core_.turn.now;
  if (enabled_until_ != kNever) counts.enabled += now - enabled_until_;
  enabled_until_ = image_.reachable() && image_.has(AxisInput::enabled) ? now : kNever;
  const Sample& position = image_[Quantity::position_actual];
  if (!image_.reachable() || !position.valid || position.at <= image_.zero_moved) return way_.lose();
  counts.travel_microturns += way_.to(position.value, image_.units_per_rev.to_double());
}

void AxisPublisher::result(const WriteBatch& batch, CommandResult result, std::uint32_t detail, std::uint64_t stop) {
  const bool over = result != CommandResult::none && result != CommandResult::pending;
  if (over && batch.life && batch.command != Command::none) ++image_.counts->commands[{batch.command, result}];
  image_.latest = {result, detail, batch.command_id, stop, batch.life, subject_of(batch), core_.turn.now};
}

void AxisPublisher::tell_link(LinkState before) {
  if (before != image_.link_state)
    host_.event(image_.number, EventKind::link, static_cast<std::uint32_t>(image_.link_state),
                "link " + std::string(text(before)) + " -> " + std::string(text(image_.link_state)));
}

void AxisPublisher::tell_changes(const AxisView& before) {
  if (image_.has(AxisInput::homed) && !before.has(AxisInput::homed))
    host_.event(image_.number, EventKind::homed, 0, "homed");
  const std::uint32_t raised = image_.alarms & ~before.alarms;
  for (std::size_t i = 0; i < kAxisAlarmCount; ++i) {
    const auto alarm = static_cast<AxisAlarm>(i);
    const bool told = alarm == AxisAlarm::profile_mismatch ||  // by its drive, with what it lacks
                      alarm == AxisAlarm::unexpected_motion || alarm == AxisAlarm::units_disagree;  // by the watch
    if ((raised & bit(alarm)) != 0 && !told)
      host_.event(image_.number, EventKind::warning, static_cast<std::uint32_t>(i), alarm_text(core_, alarm));
  }
}

// --- Faults ----------------------------------------------------------------------------------------------------------

void AxisPublisher::reset_asked(const std::string& by) {
  if (fault_.since != kLongAgo) fault_.reset_by = by;
}

// Once its cause is settled, and once more for another one that comes later.
void AxisPublisher::tell_fault(const AxisView& before) {
  const bool fault = image_.has(AxisInput::fault);
  if (fault && fault_.since == kLongAgo) {
    fault_.since = core_.turn.now;
    ++image_.counts->faults;
  }
  if (fault && !before.has(AxisInput::fault)) fault_.logged.reset();
  const auto code = static_cast<std::uint16_t>(image_[Quantity::error_code].value);
  if (fault && core_.fault.settled() && fault_.logged != code) {
    fault_.logged = code;
    host_.event(image_.number, EventKind::fault, code, fault_text(core_));
  }
  if (fault || fault_.since == kLongAgo) return;
  const Fault over = std::exchange(fault_, {});
  constexpr double kNsPerSecond = 1e9;
  const double seconds = static_cast<double>((core_.turn.now - over.since).count()) / kNsPerSecond;
  const std::string how = over.reset_by.empty() ? "without a reset by a client" : "reset by " + over.reset_by;
  const std::string what =
      over.logged ? fmt::format("fault 0x{:04X}", *over.logged) : "a fault whose cause was not read";
  host_.event(image_.number, over.logged ? EventKind::warning : EventKind::fault, 0,
              fmt::format("{} is over after {:.1f} s, {}", what, seconds, how));
}

}  // namespace axisgate::drive
