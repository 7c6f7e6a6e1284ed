// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace axisgate::drive {

bool LinkTask::takes(const OnWire& turn) {
  if (turn.job == 0 && core_.sought()) return true;
  return core_.reads.suspect() && !(turn.axis != nullptr && turn.axis->queue().passes_resync(turn.job));
}

std::optional<bus::Exchange> LinkTask::next(OnWire& turn) {
  if (turn.job == 0 && core_.sought()) return probe(turn);
  auto exchange = core_.reads.resync(turn.read, core_.turn.now);
  if (!exchange && turn.job != 0) core_.bus.wait(turn.job, core_.reads.silent_until());
  turn.becomes_own();
  return exchange;
}

// A probe of a drive that is not there: its reply must not be one to something lost long ago.
std::optional<bus::Exchange> LinkTask::probe(OnWire& turn) {
  NodePresence& presence = core_.presence;
  if (core_.turn.now < presence.look_due()) return std::nullopt;
  if (!core_.reads.may_probe(core_.turn.now)) {
    presence.look_at(core_.reads.silent_until());
    return std::nullopt;
  }
  using Look = NodePresence::Look;
  const Look look = presence.look(core_.turn.link == LinkState::unknown);
  if (look == Look::wake) {
    presence.look_later(core_.turn.now);
    return nmt(core_.model.node, NmtCommand::enter_pre_operational);
  }
  if (look == Look::give_up) {
    go_offline();
    return std::nullopt;
  }
  if (look == Look::call && core_.bus.call(core_.model.node)) {
    presence.called(core_.turn.now);
    return std::nullopt;
  }
  presence.asked();
  return core_.reads.probe(turn.read);
}

bool LinkTask::judge(const Ended& ended) {
  const auto& [exchange, result, asked, trusted, written] = ended;
  if (result.code == Errc::timed_out || result.code == Errc::bad_reply) {
    on_timeout(ended);
  } else if (result.code == Errc::link_lost) {
    core_.reads.lost(exchange, core_.turn.now);          // its reply may still come, after the line's return
  } else if (exchange.access != bus::Access::command) {  // which nobody answers
    on_answer(ended);
    // Nobody asked for the neighbours: whoever asked for the one asks again, in smaller company.
    if (core_.reads.split(exchange, result, asked.read)) return false;
  }
  setup_.on_given_up();
  return true;
}

void LinkTask::on_timeout(const Ended& ended) {
  core_.reads.timed_out(ended.exchange, ended.asked.read, core_.turn.now);
  const bool gone = core_.presence.timed_out();
  const auto insists = [&](const auto& axis) { return axis->pending().insists(ended.asked.job); };
  if (core_.turn.link == LinkState::offline) {
    core_.presence.look_later(core_.turn.now);
  } else if (gone && std::ranges::none_of(core_.axes, insists)) {
    // A stop has its three tries, also at a drive that was silent before it came.
    go_offline();
  } else if (core_.turn.link == LinkState::online && !core_.reads.expects_silence(ended.exchange)) {
    core_.turn.link = LinkState::suspect;
  }
}

void LinkTask::go_offline() {
  core_.turn.link = LinkState::offline;
  setup_.on_lost();
  setup_.unmap();
  core_.bus.end_drive(core_.slot, Errc::offline, Errc::link_lost);
  core_.presence.look_later(core_.turn.now);
  tell_strangers();
}

void LinkTask::on_stranger(std::uint8_t node) {
  strangers_ += fmt::format("{}{}", strangers_.empty() ? "" : ", ", node);
  tells_strangers_ = true;
  if (core_.turn.link == LinkState::offline) tell_strangers();
}

// One that has answered as itself is what it is configured as.
void LinkTask::tell_strangers() {
  if (answered_ || !std::exchange(tells_strangers_, false)) return;
  core_.tell_all(EventKind::warning, 0,
                 fmt::format("offline: nobody answers as node {}, and node {} is heard on this bus, which no drive of "
                             "the configuration has: if that is this drive, correct its \"node\"",
                             core_.model.node, strangers_));
}

