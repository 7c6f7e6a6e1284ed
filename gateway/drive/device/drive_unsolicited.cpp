// SPDX-License-Identifier: Apache-2.0
// What a drive says without being asked: that it has started, lives, is gone, has a fault; and its process data.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adapters/bus/node_state.hpp"
#include "gateway/drive/device/drive.hpp"

namespace axisgate::drive {

void Drive::tell_all(EventKind kind, std::uint32_t code, const std::string& text) {
  for (const auto& axis : axes_) event(axis->core().model.number, kind, code, text);
}

void Drive::on_unsolicited(const bus::UnsolicitedEvent& unsolicited) {
  switch (unsolicited.kind) {
    case bus::UnsolicitedEvent::Kind::started:
      on_started();
      break;
    case bus::UnsolicitedEvent::Kind::present:
      on_present(unsolicited.state);
      break;
    case bus::UnsolicitedEvent::Kind::gone:
      on_gone();
      break;
    case bus::UnsolicitedEvent::Kind::values:
      on_values(unsolicited.fields);
      break;
    case bus::UnsolicitedEvent::Kind::emergency:
      on_emergency(unsolicited);
      break;
    case bus::UnsolicitedEvent::Kind::duplicate_node:
      presence_.on_duplicate(now());
      tell_all(EventKind::warning, model_.node,
               fmt::format("two devices answer as node {}: give one of them another number", model_.node));
      break;
    case bus::UnsolicitedEvent::Kind::babbling:
      tell_all(EventKind::warning, unsolicited.code,
               fmt::format("floods the bus with frames 0x{:03X}", unsolicited.code));
      break;
  }
  after_event();
}

// Whatever was sent to it is void; nothing that it held survives. It is brought up anew, and never enabled by us.
void Drive::on_started() {
  presence_.on_started();
  if (state_ == LinkState::link_down) return;
  if (brought_up() || state_ == LinkState::offline) tell_all(EventKind::boot, 0, "the drive has restarted");
  jobs_.setup = 0;
  bus_.end_drive(slot_, Errc::offline, Errc::link_lost);
  begin_bring_up(true);
  for (auto& axis : axes_) axis->on_restarted();
}

void Drive::on_present(bus::NodeState state) {
  const bool news = presence_.on_present(state);
  if (state_ == LinkState::unknown || state_ == LinkState::offline) {
    // A sign like the one before is no reason to ask sooner.
    if (!news) return;
    presence_.found();
    presence_.look_at(now());
    return;
  }
  // A drive that was adopted, or is another than configured, was never told to start.
  const bool was_started = !adopted_ && bring_up_.mismatch().empty() && lacks_.empty();
  if (was_started && brought_up() && node_start_.has_left(state, now())) left_operational(state);
}

// Our start was lost, somebody else has stopped it, or it fell back by itself. Its process data is dead; what runs is
// polled, and it is set up anew as soon as its motor is disabled: a node with an enabled motor gets no NMT command.
void Drive::left_operational(bus::NodeState state) {
  const Duration pause = node_start_.leave(now());
  tell_all(EventKind::warning, 0,
           fmt::format("the node is {} by no command of ours, or has missed its start: it is polled, and set up and "
                       "started again in {} ms, or when its motor is disabled",
                       bus::text(state), std::chrono::duration_cast<std::chrono::milliseconds>(pause).count()));
  for (std::size_t i = 0; i < mapped_.size(); ++i)
    if (mapped_[i]) store_.outdate(static_cast<ObjectId>(i));
  unmap_values();
}

void Drive::on_gone() {
  const bool was_there = state_ != LinkState::link_down && state_ != LinkState::offline;
  presence_.on_gone(was_there);
  if (!was_there) return;
  tell_all(EventKind::warning, 0, "no sign of life from the node any more");
  go_offline();
}

void Drive::on_values(const bus::ReplyFields& fields) {
  // A drive that owes a reply is not trusted in anything, until its resynchronisation read is answered.
  if (!brought_up() || resync_.suspect()) return;
  for (const bus::ReplyField& field : fields) {
    const ObjectId id = model_.find(field.object);
    if (id == kNoObject || !mapped_[id] || field.size != model_.object(id).size) continue;
    store_.read(id, model_.object(id).number(field.raw), now());
    plan_.received(id, now());
  }
  for (auto& axis : axes_) {
    axis->on_samples();
    if (!axis->end_wants_sample()) continue;
    for (const ObjectId id : axis->core().model.state_sources) plan_.hurry(id, now());
  }
}

// Where it is while it moves must not hang on a TPDO that has failed to come.
void Drive::watch_positions() {
  for (auto& axis : axes_) {
    const Binding* position = axis->core().model.binding(Quantity::position_actual);
    if (position == nullptr || position->object == kNoObject || !mapped_[position->object]) continue;
    const bool moves = axis->core().motion.running() != MotionKind::none || axis->core().facts().moving;
    plan_.confirm_within(position->object, moves ? std::optional(kMovingConfirm) : std::nullopt, now());
  }
}

// The code may be all that is told: what the fault words say is asked for at once.
void Drive::on_emergency(const bus::UnsolicitedEvent& unsolicited) {
  for (auto& axis : axes_) axis->on_emergency(unsolicited.code, now());
  std::string text = unsolicited.code == 0 ? std::string("EMCY 0x0000: the errors are over")
                                           : fmt::format("EMCY 0x{:04X}, error register 0x{:02X}, {}", unsolicited.code,
                                                         unsolicited.error_register, hex_text(unsolicited.vendor));
  if (unsolicited.repeats > 0) text += fmt::format(" ({} more were left out)", unsolicited.repeats);
  // Whether it is a fault the statusword tells, and then its cause is told once.
  tell_all(EventKind::warning, unsolicited.code, text);
  for (const AxisModel& axis : model_.axes) {
    for (const ObjectId id : axis.state_sources) plan_.hurry(id, now());
    for (const ObjectId id : axis.fault_words)
      if (id != kNoObject) plan_.hurry(id, now());
  }
}

void Drive::map_values() {
  for (const MappedTpdo& tpdo : bring_up_.node().mapped()) {
    bus::ProcessMap map;
    const auto event =
        tpdo.event_ms ? std::optional<Duration>(std::chrono::milliseconds(*tpdo.event_ms)) : std::nullopt;
    for (const ObjectId id : tpdo.objects) {
      map.push_back({model_.object(id).address, model_.object(id).size});
      mapped_[id] = true;
      plan_.map(id, event, model_.canopen.confirm);
      store_.set_period(id, event.value_or(model_.canopen.confirm));
    }
    bus_.map_process_data(model_.node, tpdo.number, map);
  }
}

// What a drive sends by itself, whatever we tell it: mapped for good.
void Drive::map_unasked() {
  for (const ObjectId id : model_.unasked.objects) {
    mapped_[id] = true;
    const bool state = tells_state(id);
    if (model_.unasked.every > Duration{} && !state) store_.set_period(id, model_.unasked.every);
  }
}

void Drive::unmap_values() {
  if (!is_canopen(model_)) return;
  for (const TpdoProperties& tpdo : model_.canopen.tpdos) bus_.map_process_data(model_.node, tpdo.number, {});
  for (std::size_t i = 0; i < mapped_.size(); ++i) {
    if (!mapped_[i]) continue;
    mapped_[i] = false;
    store_.set_period(static_cast<ObjectId>(i), Duration{});
  }
  plan_.unmap_all(now());
}

}  // namespace axisgate::drive
