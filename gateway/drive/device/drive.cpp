// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/write_exchange.hpp"

namespace axisgate::drive {

Drive::Drive(model::DriveModel model, DriveSlot slot, std::vector<AxisImage*> images, bus::Bus& bus, Runtime& runtime,
             EventRing& events)
    : core_(std::move(model), slot, bus, events), timer_(runtime.make_timer([this] { on_time(); })) {
  assert(images.size() == core_.model.axes.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    std::vector<Axis*> shared;
    for (const AxisSlot other : core_.model.axes[i].shares)
      if (other < i) shared.push_back(core_.axes[other].get());
    core_.axes.push_back(std::make_unique<Axis>(core_.model, static_cast<AxisSlot>(i), core_.store, core_.turn,
                                                *images[i], shared, core_));
    core_.turn.axes.push_back(&core_.axes.back()->core());
  }
  begin_turn();
  core_.bus.attach(core_.slot, *this);
  after_event();
}

std::optional<BatchResult> Drive::submit(AxisSlot axis, const WriteBatch& batch, BatchCallback on_result) {
  begin_turn();
  auto result = core_.axes[axis]->submit(batch, std::move(on_result));
  // Callbacks of others wait for the next turn of the loop: nobody is called from inside submit().
  bring_up_to_date();
  return result;
}

void Drive::client_gone(ClientId client) {
  begin_turn();
  for (auto& axis : core_.axes) axis->on_client_gone(client);
  bring_up_to_date();
}

void Drive::close(Closing why, std::function<void()> closed) {
  begin_turn();
  for (auto& axis : core_.axes) axis->queue().close();
  // A bring-up would arm what is to be disarmed, and start nodes. What it has armed so far is looked at.
  setup_.finish();
  end_.begin(why, std::move(closed));
  after_event();
}

void Drive::reopen() {
  begin_turn();
  const bool disarmed = end_.take_back();
  for (auto& axis : core_.axes) axis->queue().reopen();
  if (disarmed) setup_.begin(false);
  // A bring-up that was not begun meanwhile.
  if (core_.turn.link == LinkState::unknown) core_.presence.look_at(core_.turn.now);
  after_event();
}

// --- What goes on the wire -----------------------------------------------------------------------------------------

std::optional<bus::Exchange> Drive::on_grant(const bus::Arbiter::Grant& grant) {
  begin_turn();
  on_wire_ = {
      .job = grant.id, .axis = axis_of(grant.axis), .priority = grant.priority, .read = {.sent_at = core_.turn.now}};
  if (waits_for_chain()) return std::nullopt;
  auto exchange = exchange_of_turn();
  if (!exchange) {
    after_event();
    return exchange;
  }
  if (exchange->part != bus::Part::next) break_chain();
  using For = DriveReads::For;
  const For whom = setup_.owns(on_wire_.job) ? For::bring_up : on_wire_.job == 0 ? For::poll : For::other;
  core_.reads.widen(*exchange, on_wire_.read, whom, core_.turn.now);
  core_.store.begin_exchange(exchange->access != bus::Access::read);
  return exchange;
}

std::optional<bus::Exchange> Drive::exchange_of_turn() {
  const auto task = std::ranges::find_if(tasks_, [this](DriveTask* each) { return each->takes(on_wire_); });
  std::optional<bus::Exchange> exchange;
  if (task != tasks_.end())
    exchange = (*task)->next(on_wire_);
  else if (on_wire_.axis != nullptr)
    exchange = on_wire_.axis->queue().on_grant(on_wire_.job);
  if (!exchange) return exchange;
  exchange = control_.whole(on_wire_, *exchange);
  if (!exchange) give_back(Errc::state_unsuitable);
  return exchange && may_leave(*exchange) ? exchange : std::nullopt;
}

bool Drive::chain_open() const {
  return std::ranges::any_of(core_.axes, [](const auto& axis) { return axis->pending().chain_job() != 0; });
}

bool Drive::waits_for_chain() {
  if (!chain_open() || on_wire_.priority < bus::Priority::interactive) return false;
  if (on_wire_.axis != nullptr && on_wire_.axis->pending().chain_job() == on_wire_.job) return false;
  constexpr Duration kChainPause = std::chrono::milliseconds(1);
  if (on_wire_.job != 0) core_.bus.wait(on_wire_.job, core_.turn.now + kChainPause);
  return true;
}

// The adapter tells the drive; the client whose object it was is told here.
void Drive::break_chain() {
  for (auto& axis : core_.axes)
    if (axis->pending().chain_job() != 0) axis->queue().on_job_ended(axis->pending().chain_job(), Errc::busy);
}

namespace {

std::string_view why_held(Errc code) {
  if (code == Errc::dropped_by_stop) return "a stop is newer";
  if (code == Errc::bad_value) return "it is beyond a limit, or at another speed than was asked for";
  return code == Errc::never_started ? "it comes too late" : "nobody has asked for it";
}

}  // namespace

// Whoever has planned it: by what it would do to each motor that it reaches.
bool Drive::may_leave(const bus::Exchange& exchange) {
  Sender sender{.keeps = on_wire_.keeps_alive.has_value()};
  const Pending* const pending = on_wire_.axis == nullptr ? nullptr : on_wire_.axis->pending().find(on_wire_.job);
  if (pending != nullptr) {
    const CommandSequence& sequence = *pending->command_sequence;
    sender = {.asked = sequence.asked(),
              .stops = sequence.is_stop(),
              .begins = asks_to_begin(sequence.batch()),
              .by = pending->begins_by()};
  }
  const std::vector<Written> sent = sent_by(core_.axes.front()->core(), exchange);
  return std::ranges::all_of(sent, [&](const Written& write) { return may_leave(write, sender); });
}

bool Drive::may_leave(const Written& write, const Sender& sender) {
  // A bring-up that would enable gets no further, and does not spin.
  constexpr Duration kHeldBackPause = std::chrono::milliseconds(500);
  const model::ObjectDef& def = core_.model.object(write.object);
  for (auto& axis : core_.axes) {
    if (def.slot != kNoAxis && axis != core_.axes[def.slot]) continue;
    Sender as_asked = sender;
    if (axis.get() != on_wire_.axis && !axis->core().model.shares.empty()) {
      // A stop of it has stopped the sender as well, and no word enables what has failed.
      if (axis->core().state().faulted()) continue;
      if (sender.asked) as_asked.asked = axis->core().motion.record().now();
    }
    const Errc code = held_on_way_out(axis->core(), write.object, write.number, as_asked);
    if (code == Errc::ok) continue;
    axis->on_held_back(fmt::format("{} = {} was held back: {}", def.name, write.number, why_held(code)), sender.stops);
    give_back(code);
    if (on_wire_.axis == nullptr && on_wire_.job != 0) core_.bus.wait(on_wire_.job, core_.turn.now + kHeldBackPause);
    return false;
  }
  return true;
}

void Drive::give_back(Errc code) {
  if (on_wire_.axis != nullptr)
    on_wire_.axis->queue().on_job_ended(on_wire_.job, code);
  else if (on_wire_.keeps_alive)
    control_.failed(*on_wire_.keeps_alive);
}

// --- What comes back -----------------------------------------------------------------------------------------------

void Drive::on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  begin_turn();
  const Ended ended{.exchange = exchange,
                    .result = result,
                    .asked = on_wire_,
                    .trusted = core_.reads.counts(on_wire_.read),
                    .written = written_by(core_.model, exchange)};
  if (link_.judge(ended)) {
    const auto& [job, axis, priority, read, keeps_alive] = on_wire_;
    bool owned = job == 0;
    for (DriveTask* task : tasks_) {
      owned = owned || task->owns(job);
      task->on_result(ended);
    }
    if (axis != nullptr && axis->pending().find(job) != nullptr) {
      owned = true;
      axis->queue().on_result(job, result, read.sent_at, ended.trusted);
    }
    for (const auto& [id, number] : all_written(core_.model, exchange)) {
      // Whoever asked was given up while it was on the wire: what the drive holds now must be known all the same.
      if (!owned && result.code == Errc::ok && ended.trusted)
        core_.store.acknowledged(id, number, read.sent_at);
      else if (!owned && result.code != Errc::refused_by_drive)
        core_.store.invalidate(id);
      if (result.code == Errc::ok) core_.reads.written(id, core_.turn.now);
    }
  }
  after_event();
}

