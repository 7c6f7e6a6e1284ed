// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive.hpp"

#include <algorithm>
#include <utility>

#include "gateway/drive/axis/publisher.hpp"
#include "gateway/drive/device/requests.hpp"

namespace axisgate::drive {

Drive::Drive(model::DriveModel model, DriveSlot slot, std::vector<AxisImage*> images, bus::Bus& bus, Runtime& runtime,
             EventRing& events)
    : model_(std::move(model)),
      slot_(slot),
      bus_(bus),
      events_(events),
      store_(model_.objects),
      reads_(model_, store_),
      bring_up_(model_, bus.settings().timeout),
      control_(model_, store_),
      end_(model_),
      presence_(model::is_canopen(model_), bus.settings().timeout),
      timer_(runtime.make_timer([this] { on_time(); })) {
  assert(images.size() == model_.axes.size());
  AxisHost& host = *this;
  for (std::size_t i = 0; i < images.size(); ++i)
    axes_.push_back(std::make_unique<Axis>(model_, static_cast<AxisSlot>(i), store_, turn_, *images[i], host));
  begin_turn();
  bus_.attach(slot_, *this);
  after_event();
}

std::optional<BatchResult> Drive::submit(AxisSlot axis, const WriteBatch& batch, BatchCallback on_result) {
  begin_turn();
  auto result = axes_[axis]->submit(batch, std::move(on_result));
  // Callbacks of others wait for the next turn of the loop: nobody is called from inside submit().
  bring_up_to_date();
  return result;
}

void Drive::client_gone(ClientId client) {
  begin_turn();
  for (auto& axis : axes_) axis->on_client_gone(client);
  bring_up_to_date();
}

AxisHost::Queued Drive::queue(bus::BusJob job) {
  job.drive = slot_;
  const auto submission = bus_.submit(job);
  return {submission.code, submission.id, submission.joined};
}

void Drive::event(AxisNumber axis, EventKind kind, std::uint32_t code, std::string text) {
  events_.add(turn_.now, axis, kind, code, std::move(text));
}

// --- What goes on the wire -----------------------------------------------------------------------------------------

std::optional<bus::Exchange> Drive::on_grant(const bus::Arbiter::Grant& grant) {
  begin_turn();
  on_wire_ = {.job = grant.id, .axis = axis_of(grant.axis), .read = {.sent_at = turn_.now}};
  if (waits_for_chain(grant)) return std::nullopt;
  auto exchange = keep_alive_turn(grant.priority);
  if (!exchange) exchange = grant.id == 0 ? own_exchange() : exchange_of(grant);
  if (exchange) exchange = whole_frame(*exchange, grant);
  if (exchange && !may_leave(*exchange, grant)) exchange.reset();
  if (exchange) {
    if (exchange->part != bus::Part::next) break_chain();
    widen(*exchange);
    store_.begin_exchange(exchange->access != bus::Access::read);
  } else {
    after_event();
  }
  return exchange;
}

std::optional<bus::Exchange> Drive::own_exchange() {
  if (turn_.link == LinkState::unknown || turn_.link == LinkState::offline) return probe();
  if (reads_.suspect()) return resync(0);
  return brought_up() ? reads_.poll(turn_.now) : std::nullopt;
}

std::optional<bus::Exchange> Drive::exchange_of(const bus::Arbiter::Grant& grant) {
  const bus::JobId id = grant.id;
  Axis* const owner = on_wire_.axis;
  if (reads_.suspect() && !(owner != nullptr && owner->queue().passes_resync(id))) {
    on_wire_.becomes_own();
    return resync(id);
  }
  if (owner != nullptr) {
    const auto look = control_.concerned() ? control_.look_before(control_turn(), grant.priority == bus::Priority::stop)
                                           : std::optional<model::ObjectId>();
    if (look) {
      on_wire_.becomes_own();
      return read_of(model_, *look);
    }
    return owner->queue().on_grant(id);
  }
  if (id == jobs_.end) return next_of_end();
  if (id == jobs_.cause) return next_of_causes();
  return id == jobs_.setup ? next_of_bring_up() : std::nullopt;
}

bool Drive::chain_open() const {
  return std::any_of(axes_.begin(), axes_.end(), [](const auto& axis) { return axis->pending().chain_job() != 0; });
}

bool Drive::waits_for_chain(const bus::Arbiter::Grant& grant) {
  if (!chain_open() || grant.priority < bus::Priority::interactive) return false;
  if (on_wire_.axis != nullptr && on_wire_.axis->pending().chain_job() == grant.id) return false;
  constexpr Duration kChainPause = std::chrono::milliseconds(1);
  if (grant.id != 0) bus_.wait(grant.id, turn_.now + kChainPause);
  return true;
}

// The adapter tells the drive; the client whose object it was is told here.
void Drive::break_chain() {
  for (auto& axis : axes_)
    if (axis->pending().chain_job() != 0) axis->queue().on_job_ended(axis->pending().chain_job(), Errc::busy);
}

// A probe of a drive that is not there: its reply must not be one to something lost long ago.
std::optional<bus::Exchange> Drive::probe() {
  if (turn_.now < presence_.look_due()) return std::nullopt;
  if (!reads_.may_probe(turn_.now)) {
    presence_.look_at(reads_.silent_until());
    return std::nullopt;
  }
  using Look = NodePresence::Look;
  const Look look = presence_.look(turn_.link == LinkState::unknown);
  if (look == Look::wake) {
    presence_.look_later(turn_.now);
    return nmt(model_.node, NmtCommand::enter_pre_operational);
  }
  if (look == Look::give_up) {
    go_offline();
    return std::nullopt;
  }
  if (look == Look::call && bus_.call(model_.node)) {
    presence_.called(turn_.now);
    return std::nullopt;
  }
  presence_.asked();
  return reads_.probe(on_wire_.read);
}

std::optional<bus::Exchange> Drive::resync(bus::JobId job) {
  auto exchange = reads_.resync(on_wire_.read, turn_.now);
  if (!exchange && job != 0) bus_.wait(job, reads_.silent_until());
  return exchange;
}

void Drive::widen(bus::Exchange& exchange) {
  using For = DriveReads::For;
  const bool of_bring_up = on_wire_.job == jobs_.setup && jobs_.setup != 0;
  const For whom = of_bring_up ? For::bring_up : on_wire_.job == 0 ? For::poll : For::other;
  reads_.widen(exchange, on_wire_.read, whom, turn_.now);
}

bus::Exchange Drive::write(model::ObjectId object, std::int64_t number) const {
  bus::Exchange exchange = read_of(model_, object);
  exchange.access = bus::Access::write;
  exchange.size = reads_.width(object);
  exchange.raw = static_cast<std::uint32_t>(static_cast<std::uint64_t>(number));
  return exchange;
}

// --- What comes back -----------------------------------------------------------------------------------------------

void Drive::on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  begin_turn();
  const OnWire asked = on_wire_;
  const bool trusted = reads_.counts(asked.read);
  if (result.code == Errc::timed_out || result.code == Errc::bad_reply) {
    const bool stop_insists =
        std::any_of(axes_.begin(), axes_.end(), [&](const auto& axis) { return axis->pending().insists(asked.job); });
    on_timeout(exchange, stop_insists);
  } else if (result.code == Errc::link_lost) {
    reads_.lost(exchange, turn_.now);                    // its reply may still come, after the line's return
  } else if (exchange.access != bus::Access::command) {  // which nobody answers
    on_answer(exchange, result);
    // Nobody asked for the neighbours: whoever asked for the one asks again, in smaller company.
    if (reads_.split(exchange, result, asked.read)) {
      after_event();
      return;
    }
  }
  on_given_up();
  const model::ObjectId written =
      exchange.access == bus::Access::write ? model_.find(exchange.object) : model::kNoObject;
  control_.on_result(exchange, result, asked.keeps_alive, asked.read.sent_at, trusted, turn_.now);
  if (asked.job != 0) {
    bool owned = asked.job == jobs_.setup;
    if (owned) carry_on_bring_up(exchange, result);
    if (asked.job == jobs_.end) {
      owned = true;
      end_.on_result(result, trusted, store_);
      if (!end_.next()) finish_end();
    }
    if (asked.axis != nullptr && asked.axis->pending().find(asked.job) != nullptr) {
      owned = true;
      asked.axis->queue().on_result(asked.job, result, asked.read.sent_at, trusted);
    }
    if (!owned && written != model::kNoObject) on_write_without_owner(exchange, result, trusted);
  }
  if (written != model::kNoObject && result.code == Errc::ok) reads_.written(written, turn_.now);
  after_event();
}

