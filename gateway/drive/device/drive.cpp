// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive.hpp"

#include <algorithm>
#include <utility>

#include "gateway/drive/axis/publisher.hpp"
#include "gateway/drive/device/requests.hpp"

namespace axisgate::drive {

Drive::Drive(DriveModel model, bus::DriveSlot slot, std::vector<AxisImage*> images, bus::Bus& bus, Runtime& runtime,
             EventRing& events)
    : model_(std::move(model)),
      slot_(slot),
      bus_(bus),
      runtime_(runtime),
      events_(events),
      store_(model_.objects),
      plan_(model_),
      resync_(model_.resync, model_.objects),
      blocks_(model_),
      constants_(model_.constants.size()),
      bring_up_(model_),
      control_(model_, store_),
      presence_(is_canopen(model_), bus.settings().timeout),
      node_start_(bus.settings().timeout),
      timer_(runtime.make_timer([this] { on_time(); })),
      mapped_(model_.objects.size(), false),
      end_(model_) {
  assert(images.size() == model_.axes.size());
  for (const ObjectDef& object : model_.objects) width_.push_back(object.size);
  AxisHost& host = *this;
  for (std::size_t i = 0; i < images.size(); ++i)
    axes_.push_back(std::make_unique<Axis>(model_, static_cast<bus::AxisSlot>(i), store_, *images[i], host));
  map_unasked();
  bus_.attach(slot_, *this);
  after_event();
}

std::optional<BatchResult> Drive::submit(bus::AxisSlot axis, const WriteBatch& batch, BatchCallback on_result) {
  auto result = axes_[axis]->submit(batch, std::move(on_result));
  // Callbacks of others wait for the next turn of the loop: nobody is called from inside submit().
  bring_up_to_date();
  return result;
}

void Drive::client_gone(ClientId client) {
  for (auto& axis : axes_) axis->on_client_gone(client);
  bring_up_to_date();
}

AxisHost::Queued Drive::queue(bus::BusJob job) {
  job.drive = slot_;
  const auto submission = bus_.submit(job);
  return {submission.code, submission.id, submission.joined};
}

void Drive::event(AxisNumber axis, EventKind kind, std::uint32_t code, std::string text) {
  events_.add(now(), axis, kind, code, std::move(text));
}

// --- What goes on the wire -----------------------------------------------------------------------------------------

std::optional<bus::Exchange> Drive::on_grant(bus::JobId id, bus::Priority priority) {
  on_wire_ = {.job = id, .sent_at = now()};
  if (waits_for_chain(id, priority)) return std::nullopt;
  auto exchange = keep_alive_turn(priority);
  if (!exchange) exchange = id == 0 ? own_exchange() : exchange_of(id, priority);
  if (exchange) exchange = whole_frame(*exchange, id, priority);
  if (exchange) {
    if (exchange->part != bus::Part::next) break_chain();
    widen(*exchange);
    store_.begin_exchange();
  } else {
    after_event();
  }
  return exchange;
}

std::optional<bus::Exchange> Drive::own_exchange() {
  if (state_ == LinkState::unknown || state_ == LinkState::offline) return probe();
  return resync_.suspect() ? resync(0) : poll();
}

std::optional<bus::Exchange> Drive::exchange_of(bus::JobId id, bus::Priority priority) {
  Axis* owner = nullptr;
  for (auto& axis : axes_)
    if (axis->has(id)) owner = axis.get();
  if (resync_.suspect() && !(owner != nullptr && owner->passes_resync(id))) {
    on_wire_.job = 0;  // the bus job keeps its turn; this exchange is the drive's own
    return resync(id);
  }
  if (owner != nullptr) {
    const auto look = control_.concerned() ? control_.look_before(control_turn(), priority == bus::Priority::stop)
                                           : std::optional<ObjectId>();
    if (look) {
      on_wire_.job = 0;
      return read_of(model_, *look);
    }
    return owner->on_grant(id);
  }
  if (id == jobs_.end) return next_of_end();
  if (id == jobs_.cause) return next_of_causes();
  return id == jobs_.setup ? next_of_bring_up() : std::nullopt;
}

bool Drive::chain_open() const {
  return std::any_of(axes_.begin(), axes_.end(), [](const auto& axis) { return axis->chain_job() != 0; });
}

bool Drive::waits_for_chain(bus::JobId id, bus::Priority priority) {
  if (!chain_open() || priority < bus::Priority::interactive) return false;
  if (std::any_of(axes_.begin(), axes_.end(), [&](const auto& axis) { return axis->chain_job() == id; })) return false;
  constexpr Duration kChainPause = std::chrono::milliseconds(1);
  if (id != 0) bus_.wait(id, now() + kChainPause);
  return true;
}

// The adapter tells the drive; the client whose object it was is told here.
void Drive::break_chain() {
  for (auto& axis : axes_)
    if (axis->chain_job() != 0) axis->on_job_ended(axis->chain_job(), Errc::busy);
}

// A probe of a drive that is not there: its reply must not be one to something lost long ago.
std::optional<bus::Exchange> Drive::probe() {
  if (now() < presence_.look_due()) return std::nullopt;
  if (resync_.suspect()) {
    if (now() < resync_.silent_until()) {
      presence_.look_at(resync_.silent_until());
      return std::nullopt;
    }
    resync_.waited_out();
  }
  using Look = NodePresence::Look;
  const Look look = presence_.look(state_ == LinkState::unknown);
  if (look == Look::wake) {
    presence_.look_later(now());
    return nmt(model_.node, NmtCommand::enter_pre_operational);
  }
  if (look == Look::give_up) {
    go_offline();
    return std::nullopt;
  }
  if (look == Look::call && bus_.call(model_.node)) {
    presence_.called(now());
    return std::nullopt;
  }
  presence_.asked();
  on_wire_.probe = true;
  return probe_read(model_);
}

std::optional<bus::Exchange> Drive::resync(bus::JobId job) {
  const auto candidate = resync_.candidate();
  if (candidate && !resync_.exhausted()) {
    resync_.resync_sent();
    on_wire_.resync = true;
    return read_of(model_, *candidate);
  }
  if (now() < resync_.silent_until()) {
    if (job != 0) bus_.wait(job, resync_.silent_until());
    return std::nullopt;
  }
  resync_.waited_out();
  on_wire_.resync = true;
  return probe_read(model_);
}

std::optional<bus::Exchange> Drive::poll() {
  if (!brought_up()) return std::nullopt;
  const auto object = plan_.next(now());
  if (!object) return std::nullopt;
  return read_of(model_, *object);
}

// --- What comes back -----------------------------------------------------------------------------------------------

void Drive::on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  const OnWire asked = on_wire_;
  const bool trusted = !resync_.suspect() || asked.resync;
  if (result.code == Errc::timed_out || result.code == Errc::bad_reply) {
    const bool stop_insists =
        std::any_of(axes_.begin(), axes_.end(), [&](const auto& axis) { return axis->insists(asked.job); });
    on_timeout(exchange, stop_insists);
  } else if (result.code == Errc::link_lost) {
    resync_.lost(exchange, now());                       // its reply may still come, after the line's return
  } else if (exchange.access != bus::Access::command) {  // which nobody answers
    on_answer(exchange, result);
    // Nobody asked for the neighbours: whoever asked for the one asks again, in smaller company.
    if (split(exchange, result)) {
      after_event();
      return;
    }
  }
  const ObjectId written = exchange.access == bus::Access::write ? model_.find(exchange.object) : kNoObject;
  control_.on_result(exchange, result, asked.keeps_alive, asked.sent_at, trusted, now());
  if (asked.job != 0) {
    bool owned = asked.job == jobs_.setup;
    if (owned) carry_on_bring_up(exchange, result);
    if (asked.job == jobs_.end) {
      owned = true;
      end_.on_result(result, trusted, store_);
      if (!end_.next()) finish_end();
    }
    for (auto& axis : axes_) {
      if (!axis->has(asked.job)) continue;
      owned = true;
      axis->on_result(asked.job, result, asked.sent_at, trusted);
    }
    if (!owned && written != kNoObject) on_write_without_owner(exchange, result, trusted);
  }
  if (written != kNoObject && result.code == Errc::ok) plan_.written(written, now());
  after_event();
}

