#include "gateway/drive/drive.hpp"

#include <algorithm>
#include <utility>

#include "gateway/drive/publisher.hpp"

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
      fence_(model_.fence, model_.objects),
      blocks_(model_),
      constants_(model_.constants.size()),
      bring_up_(model_),
      frame_(model_),
      keep_alive_(model_),
      backoff_(bus.settings().timeout),
      start_backoff_(bus.settings().timeout),
      timer_(runtime.make_timer([this] { on_time(); })),
      mapped_(model_.objects.size(), false),
      disarming_(model_) {
  assert(images.size() == model_.axes.size());
  for (const ObjectDef& object : model_.objects) width_.push_back(object.size);
  AxisHost& host = *this;
  for (std::size_t i = 0; i < images.size(); ++i)
    axes_.push_back(std::make_unique<Axis>(model_, static_cast<bus::AxisSlot>(i), store_, *images[i], host));
  map_unasked();
  bus_.attach(slot_, *this);
  after_event();
}

std::optional<GroupResult> Drive::submit(bus::AxisSlot axis, const Group& group, GroupCallback on_result) {
  auto result = axes_[axis]->submit(group, std::move(on_result));
  // Callbacks of others wait for the next turn of the loop: nobody is called from inside submit().
  bring_up_to_date();
  return result;
}

void Drive::client_gone(ClientId client) {
  for (auto& axis : axes_) axis->on_client_gone(client);
  bring_up_to_date();
}

AxisHost::Queued Drive::queue(bus::Order order) {
  order.drive = slot_;
  const auto admission = bus_.submit(order);
  return {admission.code, admission.id, admission.joined};
}

AxisHost::Queued Drive::queue_own(bus::Priority priority) {
  bus::Order order;
  order.priority = priority;
  order.axis = bus::kNoAxis;
  return queue(std::move(order));
}

void Drive::event(AxisNumber axis, EventKind kind, std::uint32_t code, std::string text) {
  events_.add(now(), axis, kind, code, std::move(text));
}

// --- What goes on the wire -----------------------------------------------------------------------------------------

std::optional<bus::Exchange> Drive::on_grant(bus::OrderId id, bus::Priority priority) {
  on_wire_ = {.order = id, .sent_at = now()};
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
  return fence_.suspect() ? fence(0) : poll();
}

std::optional<bus::Exchange> Drive::exchange_of(bus::OrderId id, bus::Priority priority) {
  Axis* owner = nullptr;
  for (auto& axis : axes_)
    if (axis->has(id)) owner = axis.get();
  if (fence_.suspect() && !(owner != nullptr && owner->passes_fence(id))) {
    on_wire_.order = 0;  // the order keeps its turn; this exchange is the drive's own
    return fence(id);
  }
  if (owner != nullptr) {
    if (const auto look = look_before_frame(priority == bus::Priority::stop)) {
      on_wire_.order = 0;
      return look;
    }
    return owner->on_grant(id);
  }
  if (id == closing_order_) return next_of_closing();
  if (id == cause_order_) return next_of_causes();
  return id == setup_order_ ? next_of_bring_up() : std::nullopt;
}

bool Drive::chain_open() const {
  return std::any_of(axes_.begin(), axes_.end(), [](const auto& axis) { return axis->chain_order() != 0; });
}

bool Drive::waits_for_chain(bus::OrderId id, bus::Priority priority) {
  if (!chain_open() || priority < bus::Priority::interactive) return false;
  if (std::any_of(axes_.begin(), axes_.end(), [&](const auto& axis) { return axis->chain_order() == id; }))
    return false;
  constexpr Duration kChainPause = std::chrono::milliseconds(1);
  if (id != 0) bus_.wait(id, now() + kChainPause);
  return true;
}

// The adapter tells the drive; the client whose object it was is told here.
void Drive::break_chain() {
  for (auto& axis : axes_)
    if (axis->chain_order() != 0) axis->on_order_ended(axis->chain_order(), Errc::busy);
}

// A probe of a drive that is not there: its reply must not be one to something lost long ago.
std::optional<bus::Exchange> Drive::probe() {
  if (now() < probe_due_) return std::nullopt;
  on_wire_.probe = true;
  if (fence_.suspect()) {
    if (now() < fence_.silent_until()) {
      probe_due_ = fence_.silent_until();
      return std::nullopt;
    }
    fence_.waited_out();
  }
  if (is_canopen(model_) && heard_ && node_state_ == bus::NodeState::stopped) {
    // It answers no SDO in this state, and so tells nothing; what its motor does is not changed by leaving it.
    on_wire_.probe = false;
    probe_due_ = now() + backoff_.next();
    return nmt(model_.node, NmtCommand::enter_pre_operational);
  }
  // A call that nobody has answered is a timeout as well, but it kept nobody from the wire.
  if (state_ == LinkState::unknown && !heard_ && calls_ > 0 && ++mute_ >= kMuteTimeouts) {
    go_offline();
    return std::nullopt;
  }
  if (is_canopen(model_) && asked_ && !heard_ && calls_ < kCallsPerQuestion && bus_.call(model_.node)) {
    ++calls_;
    probe_due_ = now() + backoff_.next();
    return std::nullopt;
  }
  asked_ = true;
  calls_ = 0;
  return probe_read();
}

std::optional<bus::Exchange> Drive::fence(bus::OrderId order) {
  const auto candidate = fence_.candidate();
  if (candidate && !fence_.exhausted()) {
    fence_.fence_sent();
    on_wire_.fence = true;
    return read(*candidate);
  }
  if (now() < fence_.silent_until()) {
    if (order != 0) bus_.wait(order, fence_.silent_until());
    return std::nullopt;
  }
  fence_.waited_out();
  on_wire_.fence = true;
  return probe_read();
}

