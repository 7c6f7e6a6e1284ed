// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::drive {

// --- What names a fault is read next, before anything but stops ----------------------------------------------------

// One read for all axes that wait for it.
std::optional<bus::Exchange> CausesTask::next(OnWire& /*turn*/) {
  std::optional<model::ObjectId> object;
  for (auto& axis : core_.axes) {
    const auto wanted = axis->core().fault.next(core_.turn.now);
    if (!wanted || (object && wanted != object)) continue;
    object = wanted;
    axis->core().fault.asked(core_.turn.now);
  }
  if (object) return read_of(core_.model, *object);
  finish();
  return std::nullopt;
}

// Of a drive that is found faulted, as soon as it is up.
Instant CausesTask::deadline() {
  for (auto& axis : core_.axes)
    if (axis->core().fault.take_over())
      for (const model::ObjectId word : axis->core().causes)
        if (!core_.reads.tells_state(word)) core_.reads.hurry(word, core_.turn.now);
  const auto has_cause = [this](const auto& axis) { return axis->core().fault.next(core_.turn.now).has_value(); };
  if (core_.brought_up() && job() == 0 && std::ranges::any_of(core_.axes, has_cause)) queue(bus::Priority::cause);
  return kNever;
}

// The code may be all that is told: what the fault words say is asked for at once.
void CausesTask::on_emergency(const bus::UnsolicitedEvent& emergency) {
  for (auto& axis : core_.axes) axis->core().fault.emergency(emergency.code, core_.turn.now, core_.store.exchange());
  std::string text = emergency.code == 0 ? std::string("EMCY 0x0000: the errors are over")
                                         : fmt::format("EMCY 0x{:04X}, error register 0x{:02X}, {}", emergency.code,
                                                       emergency.error_register, hex_text(emergency.vendor));
  if (emergency.repeats > 0) text += fmt::format(" ({} more were left out)", emergency.repeats);
  // Whether it is a fault the statusword tells, and then its cause is told once.
  core_.tell_all(EventKind::warning, emergency.code, text);
  for (const model::AxisModel& axis : core_.model.axes) {
    core_.reads.hurry_state(axis, core_.turn.now);
    for (const model::ObjectId id : axis.fault_words)
      if (id != model::kNoObject) core_.reads.hurry(id, core_.turn.now);
  }
}

// --- Keep-alive and control frames ---------------------------------------------------------------------------------

DriveControl::Turn ControlTask::shown() const {
  DriveControl::Turn turn{.now = core_.turn.now,
                          .online = core_.turn.link == LinkState::online,
                          .suspect = core_.reads.suspect(),
                          .adopted = core_.bring_up.adopted(),
                          .axes = {}};
  for (const auto& axis : core_.axes)
    turn.axes.push_back({.core = axis->core(),
                         .enabling = axis->pending().enables(true),
                         .disabling = axis->pending().disables(),
                         .stopping = axis->pending().stopping() || axis->guard().owed().owed(),
                         .live = axis->guard().ownership().live(core_.turn.now)});
  return turn;
}

// Whatever of this drive has its turn lets what is due go first, and keeps its own; but a stop, which makes it void.
bool ControlTask::takes(const OnWire& turn) {
  if (!control_.concerned()) return false;
  const bool stop = turn.priority == bus::Priority::stop;
  const DriveControl::Turn now = shown();
  due_ = stop ? std::nullopt : control_.due(now);
  look_ = due_ || turn.axis == nullptr ? std::nullopt : control_.look_before(now, stop);
  return due_ || look_;
}

std::optional<bus::Exchange> ControlTask::next(OnWire& turn) {
  turn.becomes_own();
  if (look_) return read_of(core_.model, *look_);
  turn.keeps_alive = due_->axis;
  return std::move(due_->exchange);
}

std::optional<bus::Exchange> ControlTask::whole(const OnWire& turn, const bus::Exchange& exchange) const {
  if (!control_.concerned()) return exchange;
  return control_.whole(shown(), exchange, turn.priority == bus::Priority::stop);
}

void ControlTask::on_result(const Ended& ended) {
  control_.on_result(ended.exchange, ended.result, ended.asked.keeps_alive, ended.asked.read.sent_at, ended.trusted,
                     core_.turn.now);
}

Instant ControlTask::deadline() {
  // The queue was full: its own exchanges carry what is due meanwhile, and a place is asked for again.
  constexpr Duration kPlaceRetry = std::chrono::milliseconds(5);
  const Instant next = control_.concerned() ? control_.next_due(shown()) : kNever;
  if (next > core_.turn.now) {
    finish();
    return next;
  }
  return job() != 0 || queue(bus::Priority::command) ? kNever : core_.turn.now + kPlaceRetry;
}

// --- The end on purpose --------------------------------------------------------------------------------------------

void EndTask::begin(Closing why, std::function<void()> closed) {
  // Only of a drive that was brought up is it known what a reload needs to know.
  const Known known = core_.brought_up()                    ? Known::whole
                      : core_.turn.link == LinkState::setup ? Known::in_part
                                                            : Known::nothing;
  // Polls and what else is slow do not hold up the end.
  if (end_.begin(why, known, core_.store, std::move(closed))) queue(bus::Priority::command);
}

bool EndTask::take_back() {
  finish();
  return end_.take_back() && core_.brought_up() && core_.bring_up.has_setup();
}

// Stops go first, to their end: what a motor does is not known before.
std::optional<bus::Exchange> EndTask::next(OnWire& /*turn*/) {
  const auto stops = [](const auto& axis) { return !axis->pending().empty() || axis->guard().owed().owed(); };
  if (std::ranges::any_of(core_.axes, stops)) {
    core_.bus.wait(job(), core_.turn.now + DriveEnd::kStopsFirst);
    return std::nullopt;
  }
  if (const auto next = end_.next()) return core_.exchange(*next);
  on_lost();
  return std::nullopt;
}

void EndTask::on_result(const Ended& ended) {
  if (!owns(ended.asked.job)) return;
  end_.on_result(ended.result, ended.trusted, core_.store);
  if (!end_.next()) on_lost();
}

void EndTask::on_lost() {
  finish();
  if (const std::string text = end_.event_text(); !text.empty()) core_.tell_all(EventKind::boot, 0, text);
}

void EndTask::call_back() {
  if (job() != 0 || !std::ranges::all_of(core_.axes, [](const auto& axis) { return axis->pending().empty(); })) return;
  if (const auto closed = end_.take_closed()) closed();
}

}  // namespace axisgate::drive