// Whoever asked was given up while it was on the wire: what the drive holds now must be known all the same.
void Drive::on_write_without_owner(const bus::Exchange& exchange, const bus::ExchangeResult& result, bool trusted) {
  const ObjectId id = model_.find(exchange.object);
  if (result.code == Errc::ok && trusted)
    store_.acknowledged(id, model_.object(id).number(exchange.raw), on_wire_.sent_at);
  else if (result.code != Errc::refused_by_drive)
    store_.invalidate(id);
}

void Drive::on_timeout(const bus::Exchange& exchange, bool stop_insists) {
  resync_.lost(exchange, now());
  if (on_wire_.widened) silent_read_ = exchange;
  store_.invalidate_all();
  const bool gone = presence_.timed_out();
  if (state_ == LinkState::offline) {
    presence_.look_later(now());
    return;
  }
  // A stop has its three tries, also at a drive that was silent before it came.
  if (gone && !stop_insists) {
    go_offline();
  } else if (state_ == LinkState::online) {
    set_state(LinkState::suspect);
  }
}

void Drive::go_offline() {
  set_state(LinkState::offline);
  jobs_.setup = 0;
  unmap_values();
  bus_.end_drive(slot_, Errc::offline, Errc::link_lost);
  presence_.look_later(now());
}

