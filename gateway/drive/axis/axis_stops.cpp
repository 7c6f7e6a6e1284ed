// SPDX-License-Identifier: Apache-2.0
// Stops of an axis: how one is accepted, how the gateway sends its own, and what becomes of them (design 3.4).
#include <fmt/format.h>

#include <algorithm>
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

// --- The gateway's own -----------------------------------------------------------------------------------------------

Guard::Seen Axis::seen() const {
  const PendingBatches& pending = queue_.pending();
  const bool known = core_.store[core_.model.statusword].known && core_.store[core_.model.controlword].known;
  Guard::Seen seen;
  seen.now = core_.turn.now;
  seen.exchange = core_.store.exchange();
  seen.state = image_.axis_state;
  seen.torque = admission_.may_be_enabled();
  seen.runs = core_.motion.running() != MotionKind::none || core_.moving() || pending.starts_motion();
  seen.runs_raw = core_.motion.runs_raw();
  seen.stopping = core_.motion.stopping();
  // One owner answers for all that is shared.
  seen.writes =
      pending.writes() || std::ranges::any_of(shared_, [](const Axis* other) { return other->pending().writes(); });
  seen.enables = pending.enables();
  seen.stop_waits = pending.stopping();
  seen.owed_waits = pending.carries_out_stop() || pending.ends_owed_stop(guard_.owed().halts());
  seen.halt_is_certain = core_.is_virtual() || (core_.turn.link == LinkState::online && known);
  seen.stops_without_us = !core_.is_virtual() || core_.drive.stops_by_itself;
  seen.jog_limit = jog_.limit_due();
  return seen;
}

void Axis::settle() {
  if (core_.turn.now >= guard_.ownership().until()) ++image_.counts->lease_expiries;  // the guard takes it up at once
  while (auto stop = guard_.due(seen())) {
    if (!stop->why.empty()) events_.event(stop->kind, stop->code, std::move(stop->why));
    if (stop->command == Command::none) continue;
    const auto ended = [this, of_lease = stop->kind == EventKind::lease](const BatchResult& result) {
      // It is owed on: what the drive shows decides when it is sent again.
      if (of_lease && result.outcome.code != Errc::ok && core_.state().enabled())
        events_.event(EventKind::lease, 0, "the stop that the lease asked for has failed: it is tried again");
    };
    if (const auto result = send(*stop, ended)) ended(*result);
  }
}

// What is owed again has its latch, and its client its answer: it is planned anew from what is known by now.
std::optional<BatchResult> Axis::send(const OwnStop& stop, BatchCallback on_result) {
  WriteBatch batch;
  batch.client = stop.client;
  batch.role = Role::engineer;
  batch.command = stop.command;
  batch.latches = stop.latches;
  batch.answer_by = stop.answer_by;
  OwedStop& owed = guard_.owed();
  if (stop.again) owed.sending();
  const auto result = carry_out(batch, Errc::ok, std::move(on_result), &stop);
  if (stop.again && result)
    guard_.discharged(owed.attempted(*kind_of(batch), false, core_.store.exchange(), core_.turn.now));
  return result;
}

// In its client's name: it has ended nothing of its own. Not confirmed, the stop is owed.
void Axis::withdraw(Pending& pending, Command stop, const BatchResult& answer) {
  constexpr Duration kMostWaits = std::chrono::seconds(1);  // of a request without a time of its own
  const WriteBatch& asked = pending.batch();
  events_.event(EventKind::command, static_cast<std::uint32_t>(stop),
                std::string(text(asked.command)) + " is withdrawn: " + std::string(text(stop)));
  const OwnStop own{.command = stop,
                    .shown = false,
                    .client = asked.client,
                    .answer_by = std::min(asked.answer_by, core_.turn.now + kMostWaits)};
  const std::vector<Waiting> waiting = std::exchange(pending.callbacks, {});
  const auto tell = [answer, waiting](const BatchResult&) {
    for (const Waiting& client : waiting) client.tell(answer);
  };
  if (send(own, tell)) queue_.answer(answer, waiting);
  // Where nobody answers a frame, the read that shows it disabled does not tell that the withdrawal has arrived.
  if (stop == Command::disable) guard_.late_enable().withdrawn(core_.turn.now);
}

// --- What is owed ----------------------------------------------------------------------------------------------------

