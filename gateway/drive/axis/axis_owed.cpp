// SPDX-License-Identifier: Apache-2.0
// A stop is owed by the axis until the drive has shown it, through every loss of it (design 3.4 Owed stops); and a
// jog needs its button, also while nobody can see whether it runs.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

std::optional<StopKind> kind_of(const WriteBatch& batch) {
  std::optional<StopKind> kind;
  if (batch.command == Command::halt) kind = StopKind::halt;
  if (batch.command == Command::quick_stop) kind = StopKind::quick_stop;
  if (batch.command == Command::disable) kind = StopKind::disable;
  if (!stops_by_word(batch)) return kind;
  const bool quick = model::request_of(*batch.controlword) == model::Request402::quick_stop;
  return std::max(kind.value_or(StopKind::halt), quick ? StopKind::quick_stop : StopKind::disable);
}

}  // namespace

// --- What is owed
// ------------------------------------------------------------------------------------------------------

void Axis::owe(const WriteBatch& stop) {
  const auto kind = kind_of(stop);
  if (!kind) return;
  watch_.stopped(stop, *kind);
  owed_.accepted(*kind, core_.store.exchange());
  observe_owed();
}

// Whatever was asked while a stop is owed by a loss would act on an axis of which nobody knows what it does.
bool Axis::stop_comes_first(const WriteBatch& batch) const {
  const LinkState link = core_.turn.link;
  const bool back = link != LinkState::offline && link != LinkState::link_down;
  return owed_.gates() && back && !reads_alone(batch) && !stops_at_most(batch);
}

// What is not surely read disabled counts as enabled: the motor of a cut cable may be running.
bool Axis::may_be_enabled() const { return core_.turn.link != LinkState::online || core_.facts().enabled(); }

void Axis::on_restarted() {
  watch_.renumbered();
  core_.motion.disarm();
  core_.begin_mode();
  // No end of a jog: what has said that it starts may turn on all the same (NMT reset communication), and its button
  // counts until it is seen not to.
  owed_.restarted();
}

void Axis::on_unreachable() {
  core_.motion.disarm();
  late_enable_.lost();
  owed_.link_lost(shown_.heard(), core_.store.exchange());
  if (owed_.take_gate_report())
    host_.event(image_.number, EventKind::command, 0, "the drive is out of reach: a stop is owed until it is back");
}

void Axis::observe_owed() {
  const LinkState link = core_.turn.link;
  const ObjectState& status = core_.store[core_.model.statusword];
  const bool gone = link == LinkState::unknown || link == LinkState::offline || link == LinkState::link_down;
  if (gone) {
    on_unreachable();
    return;
  }
  if (!status.known) return;
  owed_.link_back(core_.turn.now);
  const auto state = model::state_of(static_cast<std::uint16_t>(status.number));
  take_back_enable(state);
  if (!owed_.owed() || pending_.carries_out_stop() || pending_.ends_owed_stop(owed_.halts())) return;
  tell_end(owed_.state_read(state, status.exchange, core_.shows_torque() && core_.facts().moving));
  if (const auto stop = owed_.due(core_.turn.now)) send_owed(*stop);
}

// Its acknowledgement was lost, and its client was told that nobody knows. A set-point that was lost beside it, on an
// axis that was enabled all the time, is no enable.
void Axis::watch_enable(const CommandSequence& unknown) {
  if (unknown.batch().command == Command::enable && unknown.commanded()) late_enable_.unknown(core_.turn.now);
}

// Its client was told that it has failed, or that nobody knows: torque that comes after that, and that nobody has asked
// for since, is taken away again.
void Axis::take_back_enable(model::State402 state) {
  if (state != model::State402::operation_enabled || !late_enable_.expected(core_.turn.now)) return;
  if (pending_.enables() || owed_.owed() || pending_.stopping()) return;
  if (late_enable_.of_unknown(core_.turn.now))
    host_.event(image_.number, EventKind::command, static_cast<std::uint32_t>(Command::enable),
                "the enable whose outcome was unknown has happened, and is taken back");
  late_enable_.taken_back();
  owed_.accepted(StopKind::disable, core_.store.exchange());
}

void Axis::tell_end(OwedStop::End end) {
  if (end == OwedStop::End::none || !owed_.take_end_report()) return;
  std::string how = "the drive has shown it";
  if (end == OwedStop::End::disabled) how = "the axis is read disabled";
  if (end == OwedStop::End::enabled) how = "an enable came later";
  host_.event(image_.number, EventKind::command, 0, "the stop is owed no more: " + how);
}