void Drive::on_link(bool up) {
  begin_turn();
  link_.on_link(up);
  after_event();
}

void Drive::on_job_ended(const bus::Arbiter::Ending& ending) {
  begin_turn();
  if (Axis* owner = axis_of(ending.axis)) owner->queue().on_job_ended(ending.id, ending.code);
  for (DriveTask* task : tasks_)
    if (task->owns(ending.id)) task->on_lost();
  after_event();
}

void Drive::on_unsolicited(const bus::UnsolicitedEvent& unsolicited) {
  begin_turn();
  switch (unsolicited.kind) {
    case bus::UnsolicitedEvent::Kind::started:
      link_.on_started();
      break;
    case bus::UnsolicitedEvent::Kind::present:
      link_.on_present(unsolicited.state);
      break;
    case bus::UnsolicitedEvent::Kind::gone:
      link_.on_gone();
      break;
    case bus::UnsolicitedEvent::Kind::stranger:
      link_.on_stranger(static_cast<std::uint8_t>(unsolicited.code));
      break;
    case bus::UnsolicitedEvent::Kind::values:
      poll_.on_values(unsolicited.fields);
      break;
    case bus::UnsolicitedEvent::Kind::emergency:
      causes_.on_emergency(unsolicited);
      break;
    case bus::UnsolicitedEvent::Kind::duplicate_node:
      core_.presence.on_duplicate(core_.turn.now);
      core_.tell_all(EventKind::warning, node(),
                     fmt::format("two devices answer as node {}: give one of them another number", core_.model.node));
      break;
    case bus::UnsolicitedEvent::Kind::foreign_write:
      // As after a timeout: whatever it holds is read anew, and every start writes what it goes by.
      core_.store.lose_contact();
      break;
    case bus::UnsolicitedEvent::Kind::babbling:
      core_.tell_all(EventKind::warning, unsolicited.code,
                     fmt::format("floods the bus with frames 0x{:03X}", unsolicited.code));
      break;
  }
  after_event();
}