void LinkTask::on_answer(const Ended& ended) {
  // Of a read that counts lost replies out each answer may be one of them: no sign that it answers what it is asked.
  if (!ended.asked.read.counted) core_.presence.answered();
  answered_ = true;
  if (core_.reads.answered(ended.exchange, ended.result, ended.asked.read, core_.turn.now) &&
      core_.turn.link == LinkState::suspect) {
    core_.turn.link = LinkState::online;
    for (auto& axis : core_.axes) axis->on_invalidated();
  }
  if (ended.trusted) {
    const DriveReads::Taken taken = core_.reads.take(ended.exchange, ended.result, ended.asked.read, core_.turn.now);
    for (const std::string& object : taken.unlike)
      core_.event(core_.model.axes.front().number, EventKind::warning, 0, object);
    if (!taken.unlike.empty() && core_.turn.link != LinkState::setup) judge_profile(core_);
    if (taken.back) judge_given_up(core_);
    for (auto& axis : core_.axes) {
      if (taken.scales) axis->on_scale();
      if (taken.samples) axis->on_samples();
    }
  }
  // The answer to a stop may be a late one: only what cannot be begins a bring-up.
  if (core_.sought() && !core_.reads.suspect()) setup_.begin(true);
}

void LinkTask::on_link(bool up) {
  core_.presence.on_link(up, core_.turn.now);
  setup_.on_lost();
  setup_.unmap();
  core_.turn.link = up ? LinkState::unknown : LinkState::link_down;
}

// Whatever was sent to it is void; nothing that it held survives. It is brought up anew, and never enabled by us.
void LinkTask::on_started() {
  core_.presence.on_started();
  if (core_.turn.link == LinkState::link_down) return;
  if (core_.brought_up() || core_.turn.link == LinkState::offline)
    core_.tell_all(EventKind::boot, 0, "the drive has restarted");
  setup_.on_lost();
  core_.bus.end_drive(core_.slot, Errc::offline, Errc::link_lost);
  setup_.begin(true);
  for (auto& axis : core_.axes) axis->on_restarted();
}

void LinkTask::on_present(bus::NodeState state) {
  const bool news = core_.presence.on_present(state);
  if (core_.sought()) {
    // A sign like the one before is no reason to ask sooner.
    if (!news) return;
    core_.presence.found();
    core_.presence.look_at(core_.turn.now);
    return;
  }
  // A drive that was adopted, or is another than configured, was never told to start.
  BringUp& bring_up = core_.bring_up;
  const bool was_started = !bring_up.adopted() && bring_up.is_configured();
  if (was_started && core_.brought_up() && bring_up.start().has_left(state, core_.turn.now)) setup_.on_left(state);
}

void LinkTask::on_gone() {
  const bool was_there = core_.turn.link != LinkState::link_down && core_.turn.link != LinkState::offline;
  core_.presence.on_gone(was_there);
  if (!was_there) return;
  core_.tell_all(EventKind::warning, 0, "no sign of life from the node any more");
  go_offline();
}

// --- Polls ---------------------------------------------------------------------------------------------------------

void PollTask::hurry(const Axis& axis) {
  const AxisCore& core = axis.core();
  if (core.motion.end_wants_position()) core_.reads.first(core.object_of(Quantity::position_actual));
  if (core.motion.stopping() && core.motion.rest_wants_sample(core.facts()))
    core_.reads.hurry(core.motion_object(), core_.turn.now);
}

void PollTask::on_values(const bus::ReplyFields& fields) {
  // A drive that owes a reply is not trusted in anything, until its resynchronisation read is answered.
  if (!core_.brought_up() || core_.reads.suspect()) return;
  core_.reads.take_unsolicited(fields, core_.turn.now);
  for (auto& axis : core_.axes) {
    axis->on_samples();
    const AxisCore& core = axis->core();
    if (core.motion.end_wants_sample(core.facts())) core_.reads.hurry_state(core.model, core_.turn.now);
  }
}

Instant PollTask::deadline() {
  for (auto& axis : core_.axes) {
    const bool moves = axis->core().motion.running() != MotionKind::none || axis->core().moving();
    core_.reads.watch_position(axis->core().model, moves, core_.turn.now);
  }
  return kNever;
}

}  // namespace axisgate::drive