std::optional<bus::Exchange> Drive::poll() {
  if (!brought_up()) return std::nullopt;
  const auto object = plan_.next(now());
  if (!object) return std::nullopt;
  return read(*object);
}

// --- What comes back -----------------------------------------------------------------------------------------------

void Drive::on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  const OnWire asked = on_wire_;
  const bool trusted = !fence_.suspect() || asked.fence;
  if (result.code == Errc::timed_out || result.code == Errc::bad_reply) {
    const bool stop_insists =
        std::any_of(axes_.begin(), axes_.end(), [&](const auto& axis) { return axis->insists(asked.order); });
    on_timeout(exchange, stop_insists);
  } else if (result.code == Errc::link_lost) {
    fence_.lost(exchange, now());                        // its reply may still come, after the line's return
  } else if (exchange.access != bus::Access::command) {  // which nobody answers
    on_answer(exchange, result);
    // Nobody asked for the neighbours: whoever asked for the one asks again, in smaller company.
    if (split(exchange, result)) {
      after_event();
      return;
    }
  }
  const ObjectId written = exchange.access == bus::Access::write ? model_.find(exchange.object) : kNoObject;
  on_control_result(exchange, result, asked, written, trusted);
  if (asked.order != 0) {
    bool owned = asked.order == setup_order_;
    if (owned) carry_on_bring_up(exchange, result);
    if (asked.order == closing_order_) {
      owned = true;
      carry_on_closing(result, trusted);
    }
    for (auto& axis : axes_) {
      if (!axis->has(asked.order)) continue;
      owned = true;
      axis->on_result(asked.order, result, asked.sent_at, trusted);
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
    store_.doubt(id);
}

void Drive::on_timeout(const bus::Exchange& exchange, bool stop_insists) {
  fence_.lost(exchange, now());
  if (on_wire_.widened) silent_read_ = exchange;
  store_.doubt_all();
  ++mute_;
  if (state_ == LinkState::offline) {
    probe_due_ = now() + backoff_.next();
    return;
  }
  // A stop has its three tries, also at a drive that was silent before it came.
  if (mute_ >= kMuteTimeouts && !stop_insists) {
    go_offline();
  } else if (state_ == LinkState::online) {
    set_state(LinkState::suspect);
  }
}

void Drive::go_offline() {
  set_state(LinkState::offline);
  setup_order_ = 0;
  unmap_values();
  bus_.end_drive(slot_, Errc::offline, Errc::link_lost);
  probe_due_ = now() + backoff_.next();
}

void Drive::on_answer(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  mute_ = 0;
  const bool counts = !fence_.suspect() || on_wire_.fence || on_wire_.probe;
  // An error answer is no answered fence; the next candidate is tried.
  if (result.code == Errc::ok && (on_wire_.fence || on_wire_.probe)) {
    fence_.answered();
    // It lives, and did not answer a longer read: after the second time that counts as a refusal.
    if (silent_read_ && on_wire_.fence) static_cast<void>(blocks_.silent(*silent_read_));
    silent_read_.reset();
    if (state_ == LinkState::suspect) {
      set_state(LinkState::online);
      for (auto& axis : axes_) axis->on_doubt();
    }
  }
  if (result.code == Errc::refused_by_drive && on_wire_.fence) fence_.lost(exchange, now());
  if (counts) store_fields(exchange, result);
  // The answer to a stop may be a late one: only what cannot be begins a bring-up.
  const bool not_there = state_ == LinkState::unknown || state_ == LinkState::offline;
  if (not_there && !fence_.suspect()) begin_bring_up(true);
}

// --- Link and time -------------------------------------------------------------------------------------------------

void Drive::on_link(bool up) {
  mute_ = 0;
  setup_order_ = 0;
  heard_ = asked_ = false;
  node_state_ = bus::NodeState::unknown;
  unmap_values();
  backoff_.reset();
  set_state(up ? LinkState::unknown : LinkState::link_down);
  probe_due_ = up ? now() : kNever;  // where a reply is still owed, the probe keeps silence first
  after_event();
}

void Drive::on_order_ended(bus::OrderId id, Errc code) {
  for (auto& axis : axes_) axis->on_order_ended(id, code);
  if (id == setup_order_) setup_order_ = 0;
  if (id == keep_alive_order_) keep_alive_order_ = 0;
  if (id == closing_order_) end_closing();
  if (id == cause_order_) cause_order_ = 0;
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
  if (doubts_seen_ != store_.doubts()) {
    doubts_seen_ = store_.doubts();
    plan_.refresh(now());
  }
  if (brought_up()) {
    for (auto& axis : axes_)
      for (const Check& check : model_.checks) axis->set_alarm(check.alarm, false);
    judge_checks();
    leave_adoption();
  }
  const bool twin = now() < twin_until_;
  for (auto& axis : axes_) axis->set_alarm(AxisAlarm::duplicate_node, twin);
  Instant next = twin ? twin_until_ : kNever;
  if (fell_back_ && now() < set_up_after_) next = std::min(next, set_up_after_);
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
    bus_.set_poll_due(slot_, probe_due_);
  } else if (fence_.suspect()) {
    bus_.set_poll_due(slot_, fence_.exhausted() ? fence_.silent_until() : now());
  } else {
    bus_.set_poll_due(slot_, brought_up() && !chain_open() ? plan_.next_due() : kNever);
  }
}

}  // namespace axisgate::drive
