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
  begin_turn();
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
      presence_.on_duplicate(turn_.now);
      tell_all(EventKind::warning, model_.node,
               fmt::format("two devices answer as node {}: give one of them another number", model_.node));
      break;
    case bus::UnsolicitedEvent::Kind::foreign_write:
      // As after a timeout: whatever it holds is read anew, and every start writes what it goes by.
      store_.lose_contact();
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
  if (turn_.link == LinkState::link_down) return;
  if (brought_up() || turn_.link == LinkState::offline) tell_all(EventKind::boot, 0, "the drive has restarted");
  jobs_.setup = 0;
  bus_.end_drive(slot_, Errc::offline, Errc::link_lost);
  begin_bring_up(true);
  for (auto& axis : axes_) axis->on_restarted();
}

void Drive::on_present(bus::NodeState state) {
  const bool news = presence_.on_present(state);
  if (turn_.link == LinkState::unknown || turn_.link == LinkState::offline) {
    // A sign like the one before is no reason to ask sooner.
    if (!news) return;
    presence_.found();
    presence_.look_at(turn_.now);
    return;
  }
  // A drive that was adopted, or is another than configured, was never told to start.
  const bool was_started = !bring_up_.adopted() && bring_up_.is_configured();
  if (was_started && brought_up() && bring_up_.start().has_left(state, turn_.now)) left_operational(state);
}

// Our start was lost, somebody else has stopped it, or it fell back by itself. Its process data is dead; what runs is
// polled, and it is set up anew as soon as its motor is disabled: a node with an enabled motor gets no NMT command.
void Drive::left_operational(bus::NodeState state) {
  const Duration pause = bring_up_.start().leave(turn_.now);
  tell_all(EventKind::warning, 0,
           fmt::format("the node is {} by no command of ours, or has missed its start: it is polled, and set up and "
                       "started again in {} ms, or when its motor is disabled",
                       bus::text(state), std::chrono::duration_cast<std::chrono::milliseconds>(pause).count()));
  // It may have started anew while nobody heard it.
  store_.lose_contact();
  reads_.outdate_mapped();
  unmap_values();
}

void Drive::on_gone() {
  const bool was_there = turn_.link != LinkState::link_down && turn_.link != LinkState::offline;
  presence_.on_gone(was_there);
  if (!was_there) return;
  tell_all(EventKind::warning, 0, "no sign of life from the node any more");
  go_offline();
}

void Drive::on_values(const bus::ReplyFields& fields) {
  // A drive that owes a reply is not trusted in anything, until its resynchronisation read is answered.
  if (!brought_up() || reads_.suspect()) return;
  reads_.take_unsolicited(fields, turn_.now);
  for (auto& axis : axes_) {
    axis->on_samples();
    if (axis->core().motion.end_wants_sample(axis->core().facts())) reads_.hurry_state(axis->core().model, turn_.now);
  }
}

void Drive::watch_positions() {
  for (auto& axis : axes_) {
    const bool moves = axis->core().motion.running() != MotionKind::none || axis->core().facts().moving;
    reads_.watch_position(axis->core().model, moves, turn_.now);
  }
}

// The code may be all that is told: what the fault words say is asked for at once.
void Drive::on_emergency(const bus::UnsolicitedEvent& unsolicited) {
  for (auto& axis : axes_) axis->faults().emergency(unsolicited.code, turn_.now, store_.exchange());
  std::string text = unsolicited.code == 0 ? std::string("EMCY 0x0000: the errors are over")
                                           : fmt::format("EMCY 0x{:04X}, error register 0x{:02X}, {}", unsolicited.code,
                                                         unsolicited.error_register, hex_text(unsolicited.vendor));
  if (unsolicited.repeats > 0) text += fmt::format(" ({} more were left out)", unsolicited.repeats);
  // Whether it is a fault the statusword tells, and then its cause is told once.
  tell_all(EventKind::warning, unsolicited.code, text);
  for (const model::AxisModel& axis : model_.axes) {
    reads_.hurry_state(axis, turn_.now);
    for (const model::ObjectId id : axis.fault_words)
      if (id != model::kNoObject) reads_.hurry(id, turn_.now);
  }
}

void Drive::map_values() {
  for (const MappedTpdo& tpdo : bring_up_.node().mapped()) {
    bus::ProcessMap map;
    const auto event =
        tpdo.event_ms ? std::optional<Duration>(std::chrono::milliseconds(*tpdo.event_ms)) : std::nullopt;
    for (const model::ObjectId id : tpdo.objects) {
      map.push_back({model_.object(id).address, model_.object(id).size});
      reads_.map(id, event);
    }
    bus_.map_process_data(model_.node, tpdo.number, map);
  }
}

void Drive::unmap_values() {
  if (!model::is_canopen(model_)) return;
  for (const model::TpdoProperties& tpdo : model_.canopen.tpdos) bus_.map_process_data(model_.node, tpdo.number, {});
  reads_.unmap(turn_.now);
}

}  // namespace axisgate::drive