// Whoever asked was given up while it was on the wire: what the drive holds now must be known all the same.
void Drive::on_write_without_owner(const bus::Exchange& exchange, const bus::ExchangeResult& result, bool trusted) {
  const model::ObjectId id = model_.find(exchange.object);
  if (result.code == Errc::ok && trusted)
    store_.acknowledged(id, model_.object(id).number(exchange.raw), on_wire_.read.sent_at);
  else if (result.code != Errc::refused_by_drive)
    store_.invalidate(id);
}

void Drive::on_timeout(const bus::Exchange& exchange, bool stop_insists) {
  reads_.timed_out(exchange, on_wire_.read, turn_.now);
  const bool gone = presence_.timed_out();
  if (turn_.link == LinkState::offline) {
    presence_.look_later(turn_.now);
    return;
  }
  // A stop has its three tries, also at a drive that was silent before it came.
  if (gone && !stop_insists) {
    go_offline();
  } else if (turn_.link == LinkState::online && !reads_.expects_silence(exchange)) {
    turn_.link = LinkState::suspect;
  }
}

void Drive::go_offline() {
  turn_.link = LinkState::offline;
  jobs_.setup = 0;
  unmap_values();
  bus_.end_drive(slot_, Errc::offline, Errc::link_lost);
  presence_.look_later(turn_.now);
}