void Drive::on_answer(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  presence_.answered();
  const bool counts = !resync_.suspect() || on_wire_.resync || on_wire_.probe;
  // An error answer is no answered resynchronisation read; the next candidate is tried.
  if (result.code == Errc::ok && (on_wire_.resync || on_wire_.probe)) {
    resync_.answered();
    // It lives, and did not answer a longer read: after the second time that counts as a refusal.
    if (silent_read_ && on_wire_.resync) static_cast<void>(blocks_.silent(*silent_read_));
    silent_read_.reset();
    if (state_ == LinkState::suspect) {
      set_state(LinkState::online);
      for (auto& axis : axes_) axis->on_invalidated();
    }
  }
  if (result.code == Errc::refused_by_drive && on_wire_.resync) resync_.lost(exchange, now());
  if (counts) store_fields(exchange, result);
  // The answer to a stop may be a late one: only what cannot be begins a bring-up.
  const bool not_there = state_ == LinkState::unknown || state_ == LinkState::offline;
  if (not_there && !resync_.suspect()) begin_bring_up(true);
}

// --- Link and time -------------------------------------------------------------------------------------------------

void Drive::on_link(bool up) {
  presence_.on_link(up, now());
  jobs_.setup = 0;
  unmap_values();
  set_state(up ? LinkState::unknown : LinkState::link_down);
  after_event();
}

void Drive::on_job_ended(bus::JobId id, Errc code) {
  for (auto& axis : axes_) axis->on_job_ended(id, code);
  if (id == jobs_.end) finish_end();
  for (bus::JobId* job : {&jobs_.setup, &jobs_.cause, &jobs_.keep_alive})
    if (id == *job) *job = 0;
  after_event();
}

void Drive::set_state(LinkState state) { state_ = state; }

void Drive::on_time() {
  for (auto& axis : axes_) axis->on_time(now());
  after_event();
}

void Drive::after_event() {
  bring_up_to_date();
  for (auto& axis : axes_) axis->call_back();
  tell_closed();
}

void Drive::bring_up_to_date() {
  for (auto& axis : axes_) axis->observe(now());
  if (invalidations_seen_ != store_.invalidations()) {
    invalidations_seen_ = store_.invalidations();
    plan_.refresh(now());
  }
  if (brought_up()) {
    for (auto& axis : axes_)
      for (const Check& check : model_.checks) axis->set_alarm(check.alarm, false);
    judge_checks();
    leave_adoption();
  }
  const bool duplicated = presence_.duplicated(now());
  for (auto& axis : axes_) axis->set_alarm(AxisAlarm::duplicate_node, duplicated);
  Instant next = std::min(duplicated ? presence_.duplicate_until() : kNever, node_start_.deadline(now()));
  for (auto& axis : axes_) {
    axis->publish(now());
    next = std::min({next, axis->next_deadline(), stale_deadline(axis->core(), now())});
    if (axis->has_due()) next = now();
  }
  schedule_causes();
  watch_positions();
  next = std::min(next, schedule_keep_alive());
  timer_->expires_at(next);
  if (state_ == LinkState::link_down) {
    bus_.set_poll_due(slot_, kNever);
  } else if (state_ == LinkState::unknown || state_ == LinkState::offline) {
    bus_.set_poll_due(slot_, presence_.look_due());
  } else if (resync_.suspect()) {
    bus_.set_poll_due(slot_, resync_.exhausted() ? resync_.silent_until() : now());
  } else {
    bus_.set_poll_due(slot_, brought_up() && !chain_open() ? plan_.next_due() : kNever);
  }
}

}  // namespace axisgate::drive
