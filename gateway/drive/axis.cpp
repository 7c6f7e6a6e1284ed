#include "gateway/drive/axis.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "gateway/drive/admission.hpp"
#include "gateway/drive/publisher.hpp"

namespace axisgate::drive {

Axis::Axis(const DriveModel& drive, bus::AxisSlot slot, ObjectStore& store, AxisImage& image, AxisHost& host)
    : host_(host), image_(image), slot_(slot), core_{drive, drive.axes[slot], store} {
  show_model(core_.model, image_);
  set_alarm(AxisAlarm::no_comm_watchdog, !drive.stops_by_itself);
}

Axis::Pending* Axis::find(bus::OrderId id) {
  const auto found = std::find_if(pending_.begin(), pending_.end(), [&](const Pending& p) { return p.id == id; });
  return found == pending_.end() ? nullptr : &*found;
}

bool Axis::motion_pending() const {
  return std::any_of(pending_.begin(), pending_.end(), [](const Pending& p) { return p.starts_motion; });
}

bool Axis::holds(Quantity quantity, std::int64_t value) const {
  if (quantity == Quantity::mode)
    return core_.model.mode != kNoObject && core_.store[core_.model.mode].held && core_.mode_in_force() == value;
  const Binding* binding = core_.model.binding(quantity);
  if (binding == nullptr || binding->object == kNoObject || !core_.store[binding->object].held) return false;
  return core_.value(quantity) == value;
}

void Axis::set_alarm(AxisAlarm alarm, bool on) {
  core_.alarms = on ? core_.alarms | bit(alarm) : core_.alarms & ~bit(alarm);
}

void Axis::on_bring_up() {
  core_.homing_method_given = core_.model.homing_method.has_value();
  core_.mode_chosen = false;
  core_.homed = false;
}

// --- Taking a group ----------------------------------------------------------------------------------------------------

Errc Axis::link_admits(bool stop) const {
  switch (host_.link_state()) {
    case LinkState::online:
    case LinkState::suspect:
      return core_.alarm(AxisAlarm::identity_mismatch) && !stop ? Errc::identity_mismatch : Errc::ok;
    case LinkState::setup:
      return stop ? Errc::ok : Errc::still_in_setup;
    case LinkState::unknown:
      return Errc::still_in_setup;
    case LinkState::offline:
    case LinkState::link_down:
      break;
  }
  return Errc::offline;
}

// Two panels pressing the same stop need it on the wire once.
bool Axis::join_stop(const Group& group, GroupCallback& on_result) {
  if (!group.setpoints.empty() || group.mode || group.object || group.set_position_value) return false;
  for (Pending& p : pending_) {
    const Group& waiting = p.conversation->group();
    if (!p.conversation->is_stop() || p.conversation->begun() || p.callbacks.size() >= kMaxJoined) continue;
    if (waiting.command != group.command || waiting.controlword != group.controlword) continue;
    p.callbacks.push_back(std::move(on_result));
    return true;
  }
  return false;
}

void Axis::accept_stop(const Group& group) {
  core_.motion.stop(stop_latches(core_, group));
  last_stopper_ = group.client;
}

std::optional<GroupResult> Axis::submit(const Group& asked, GroupCallback on_result) {
  const Group group = as_quantities(core_, asked);
  const auto refuse = [](Errc code) {
    return GroupResult{{code, code == Errc::state_unsuitable ? kDetailDeviceState : 0}, 0, 0};
  };
  if (const Errc code = admit(core_, group); code != Errc::ok) return refuse(code);
  const bool stop = holds_stop(group);
  // Accepted in every state: the latch is set even where nothing can be sent.
  if (stop) accept_stop(group);
  if (const Errc code = link_admits(stop); code != Errc::ok) {
    if (stop) publish(host_.now());
    return refuse(code);
  }
  if (stop && join_stop(group, on_result)) return std::nullopt;

  Pending pending;
  pending.conversation = std::make_unique<Conversation>(core_, group, stop);
  pending.starts_motion = starts_motion(core_, group);
  const bool idle = pending_.empty();
  if (idle && !stop) {
    // Nothing ahead of it: what needs no wire is answered at once.
    const auto move = pending.conversation->advance(host_.now());
    if (move.kind == Conversation::Move::Kind::finished) {
      const GroupResult result = pending.conversation->result();
      if (!group.object) image_.latest = {command_result(result.outcome.code), result.outcome.detail, group.command_id};
      publish(host_.now());
      return result;
    }
  }
  bus::Order order = order_for(core_, group, stop);
  order.axis = slot_;
  const AxisHost::Queued queued = host_.queue(std::move(order));
  if (queued.code != Errc::ok) return refuse(queued.code);
  if (queued.joined) {
    Pending* twin = find(queued.id);
    if (twin == nullptr || twin->callbacks.size() >= kMaxJoined) return refuse(Errc::queue_full);
    twin->callbacks.push_back(std::move(on_result));
    return std::nullopt;
  }
  pending.id = queued.id;
  pending.callbacks.push_back(std::move(on_result));
  if (!group.object) image_.latest = {CommandResult::pending, 0, group.command_id};
  if (pending.starts_motion) core_.motion.mask_target_reached();
  pending_.push_back(std::move(pending));
  publish(host_.now());
  return std::nullopt;
}

// --- Carrying it out -----------------------------------------------------------------------------------------------------

std::optional<bus::Exchange> Axis::on_grant(bus::OrderId id) {
  Pending* pending = find(id);
  if (pending == nullptr) return std::nullopt;
  const auto move = pending->conversation->advance(host_.now());
  if (move.kind == Conversation::Move::Kind::exchange) return move.exchange;
  if (move.kind == Conversation::Move::Kind::wait) {
    host_.order_waits(id, move.until);
  } else {
    complete(id, pending->conversation->result());
  }
  return std::nullopt;
}

bool Axis::passes_fence(bus::OrderId id) const {
  const Pending* pending = find(id);
  return pending != nullptr && pending->conversation->passes_fence();
}

void Axis::on_result(bus::OrderId id, const bus::ExchangeResult& result, Instant sent_at, bool trusted) {
  Pending* pending = find(id);
  if (pending == nullptr) return;
  const Conversation& conversation = *pending->conversation;
  pending->conversation->on_result(result, sent_at, trusted);
  if (conversation.group().object && conversation.group().object->write && result.code == Errc::ok) {
    const ObjectId object = core_.drive.find({conversation.group().object->index, conversation.group().object->subindex});
    if (object != kNoObject) host_.read_soon(object);
  }
  carry_on(*pending);
}

void Axis::carry_on(Pending& pending) {
  const auto move = pending.conversation->advance(host_.now());
  if (move.kind == Conversation::Move::Kind::finished) {
    complete(pending.id, pending.conversation->result());
    return;
  }
  if (move.kind == Conversation::Move::Kind::wait) host_.order_waits(pending.id, move.until);
  if (!pending.conversation->stop_is_over()) return;
  // The stop is done; the rest of its group waits its turn like any other.
  bus::Order rest = order_for(core_, pending.conversation->group(), false);
  rest.axis = slot_;
  rest.read.reset();
  rest.setpoints_only = false;
  rest.start_by = kNever;
  host_.order_done(pending.id);
  const AxisHost::Queued queued = host_.queue(std::move(rest));
  if (queued.code != Errc::ok) {
    complete(pending.id, {{queued.code, 0}, 0, 0});
    return;
  }
  pending.id = queued.id;
  pending.conversation->stop_was_handed_over();
}

void Axis::on_order_ended(bus::OrderId id, Errc code) {
  Pending* pending = find(id);
  if (pending == nullptr) return;
  Conversation& conversation = *pending->conversation;
  if (code == Errc::dropped_by_stop && conversation.begun())
    code = conversation.group().client == last_stopper_ ? Errc::superseded : Errc::stopped_by_other;
  // Nothing of it was ever sent: the link's end is no unknown outcome.
  if (code == Errc::link_lost && !conversation.begun()) code = Errc::offline;
  conversation.abort({code, 0});
  complete(id, conversation.result());
}

void Axis::complete(bus::OrderId id, const GroupResult& result) {
  const auto found = std::find_if(pending_.begin(), pending_.end(), [&](const Pending& p) { return p.id == id; });
  if (found == pending_.end()) return;
  Pending pending = std::move(*found);
  pending_.erase(found);
  host_.order_done(id);
  if (!motion_pending()) core_.motion.unmask_target_reached();
  const Group& group = pending.conversation->group();
  if (!group.object) image_.latest = {command_result(result.outcome.code), result.outcome.detail, group.command_id};
  due_.push_back({result, std::move(pending.callbacks)});
}

// --- Time --------------------------------------------------------------------------------------------------------------

void Axis::on_time(Instant now) {
  std::vector<std::pair<bus::OrderId, Errc>> late;
  for (const Pending& p : pending_)
    if (now >= p.conversation->group().answer_by)
      late.emplace_back(p.id, p.conversation->begun() ? Errc::timed_out : Errc::never_started);
  for (const auto& [id, code] : late) {
    Pending* pending = find(id);
    pending->conversation->abort({code, 0});
    complete(id, pending->conversation->result());
  }
  core_.motion.observe(core_.facts(), core_.model.homing_timeout, now);
  if (core_.motion.take_homing_timeout()) {
    host_.event(image_.number, EventKind::warning, 0, "homing took longer than its timeout: halted");
    Group halt;
    halt.role = Role::engineer;
    halt.command = Command::halt;
    static_cast<void>(submit(halt, [](const GroupResult&) {}));
  }
}

Instant Axis::next_deadline() const {
  Instant next = core_.motion.deadline();
  for (const Pending& p : pending_) next = std::min(next, p.conversation->group().answer_by);
  return next;
}

// --- The image -----------------------------------------------------------------------------------------------------------

void Axis::publish(Instant now) {
  core_.reachable = host_.link_state() == LinkState::online || host_.link_state() == LinkState::suspect;
  const AxisFacts facts = core_.facts();
  const Instant statusword_at = core_.store[core_.model.statusword].sent_at;
  if (statusword_at > last_statusword_) {
    if (last_statusword_ != kLongAgo) cycle_ = statusword_at - last_statusword_;
    last_statusword_ = statusword_at;
  }
  core_.motion.observe(facts, core_.model.homing_timeout, now);
  if (facts.reference && core_.reachable && core_.motion.running() != MotionKind::homing) core_.homed = true;
  const AxisImage before = image_;
  image_.link_state = host_.link_state();
  show_state(core_, image_, now);
  if (!shows_the_same(before, image_)) {
    ++image_.sequence;
    tell_changes(before);
  }
}

void Axis::tell_changes(const AxisImage& before) {
  if (before.link_state != image_.link_state)
    host_.event(image_.number, EventKind::link, static_cast<std::uint32_t>(image_.link_state),
                "link " + std::string(text(before.link_state)) + " -> " + std::string(text(image_.link_state)));
  if (!image_.reachable()) return;
  if (image_.has(AxisInput::fault) && !before.has(AxisInput::fault)) {
    const AlarmRow* row = active_alarm(core_);
    const auto code = static_cast<std::uint32_t>(image_[Quantity::error_code].value);
    host_.event(image_.number, EventKind::fault, code,
                row == nullptr ? "the drive reports a fault" : row->text + "; " + row->remedy);
  }
  if (image_.has(AxisInput::homed) && !before.has(AxisInput::homed))
    host_.event(image_.number, EventKind::homed, 0, "homed");
  const std::uint32_t raised = image_.alarms & ~before.alarms;
  for (std::size_t i = 0; i < kAxisAlarmCount; ++i) {
    const auto alarm = static_cast<AxisAlarm>(i);
    if ((raised & bit(alarm)) != 0)
      host_.event(image_.number, EventKind::warning, static_cast<std::uint32_t>(i), alarm_text(core_, alarm));
  }
}

void Axis::call_back() {
  std::vector<Due> due;
  due.swap(due_);
  for (Due& d : due)
    for (GroupCallback& callback : d.callbacks) callback(d.result);
}

}  // namespace axisgate::drive