void Drive::on_answer(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  // Of a read that counts lost replies out each answer may be one of them: no sign that it answers what it is asked.
  if (!on_wire_.read.counted) presence_.answered();
  const bool counts = reads_.counts(on_wire_.read);
  if (reads_.answered(exchange, result, on_wire_.read, turn_.now) && turn_.link == LinkState::suspect) {
    turn_.link = LinkState::online;
    for (auto& axis : axes_) axis->on_invalidated();
  }
  if (counts) store_fields(exchange, result);
  // The answer to a stop may be a late one: only what cannot be begins a bring-up.
  const bool not_there = turn_.link == LinkState::unknown || turn_.link == LinkState::offline;
  if (not_there && !reads_.suspect()) begin_bring_up(true);
}

void Drive::store_fields(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  const DriveReads::Taken taken = reads_.take(exchange, result, on_wire_.read, turn_.now);
  for (const std::string& object : taken.unlike)
    event(axes_.front()->core().model.number, EventKind::warning, 0, object);
  if (!taken.unlike.empty() && turn_.link != LinkState::setup) judge_profile();
  if (taken.back) judge_given_up();
  if (taken.scales)
    for (auto& axis : axes_) axis->on_scale();
  if (taken.samples)
    for (auto& axis : axes_) axis->on_samples();
}

// --- Link and time -------------------------------------------------------------------------------------------------

void Drive::on_link(bool up) {
  begin_turn();
  presence_.on_link(up, turn_.now);
  jobs_.setup = 0;
  unmap_values();
  turn_.link = up ? LinkState::unknown : LinkState::link_down;
  after_event();
}

void Drive::on_job_ended(const bus::Arbiter::Ending& ending) {
  begin_turn();
  if (Axis* owner = axis_of(ending.axis)) owner->queue().on_job_ended(ending.id, ending.code);
  if (ending.id == jobs_.end) finish_end();
  for (bus::JobId* job : {&jobs_.setup, &jobs_.cause, &jobs_.keep_alive})
    if (ending.id == *job) *job = 0;
  after_event();
}

void Drive::on_time() {
  begin_turn();
  for (auto& axis : axes_) axis->on_time();
  after_event();
}

void Drive::after_event() {
  bring_up_to_date();
  for (auto& axis : axes_) axis->queue().call_back();
  tell_closed();
}

void Drive::bring_up_to_date() {
  for (auto& axis : axes_) {
    axis->observe();
    const AxisCore& core = axis->core();
    if (core.motion.end_wants_position()) reads_.first(core.object_of(Quantity::position_actual));
    if (core.motion.rest_wants_sample(core.facts())) reads_.hurry(core.motion_object(), turn_.now);
  }
  reads_.refresh(turn_.now);
  if (brought_up()) {
    for (auto& axis : axes_)
      for (const model::Check& check : model_.checks) axis->set_alarm(check.alarm, false);
    judge_checks();
    leave_adoption();
    amend_setup();
  }
  const bool duplicated = presence_.duplicated(turn_.now);
  for (auto& axis : axes_) axis->set_alarm(AxisAlarm::duplicate_node, duplicated);
  const Instant amends = brought_up() && jobs_.setup == 0 ? bring_up_.amend_due() : kNever;
  Instant next =
      std::min({duplicated ? presence_.duplicate_until() : kNever, bring_up_.start().deadline(turn_.now), amends});
  for (auto& axis : axes_) {
    axis->publish();
    next = std::min({next, axis->next_deadline(), stale_deadline(axis->core())});
    if (axis->queue().has_due()) next = turn_.now;
  }
  schedule_causes();
  watch_positions();
  next = std::min(next, schedule_keep_alive());
  timer_->expires_at(next);
  if (turn_.link == LinkState::link_down) {
    bus_.set_poll_due(slot_, kNever);
  } else if (turn_.link == LinkState::unknown || turn_.link == LinkState::offline) {
    bus_.set_poll_due(slot_, presence_.look_due());
  } else if (reads_.suspect()) {
    bus_.set_poll_due(slot_, reads_.resync_due(turn_.now));
  } else {
    bus_.set_poll_due(slot_, brought_up() && !chain_open() ? reads_.poll_due() : kNever);
  }
}

}  // namespace axisgate::drive
