// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/bus/node_state.hpp"

namespace axisgate::drive {

std::optional<bus::Exchange> SetupTask::next(OnWire& /*turn*/) {
  BringUp& bring_up = core_.bring_up;
  const bool amends = bring_up.amending();
  const auto next = amends && enable_is_asked() ? std::nullopt : bring_up.next(core_.store);
  if (!next) {
    finish();
    bring_up.end_amending(core_.turn.now);
    amends ? judge_loss_reaction(core_) : end();
    return std::nullopt;
  }
  if (next->exchange) {
    if (next->exchange->access == bus::Access::command) bring_up.start().commanded(core_.turn.now);
    return next->exchange;
  }
  const Instant read_again = bring_up.reads_back() ? kLongAgo : core_.reads.tries().again(next->object);
  if (const Instant again = next->write ? bring_up.write_again() : read_again; core_.turn.now < again) {
    core_.bus.wait(job(), again);
    return std::nullopt;
  }
  return core_.exchange(*next);
}

void SetupTask::begin(bool restarted) {
  if (end_.begun()) {  // nobody would see its end
    core_.turn.link = LinkState::unknown;
    core_.presence.look_at(kNever);
    return;
  }
  core_.turn.link = LinkState::setup;
  core_.presence.found();
  finish();  // what was left of its setup is done anew
  unmap();
  core_.reads.restart(core_.turn.now);
  control_.reset();
  core_.bring_up.begin();
  if (restarted)
    for (auto& axis : core_.axes) axis->on_bring_up();
  if (queue(bus::Priority::setup)) return;
  // A full queue empties by its deadlines: try again after a probe's pause.
  core_.turn.link = LinkState::unknown;
  core_.presence.look_at(core_.turn.now + bus::Backoff::kFirst);
}

void SetupTask::on_result(const Ended& ended) {
  if (!owns(ended.asked.job) || (core_.turn.link != LinkState::setup && !core_.bring_up.amending())) return;
  core_.bring_up.on_result(ended.exchange, ended.result, core_.store, core_.turn.now);
  const model::ObjectId asked = core_.model.find(ended.exchange.object);
  if (ended.result.code != Errc::ok || asked == model::kNoObject || !core_.store[asked].refused) return;
  if (ended.written != model::kNoObject) return core_.store.forget(asked);  // whether it can be read is open again
  if (!core_.model.needs_for_state(asked)) return;
  // A drive whose statusword has another width is none we can speak for: it stays in setup and is asked again, slowly.
  tell_mismatch(core_, lacking(core_, asked));
  core_.bus.wait(job(), core_.turn.now + std::chrono::seconds(1));
}

// Without its state there is no axis: a drive that was brought up waits for it again. What moves by it is stopped.
void SetupTask::on_given_up() {
  const auto given_up = core_.reads.take_given_up();
  if (given_up.empty()) return;
  for (const auto& [object, first_report] : given_up) {
    if (first_report) tell_given_up(core_, object);
    if (core_.brought_up())
      for (const model::ObjectId id : core_.model.with_parts(object))
        for (auto& axis : core_.axes) axis->on_blind(id);
  }
  const auto tells_state = [this](const ObjectTries::GivenUp& g) { return core_.model.needs_for_state(g.object); };
  if (core_.brought_up() && std::ranges::any_of(given_up, tells_state)) {
    begin(false);
    for (const ObjectTries::GivenUp& g : given_up)
      if (tells_state(g)) core_.reads.keep_given_up(g.object, core_.turn.now);
  }
  judge_given_up(core_);
}

void SetupTask::end() {
  const BringUp& bring_up = core_.bring_up;
  const std::string& mismatch = bring_up.mismatch();
  if (!mismatch.empty()) core_.tell_all(EventKind::warning, 0, "not the configured drive: " + mismatch + ": read-only");
  for (const std::string& note : bring_up.node().notes()) core_.tell_all(EventKind::warning, 0, note);
  core_.set_alarm(AxisAlarm::identity_mismatch, !mismatch.empty());
  judge_profile(core_);
  const DriveReads::Settled settled = core_.reads.settle();
  for (const std::string& unknown : settled.unknown) core_.tell_all(EventKind::warning, 0, unknown);
  if (settled.scales)
    for (auto& axis : core_.axes) axis->on_scale();
  tell_refused(core_, refused_);
  if (!bring_up.adopted() && bring_up.is_configured()) map();
  for (const model::ObjectId id : bring_up.unheld())
    core_.event(core_.model.axes.front().number, EventKind::warning, 0,
                "setup: the drive does not hold what was written to " + core_.model.object(id).name);
  core_.set_alarm(AxisAlarm::adopted_running, bring_up.adopted());
  judge_loss_reaction(core_);
  core_.turn.link = LinkState::online;
  if (bring_up.adopted())
    for (auto& axis : core_.axes) axis->on_adopted();
  core_.tell_all(EventKind::boot, 0, bring_up.adopted() ? "online, found enabled: adopted" : "online");
}

Instant SetupTask::deadline() {
  const Instant amends = may_amend() ? core_.bring_up.amend_due() : kNever;
  return std::min(core_.bring_up.start().deadline(core_.turn.now), amends);
}

void SetupTask::go_on() {
  if (!core_.brought_up()) return;
  judge_checks(core_);
  leave_adoption();
  // What the drive refused of its setup for now: a heartbeat it must send, or what makes it notice a dead gateway.
  // Tried again beside what clients do, as long as no motor of it is enabled; the axis stays online.
  BringUp& bring_up = core_.bring_up;
  if (bring_up.amending() && job() == 0) bring_up.end_amending(core_.turn.now);  // it was given up with the queue
  if (!may_amend() || core_.turn.now < bring_up.amend_due()) return;
  bring_up.begin_amending(core_.store, core_.turn.now);
  queue(bus::Priority::setup);
}

bool SetupTask::may_amend() const {
  return core_.turn.link == LinkState::online && job() == 0 && !end_.begun() && !enable_is_asked();
}

bool SetupTask::enable_is_asked() const {
  return std::ranges::any_of(core_.axes, [](const auto& axis) { return axis->pending().enables(); });
}

// Full bring-up at the first disabled state after an adoption, or after the node left operational. An enable that is
// under way, or waits for its turn, would meet its NMT commands.
void SetupTask::leave_adoption() {
  BringUp& bring_up = core_.bring_up;
  const bool due = bring_up.adopted() || bring_up.completed() || bring_up.start().is_due(core_.turn.now);
  if (!due || end_.begun() || enable_is_asked()) return;
  // A drive that stands in quick stop active holds its motor: bring-up would find it enabled, and adopt it again.
  const bool enabled = std::ranges::any_of(core_.axes, [&](const auto& axis) {
    const AxisFacts facts = axis->core().facts();
    return facts.enabled() || (bring_up.has_setup() && model::holds_motor(facts.state));
  });
  if (enabled) return;
  bring_up.leave();
  core_.set_alarm(AxisAlarm::adopted_running, false);
  if (bring_up.has_setup()) begin(false);
}

// Our start was lost, somebody else has stopped it, or it fell back by itself. Its process data is dead; what runs is
// polled, and it is set up anew as soon as its motor is disabled: a node with an enabled motor gets no NMT command.
void SetupTask::on_left(bus::NodeState state) {
  const Duration pause = core_.bring_up.start().leave(core_.turn.now);
  core_.tell_all(EventKind::warning, 0,
                 fmt::format("the node is {} by no command of ours, or has missed its start: it is polled, and set up "
                             "and started again in {} ms, or when its motor is disabled",
                             bus::text(state), std::chrono::duration_cast<std::chrono::milliseconds>(pause).count()));
  // It may have started anew while nobody heard it.
  core_.store.lose_contact();
  core_.reads.outdate_mapped();
  unmap();
}

void SetupTask::map() {
  for (const MappedTpdo& tpdo : core_.bring_up.node().mapped()) {
    bus::ProcessMap objects;
    const auto event =
        tpdo.event_ms ? std::optional<Duration>(std::chrono::milliseconds(*tpdo.event_ms)) : std::nullopt;
    for (const model::ObjectId id : tpdo.objects) {
      objects.push_back({core_.model.object(id).address, core_.model.object(id).size});
      core_.reads.map(id, event);
    }
    core_.bus.map_process_data(core_.model.node, tpdo.number, objects);
  }
}

void SetupTask::unmap() {
  if (!model::is_canopen(core_.model)) return;
  for (const model::TpdoProperties& tpdo : core_.model.canopen.tpdos)
    core_.bus.map_process_data(core_.model.node, tpdo.number, {});
  core_.reads.unmap(core_.turn.now);
}

}  // namespace axisgate::drive
