// SPDX-License-Identifier: Apache-2.0
// What a drive asks of its bus for itself, beside bring-up: what names a fault, its keep-alive, its end.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gateway/drive/device/drive.hpp"
#include "gateway/drive/device/requests.hpp"
#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/way_out.hpp"

namespace axisgate::drive {

/// It neither waits for its axes' bus jobs nor is joined or superseded by one.
bus::JobId Drive::queue_own(bus::Priority priority) {
  bus::BusJob job;
  job.priority = priority;
  job.axis = kNoAxis;
  const Queued queued = queue(std::move(job));
  return queued.code == Errc::ok ? queued.id : 0;
}

// --- What names a fault is read next, before anything but stops ----------------------------------------------------

bool Drive::has_cause_to_read() const {
  return std::any_of(axes_.begin(), axes_.end(),
                     [this](const auto& axis) { return axis->faults().next(turn_.now).has_value(); });
}

// One read for all axes that wait for it.
std::optional<bus::Exchange> Drive::next_cause() {
  std::optional<model::ObjectId> object;
  for (auto& axis : axes_) {
    const auto wanted = axis->faults().next(turn_.now);
    if (!wanted || (object && wanted != object)) continue;
    object = wanted;
    axis->faults().asked(turn_.now);
  }
  if (!object) return std::nullopt;
  return read_of(model_, *object);
}

std::optional<bus::Exchange> Drive::next_of_causes() {
  auto exchange = next_cause();
  if (!exchange) bus_.finish(std::exchange(jobs_.cause, 0));
  return exchange;
}

// Of a drive that is found faulted, as soon as it is up.
void Drive::schedule_causes() {
  for (auto& axis : axes_)
    if (axis->faults().take_over())
      for (const model::ObjectId word : axis->core().causes)
        if (!reads_.tells_state(word)) reads_.hurry(word, turn_.now);
  if (!brought_up() || !has_cause_to_read() || jobs_.cause != 0) return;
  jobs_.cause = queue_own(bus::Priority::cause);
}

// --- Keep-alive and control frames ---------------------------------------------------------------------------------

DriveControl::Turn Drive::control_turn() const {
  DriveControl::Turn turn{.now = turn_.now,
                          .online = turn_.link == LinkState::online,
                          .suspect = reads_.suspect(),
                          .adopted = bring_up_.adopted(),
                          .axes = {}};
  for (const auto& axis : axes_)
    turn.axes.push_back({.core = axis->core(),
                         .enabling = axis->pending().enables(true),
                         .disabling = axis->pending().disables(),
                         .stopping = axis->pending().stopping() || axis->guard().owed().owed(),
                         .live = axis->guard().ownership().live(turn_.now)});
  return turn;
}

// Whatever of this drive has its turn lets what is due go first, and keeps its own; but a stop, which makes it void.
std::optional<bus::Exchange> Drive::keep_alive_turn(bus::Priority priority) {
  if (priority == bus::Priority::stop || !control_.concerned()) return std::nullopt;
  auto due = control_.due(control_turn());
  if (!due) return std::nullopt;
  on_wire_.becomes_own();
  on_wire_.keeps_alive = due->axis;
  return std::move(due->exchange);
}

std::optional<bus::Exchange> Drive::whole_frame(const bus::Exchange& exchange, const bus::Arbiter::Grant& grant) {
  if (!control_.concerned()) return exchange;
  auto whole = control_.whole(control_turn(), exchange, grant.priority == bus::Priority::stop);
  if (whole) return whole;
  if (on_wire_.keeps_alive) {
    control_.failed(*on_wire_.keeps_alive, turn_.now);
    return std::nullopt;
  }
  if (Axis* owner = axis_of(grant.axis)) owner->queue().on_job_ended(grant.id, Errc::state_unsuitable);
  return std::nullopt;
}

namespace {

std::string_view why_held(Errc code) {
  if (code == Errc::dropped_by_stop) return "a stop is newer";
  return code == Errc::never_started ? "it comes too late" : "nobody has asked for it";
}

}  // namespace

// Whoever has planned it: by what it would do to each motor that it reaches.
bool Drive::may_leave(const bus::Exchange& exchange, const bus::Arbiter::Grant& grant) {
  // A bring-up that would enable gets no further, and does not spin.
  constexpr Duration kHeldBackPause = std::chrono::milliseconds(500);
  if (exchange.access != bus::Access::write) return true;
  const model::ObjectId object = model_.find(exchange.object);
  if (object == model::kNoObject) return true;
  const std::int64_t number = model_.object(object).number(exchange.raw);
  const Pending* const pending = on_wire_.axis == nullptr ? nullptr : on_wire_.axis->pending().find(grant.id);
  Sender sender{.keeps = on_wire_.keeps_alive.has_value()};
  if (pending != nullptr) {
    const CommandSequence& sequence = *pending->command_sequence;
    sender = {.asked = sequence.asked(),
              .stops = sequence.is_stop(),
              .begins = asks_to_begin(pending->batch()),
              .by = pending->begins_by()};
  }
  const AxisSlot slot = model_.object(object).slot;
  for (auto& axis : axes_) {
    if (slot != kNoAxis && axis != axes_[slot]) continue;
    const Errc code = held_on_way_out(axis->core(), object, number, sender);
    if (code == Errc::ok) continue;
    axis->on_held_back(fmt::format("{} = {} was held back: {}", model_.object(object).name, number, why_held(code)),
                       sender.stops);
    if (pending != nullptr)
      on_wire_.axis->queue().on_job_ended(grant.id, code);
    else if (on_wire_.keeps_alive)
      control_.failed(*on_wire_.keeps_alive, turn_.now);
    else if (grant.id != 0)
      bus_.wait(grant.id, turn_.now + kHeldBackPause);
    return false;
  }
  return true;
}

// Takes and gives up a place in the queue as it is needed; says when it must be looked at again.
Instant Drive::schedule_keep_alive() {
  // The queue was full: its own exchanges carry what is due meanwhile, and a place is asked for again.
  constexpr Duration kPlaceRetry = std::chrono::milliseconds(5);
  const Instant next = control_.concerned() ? control_.next_due(control_turn()) : kNever;
  if (next > turn_.now) {
    if (jobs_.keep_alive != 0) bus_.finish(std::exchange(jobs_.keep_alive, 0));
    return next;
  }
  if (jobs_.keep_alive != 0) return kNever;
  jobs_.keep_alive = queue_own(bus::Priority::command);
  return jobs_.keep_alive != 0 ? kNever : turn_.now + kPlaceRetry;
}

// --- The end on purpose --------------------------------------------------------------------------------------------

void Drive::close(Closing why, std::function<void()> closed) {
  begin_turn();
  for (auto& axis : axes_) axis->queue().close();
  // A bring-up would arm what is to be disarmed, and start nodes. What it has armed so far is looked at; but only of a
  // drive that was brought up is it known what a reload needs to know.
  if (jobs_.setup != 0) bus_.finish(std::exchange(jobs_.setup, 0));
  const Known known = brought_up() ? Known::whole : turn_.link == LinkState::setup ? Known::in_part : Known::nothing;
  // Polls and what else is slow do not hold up the end.
  if (end_.begin(why, known, store_, std::move(closed))) jobs_.end = queue_own(bus::Priority::command);
  after_event();
}

void Drive::reopen() {
  begin_turn();
  const bool disarmed = end_.take_back() && brought_up();
  if (jobs_.end != 0) bus_.finish(std::exchange(jobs_.end, 0));
  for (auto& axis : axes_) axis->queue().reopen();
  if (disarmed && bring_up_.has_setup()) begin_bring_up(false);
  if (turn_.link == LinkState::unknown) presence_.look_at(turn_.now);  // a bring-up that was not begun meanwhile
  after_event();
}

// Stops go first, to their end: what a motor does is not known before.
std::optional<bus::Exchange> Drive::next_of_end() {
  const bool stops = std::any_of(axes_.begin(), axes_.end(), [](const auto& axis) {
    return !axis->pending().empty() || axis->guard().owed().owed();
  });
  if (stops) {
    bus_.wait(jobs_.end, turn_.now + DriveEnd::kStopsFirst);
    return std::nullopt;
  }
  const auto next = end_.next();
  if (!next) {
    finish_end();
    return std::nullopt;
  }
  return next->write ? write(next->object, next->number) : read_of(model_, next->object);
}

void Drive::finish_end() {
  bus_.finish(std::exchange(jobs_.end, 0));
  if (const std::string told = end_.event_text(); !told.empty()) tell_all(EventKind::boot, 0, told);
}

void Drive::tell_closed() {
  if (jobs_.end != 0) return;
  for (const auto& axis : axes_)
    if (!axis->pending().empty()) return;
  if (const auto closed = end_.take_closed()) closed();
}

}  // namespace axisgate::drive