// Its client has its answer; the latch was set when it was accepted. Planned anew from what is known by now.
void Axis::send_owed(StopKind stop) {
  const ObjectState& status = core_.store[core_.model.statusword];
  const ObjectState& word = core_.store[core_.model.controlword];
  const bool certain = core_.is_virtual() || (core_.turn.link == LinkState::online && status.known && word.known);
  if (stop == StopKind::halt && !certain) stop = StopKind::quick_stop;
  WriteBatch batch;
  batch.role = Role::engineer;
  batch.command = command_of(stop);
  owed_.sending();
  Pending pending;
  pending.by_mailbox = true;  // it shows in no client's result
  pending.accepted = core_.motion.record().newest_stop();
  pending.command_sequence = std::make_unique<CommandSequence>(core_, batch, true);
  bus::BusJob job = job_for(core_, batch, true);
  job.axis = slot_;
  const AxisHost::Queued queued = host_.queue(std::move(job));
  if (queued.code != Errc::ok) {
    tell_end(owed_.attempted(stop, false, core_.store.exchange(), core_.turn.now));
    return;
  }
  host_.event(image_.number, EventKind::command, static_cast<std::uint32_t>(batch.command),
              "found enabled, and a stop is owed: " + std::string(text(batch.command)));
  pending.id = queued.id;
  pending_.push_back(std::move(pending));
}

// --- What becomes of it
// ------------------------------------------------------------------------------------------------

void Axis::note_stop(const Pending& pending, bool ended) {
  const CommandSequence& command_sequence = *pending.command_sequence;
  const auto kind = kind_of(command_sequence.batch());
  if (!command_sequence.began_as_stop() || !kind) return;
  if (command_sequence.begun()) owed_.sending();
  const bool confirmed = command_sequence.stop_confirmed();
  const bool goes_back = *kind == StopKind::halt && halts_by_position(core_);
  if (confirmed && !goes_back && pending.accepted == core_.motion.record().newest_stop())
    watch_.stop_watch().begin({*kind, pending.accepted});
  if (ended || confirmed)
    tell_end(owed_.attempted(*kind, command_sequence.stop_confirmed(), core_.store.exchange(), core_.turn.now));
}

// What was told done is so until the motor stands, or something else is asked of it: a drive that shows a stop and
// turns on has not stopped.
void Axis::observe_stop() {
  const auto stop = watch_.stop_watch().watched();
  if (!stop) return;
  const Motion& motion = core_.motion;
  const bool holds = motion.stopping() && core_.motion.record().newest_stop() == stop->at && !motion.runs_raw();
  if (!holds || !core_.shows_torque()) return watch_.stop_watch().end();
  const model::Binding* const velocity = core_.model.binding(Quantity::velocity_actual);
  const auto speed = core_.value(Quantity::velocity_actual);
  if (!speed || !core_.facts().moving || core_.turn.link != LinkState::online || velocity->object == model::kNoObject)
    return;
  const Duration period =
      std::max(core_.drive.poll_period[static_cast<std::size_t>(velocity->poll)], core_.store.period(velocity->object));
  if (!watch_.stop_watch().goes_on(std::abs(*speed), core_.store[velocity->object].sent_at,
                                   core_.model.velocity_lag + period))
    return;
  image_.unheeded_stop = stop->at;
  if (image_.latest.stop == stop->at) image_.latest.result = CommandResult::not_reached;
  host_.event(image_.number, EventKind::command, static_cast<std::uint32_t>(command_of(stop->kind)),
              fmt::format("the motor turns on after its {}, at velocity_actual {}: the stop is owed",
                          text(command_of(stop->kind)), *speed));
  owed_.unheeded(stop->kind, core_.store.exchange());
}

void Axis::on_held_back(const std::string& what, bool stop) {
  core_.motion.record().hold_back();
  host_.event(image_.number, EventKind::warning, 0, what);
  if (stop) owed_.accepted(StopKind::quick_stop, core_.store.exchange());
}

// A later enable or start ends what is owed as soon as anything of it is carried out, or is so already. One that is
// dropped before, since the link was lost perhaps, has changed nothing: the stop is owed still.
void Axis::note_begun(const Pending& pending, bool done) {
  const CommandSequence& command_sequence = *pending.command_sequence;
  if (command_sequence.is_stop() || pending.stopped_by || (!done && !command_sequence.commanded())) return;
  if (asks_to_enable(command_sequence.batch())) {
    late_enable_.wanted();
    tell_end(owed_.enabled_later());
  }
  if (starts_motion(command_sequence.batch().command)) tell_end(owed_.started_later());
}

}  // namespace axisgate::drive