// --- Time ----------------------------------------------------------------------------------------------------------

void Drive::on_time() {
  begin_turn();
  for (auto& axis : core_.axes) axis->on_time();
  after_event();
}

void Drive::after_event() {
  bring_up_to_date();
  for (auto& axis : core_.axes) axis->queue().call_back();
  end_.call_back();
}

void Drive::bring_up_to_date() {
  for (auto& axis : core_.axes) {
    axis->observe();
    poll_.hurry(*axis);
  }
  core_.reads.refresh(core_.turn.now);
  setup_.go_on();
  core_.set_alarm(AxisAlarm::duplicate_node, core_.presence.duplicated(core_.turn.now));
  Instant next = kNever;
  for (auto& axis : core_.axes) {
    axis->publish();
    next = std::min(next, axis->next_deadline());
    if (axis->queue().has_due()) next = core_.turn.now;
  }
  // The keep-alive, which may take any turn, is the last that asks for one of its own.
  for (auto task = tasks_.rbegin(); task != tasks_.rend(); ++task) next = std::min(next, (*task)->deadline());
  timer_->expires_at(next);
  core_.bus.set_poll_due(core_.slot, poll_due());
}

Instant Drive::poll_due() {
  if (core_.turn.link == LinkState::link_down) return kNever;
  if (core_.sought()) return core_.presence.look_due();
  if (core_.reads.suspect()) return core_.reads.resync_due(core_.turn.now);
  return core_.brought_up() && !chain_open() ? core_.reads.poll_due() : kNever;
}

}  // namespace axisgate::drive