void Axis::accept_stop(const WriteBatch& batch, bool with_another) {
  // The latch is one, and whose stop has set it, leaves it.
  core_.motion.stop(stop_latches(core_, batch) && !with_another, core_.turn.now);
  core_.motion.record().stopped(batch.client);
  queue_.overtake(batch);
  guard_.jog().end();
  const auto kind = kind_of(batch);
  if (!kind) return;
  watch_.stopped(batch, *kind);
  guard_.owed().accepted(*kind, core_.store.exchange());
  if (with_another) return;
  // One register stops them all; what each motor alone has, its set-points and what it shows, each stops by itself.
  const std::string why =
      fmt::format("{}, as axis {}: they are stopped as one", text(command_of(*kind)), image_.number);
  for (Axis* other : shared_) {
    const bool said = !other->core_.state().enabled();
    other->guard_.stop_with_another(command_of(*kind), batch.client, said ? std::string() : why);
    other->settle();
  }
}

void Axis::on_restarted() {
  watch_.renumbered();
  core_.motion.disarm();
  core_.begin_mode();
  // No end of a jog: what has said that it starts may turn on all the same (NMT reset communication), and its button
  // counts until it is seen not to.
  guard_.owed().restarted();
}

void Axis::on_unreachable() {
  core_.motion.disarm();
  guard_.lost(shown_.heard(), core_.store.exchange());
}

void Axis::on_held_back(const std::string& what, bool stop) {
  core_.motion.record().hold_back();
  events_.event(EventKind::warning, 0, what);
  if (stop) guard_.owed().accepted(StopKind::quick_stop, core_.store.exchange());
}

// --- What becomes of it ----------------------------------------------------------------------------------------------

void Axis::on_stop_late(const Pending& pending, const Outcome& outcome) {
  if (outcome.code == Errc::not_reached) events_.not_reached(pending);
  events_.ended(pending, outcome);
}

void Axis::on_stop_over(const Pending& pending, bool ended) {
  const CommandSequence& sequence = *pending.command_sequence;
  const auto kind = kind_of(sequence.batch());
  if (!sequence.began_as_stop() || !kind) return;
  OwedStop& owed = guard_.owed();
  if (sequence.begun()) owed.sending();
  const bool confirmed = sequence.stop_confirmed();
  const bool goes_back = *kind == StopKind::halt && halts_by_position(core_);
  if (confirmed && !goes_back && pending.accepted == core_.motion.record().newest_stop())
    watch_.shown({*kind, pending.accepted, pending.batch().life != nullptr});
  if (ended || confirmed) guard_.discharged(owed.attempted(*kind, confirmed, core_.store.exchange(), core_.turn.now));
}

void Axis::observe_stop() {
  const auto stop = watch_.take_unheeded();
  if (!stop) return;
  if (stop->of_client) image_.unheeded_stop = stop->at;
  if (image_.latest.stop == stop->at) image_.latest.result = CommandResult::not_reached;
  events_.event(EventKind::command, static_cast<std::uint32_t>(command_of(stop->kind)),
                fmt::format("the motor turns on after its {}, at velocity_actual {}: the stop is owed",
                            text(command_of(stop->kind)), core_.value(Quantity::velocity_actual).value_or(0)));
  guard_.owed().unheeded(stop->kind, core_.store.exchange());
}

// Whoever commanded before must know that it is over: but what was refused, or asked for what is so, has ended nothing.
// A later enable or start ends what is owed as soon as anything of it is carried out, or is so already. One that is
// dropped before, since the link was lost perhaps, has changed nothing: the stop is owed still.
void Axis::on_begun(const Pending& pending, bool done) {
  const CommandSequence& sequence = *pending.command_sequence;
  const WriteBatch& batch = sequence.batch();
  const bool acts = batch.controlword || (batch.command != Command::none && !is_stop(batch.command));
  if (acts && sequence.commanded()) core_.motion.record().commanded(batch.client, pending.accepted);
  if (sequence.is_stop() || pending.stopped_by || (!done && !sequence.commanded())) return;
  if (asks_to_enable(batch)) guard_.late_enable().wanted();
  const auto discharge = [&](Guard& guard) {
    if (asks_to_enable(batch)) guard.discharged(guard.owed().enabled_later());
    if (starts_motion(batch.command)) guard.discharged(guard.owed().started_later());
  };
  discharge(guard_);
  for (Axis* other : shared_) discharge(other->guard_);
}

}  // namespace axisgate::drive
