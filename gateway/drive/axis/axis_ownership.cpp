// SPDX-License-Identifier: Apache-2.0
// What an axis asks before it carries anything out: who owns it, whether its owner is still there, and whether a button
// is still held (design 3.4 Jog, 3.5).
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/plan/admission.hpp"

namespace axisgate::drive {
namespace {

/// It has no connection that could end.
bool is_dds(const ClientLife& client) { return client.strength.has_value(); }

std::string named_before(const Ownership::ClientPtr& owner) {
  return owner ? " (before: " + owner->name + ")" : std::string();
}

/// Why this lease has run out, and what helps by the rules that it has: what stands in the configuration already is no
/// advice.
std::string silence(const ClientLife& owner, const LeaseRules& rules, Duration timeout) {
  if (!owner.connected && !is_dds(owner))
    return owner.is_address
               ? " (a host that writes so seldom needs a longer \"timeout_ms\" of the lease, or \"lease\": null)"
               : " (one-shot tools need \"lease\": null or \"client\": \"address\")";
  std::string_view missed = owner.is_address ? "has written nothing" : "has asked nothing";
  if (rules.renew == LeaseRenewal::write) missed = "has written nothing to the axis";
  if (rules.renew == LeaseRenewal::heartbeat) missed = "has shown no heartbeat";
  return fmt::format(" (it {} for {} ms)", missed, timeout / std::chrono::milliseconds(1));
}

std::string in_words(Command stop) { return stop == Command::quick_stop ? "quick stop" : std::string(text(stop)); }

}  // namespace

// --- Who asks ------------------------------------------------------------------------------------------------------

// Reads are free, and stops are open to every operator, without taking the lease. A button that is let go where nothing
// runs asks for nothing.
Errc Axis::judge_owner(const WriteBatch& batch) const {
  if (reads_alone(batch)) return Errc::ok;
  if (holds_stop(batch) && !batch.claims) return Errc::ok;
  if (batch.command == Command::jog_end || batch.command == Command::end_run) return Errc::ok;
  // While its halt is under way an axis is on its way to its new owner: what the old one asked now would begin behind
  // the halt, under another's lease.
  const bool being_taken = taken_by_ && batch.life && batch.client != *taken_by_;
  if (batch.command == Command::take_over) return being_taken ? Errc::not_owner : ownership_.may_take_over(batch.life);
  if (asks_nothing(batch) && !batch.jog_again) return Errc::ok;
  if (being_taken) return Errc::not_owner;
  return ownership_.judge(batch.life, batch.claims);
}

// What was accepted from a client makes it the owner; so does any write where the axis waits for this client.
void Axis::claim(const WriteBatch& batch) {
  if (batch.jog_velocity) image_.jog_velocity = *batch.jog_velocity;
  if (batch.claims || waits_for(batch)) make_owner(batch);
}

bool Axis::waits_for(const WriteBatch& batch) const {
  return batch.reclaims && ownership_.waits_for(batch.life, batch.all_zero);
}

void Axis::make_owner(const WriteBatch& batch) {
  const auto before = ownership_.owner();
  const Ownership::Taken taken = ownership_.take(batch.life, core_.turn.now);
  if (taken == Ownership::Taken::nothing) return;
  if (taken != Ownership::Taken::orphan && taken != Ownership::Taken::same_origin_and_role)
    core_.motion.owner_changed();
  if (jog_.client() != batch.client) halt_jog("another client has taken the axis");
  tell_owner(drive::text(taken, *batch.life) + named_before(before));
}

// What it waited for may have made it acceptable, and the axis may be another's by now. False: it is.
bool Axis::claims_late(Pending& pending) {
  const WriteBatch& batch = pending.command_sequence->batch();
  const bool claims = pending.claims_when_begun && !accepts_nothing(core_, batch);
  const bool begins =
      !pending.command_sequence->begun() && !pending.command_sequence->is_stop() && asks_to_begin(batch);
  if (!claims && !(begins && is_anothers(batch))) return true;
  pending.claims_when_begun = false;
  if (const Errc code = judge_owner(batch); code != Errc::ok) {
    pending.command_sequence->abort(refusal(code));
    complete(pending.id, pending.command_sequence->result());
    return false;
  }
  if (claims) claim(batch);
  return true;
}

// What a connection that has ended has asked for is its successor's, too.
bool Axis::is_anothers(const WriteBatch& batch) const {
  const auto& owner = ownership_.owner();
  return owner && batch.life && owner->id != batch.client &&
         (is_dds(*batch.life) || !same_origin_and_role(*owner, *batch.life));
}

std::optional<BatchResult> Axis::submit(const WriteBatch& asked, BatchCallback on_result) {
  end_expired_lease();
  WriteBatch batch = asked;
  if (batch.zero_speed) add_zero_speed(batch);
  // Bits 0..3 = 6 or 7 are a stop of the owner's in a block of registers as well.
  if (batch.controlword && ownership_.is_owner(batch.client)) batch.single_controlword = true;
  // A coil that is held although its jog has ended asks for nothing until it was 0.
  const bool hold_is_not_new = batch.jog_again && !jog_.again(*batch.jog_again, batch.client, core_.turn.now);
  if (hold_is_not_new) batch.jog_again.reset();
  // While something may run, the end of a run is a stop, and so open to every operator.
  if (batch.command == Command::end_run && may_run()) batch.command = Command::halt;
  Errc refusal = judge_owner(batch);
  // An object that is read is no write: a monitor on the PLC's computer keeps no dead PLC's motor running.
  if (!reads_alone(batch))
    ownership_.wrote(batch.renews ? batch.life : nullptr, batch.beats, !asks_nothing(batch) || batch.jog_again,
                     core_.turn.now);
  if (refusal == Errc::ok && !asks_nothing(batch) && stop_comes_first(batch)) refusal = Errc::stop_owed;
  if (refusal == Errc::ok && closing_ && !asks_nothing(batch) && !stops_at_most(batch)) refusal = Errc::never_started;
  if (refusal != Errc::ok) {
    if (!holds_stop(batch)) return refuse(asked, refusal);
    batch = stop_alone(batch);
    batch.claims = false;
  }
  const Jog before = jog_;
  switch (batch.command) {
    case Command::release:
      return release(batch, std::move(on_result));
    case Command::take_over:
      return take_over(batch, std::move(on_result));
    case Command::jog_forward:
    case Command::jog_reverse:
      if (const Errc code = begin_jog(batch); code != Errc::ok) return refuse(asked, code);
      break;
    case Command::jog_end: {
      // A coil that is let go is that of its client; a DDS program asks for the end by name, and is not told done for
      // nothing.
      const bool may_end = jog_.client() == batch.client || (batch.life && is_dds(*batch.life));
      if (!may_be_jog() && !(jog_.active() && may_end)) return nothing_asked(batch);
      batch.command = Command::halt;
      break;
    }
    case Command::end_run:
      return nothing_asked(batch);
    default:
      break;
  }
  if (asks_nothing(batch)) {
    const BatchResult result = nothing_asked(batch);
    return hold_is_not_new ? BatchResult{{Errc::not_new, 0}} : result;
  }
  // A stop is accepted in every state, also where it cannot be sent.
  const bool stop = holds_stop(batch);
  const WriteBatch& told = refusal == Errc::ok ? asked : batch;
  if (stop) tell_asked(told, batch);
  auto result = carry_out(batch, refusal, std::move(on_result));
  if (!stop && (!result || result->outcome.code == Errc::ok)) tell_asked(told, batch);
  if (result && is_jog(asked.command)) jog_ = before;  // what ran before needs its button as before
  if (!jog_.active()) end_jog();
  return result;
}

// It claims nothing, for nobody has judged whether it may. It may take over an axis that waits for its client all the
// same.
BatchResult Axis::nothing_asked(const WriteBatch& batch) {
  if (waits_for(batch)) make_owner(batch);
  publish();
  return {};
}

// A gateway that died has told nobody that a button was held, and what runs since before may be its jog. So may what
// another master has let go on since a jog has ended without a halt. Whoever lets a button go means it. The iD286pro
// does not tell in which mode it runs, nor does a Keya on CANopen.
bool Axis::may_be_jog() const {
  const AxisFacts facts = core_.facts();
  if (jog_ended_without_halt_ && runs_unwatched()) return true;
  if (!core_.motion.found_at_start() || !facts.enabled()) return false;
  const bool tells_mode = !core_.is_virtual() || (!core_.model.virtual_axis->gate_only && facts.mode != 0);
  return tells_mode ? core_.motion.goes_on(Quantity::target_velocity, facts) : facts.moving;
}

// --- What was accepted last ------------------------------------------------------------------------------------------

void Axis::accept(const WriteBatch& batch) {
  watch_.accepted(batch);
  if (!batch.jogs)
    for (const Setpoint& sp : batch.setpoints) accepted_.note(sp.quantity, sp.value, core_.motion.record().now());
  if (batch.mode) accepted_.note(Quantity::mode, *batch.mode, core_.motion.record().now());
}

// Whoever commanded before must know that it is over: but what was refused, or asked for what is so, has ended nothing.
void Axis::note_commanded(const Pending& pending) {
  const WriteBatch& batch = pending.batch();
  const bool acts = batch.controlword || (batch.command != Command::none && !is_stop(batch.command));
  if (acts && pending.command_sequence->commanded()) core_.motion.record().commanded(batch.client, pending.accepted);
}

// It was dropped before anything of it was begun: a scanner that goes on writing it asks for it anew.
void Axis::forget_accepted(const WriteBatch& batch) {
  for (const Setpoint& sp : batch.setpoints) accepted_.forget(sp.quantity);
  if (batch.mode) accepted_.forget(Quantity::mode);
}

bool Axis::owner_asks(ClientId client, Quantity quantity, std::int64_t value) const {
  if (!ownership_.rules().on || !ownership_.is_owner(client) || !image_.reachable()) return false;
  const auto last = accepted_.value(quantity, core_.motion.record());
  if (last) return *last != value;
  // Nobody has asked for anything since the drive came up: what it holds is what counts; but a velocity or torque that
  // has lapsed is needed anew.
  const bool lapses = quantity == Quantity::target_velocity || quantity == Quantity::target_torque;
  return lapses || !holds(quantity, value);
}

// Command 13. What else stands in the request comes before it. It takes no lease for that, nor the time of one that is
// open to all: whoever gives it back must not be left with it where something fails.
std::optional<BatchResult> Axis::release(const WriteBatch& batch, BatchCallback on_result) {
  // What its own ended connection has left is its own.
  if (ownership_.owner() && ownership_.waits_for(batch.life, batch.all_zero)) claim(batch);
  WriteBatch rest = batch;
  rest.command = Command::none;
  if (!ownership_.is_owner(batch.client)) rest.claims = rest.reclaims = false;
  if (asks_nothing(rest)) return released(batch);
  auto done = submit(rest, [this, batch, on_result](const BatchResult& result) {
    on_result(result.outcome.code == Errc::ok ? released(batch) : result);
  });
  return done && done->outcome.code == Errc::ok ? std::optional(released(batch)) : done;
}

BatchResult Axis::released(const WriteBatch& batch) {
  const auto owner = ownership_.owner();
  const Errc code = ownership_.release(batch.life, may_be_enabled() || pending_.enables(), core_.turn.now);
  if (code != Errc::ok) return refuse(batch, code);
  halt_jog("its owner has released the axis");
  if (owner) {
    const bool enabled = ownership_.until() != kNever;
    tell_owner(owner->name + (enabled ? " has released the axis, which is enabled: open to every operator for now"
                                      : " has released the axis"));
  }
  show_latest(batch, {});
  publish();
  return {};
}

// Command 14: from a lower rank, after a halt, which ends what waits or has begun as well. What else stands in the
// request comes after it, as the new owner's.
std::optional<BatchResult> Axis::take_over(const WriteBatch& batch, BatchCallback on_result) {
  const auto owner = ownership_.owner();
  const bool from_another = owner && batch.life && owner->id != batch.life->id;
  if (!from_another || !(may_be_enabled() || pending_.writes())) return taken_over(batch, std::move(on_result));
  WriteBatch halt;
  halt.client = batch.client;
  halt.role = batch.role;
  halt.life = batch.life;
  halt.command = Command::halt;
  halt.command_id = batch.command_id;
  halt.start_by = batch.start_by;
  halt.answer_by = batch.answer_by;
  taken_by_ = batch.client;
  auto halted = carry_out(halt, Errc::ok, [this, batch, on_result](const BatchResult& result) {
    taken_by_.reset();
    if (result.outcome.code != Errc::ok) {
      on_result(result);
    } else if (const auto done = taken_over(batch, on_result)) {
      on_result(*done);
    }
  });
  if (halted) taken_by_.reset();
  if (halted && halted->outcome.code == Errc::ok) return taken_over(batch, std::move(on_result));
  return halted;
}

std::optional<BatchResult> Axis::taken_over(const WriteBatch& batch, BatchCallback on_result) {
  const auto before = ownership_.owner();
  if (const Ownership::Taken taken = ownership_.take(batch.life, core_.turn.now); taken != Ownership::Taken::nothing) {
    halt_jog("another client has taken the axis");
    tell_owner(drive::text(taken, *batch.life) + named_before(before));
  }
  WriteBatch rest = batch;
  rest.command = Command::none;
  if (!asks_nothing(rest)) return submit(rest, std::move(on_result));
  show_latest(batch, {});
  publish();
  return BatchResult{};
}

// --- When nobody is there any more -----------------------------------------------------------------------------------

void Axis::stop_by_itself(Command command, bool latches, BatchCallback on_result) {
  WriteBatch stop;
  stop.role = Role::engineer;
  stop.command = command;
  stop.latches = latches;
  if (const auto result = carry_out(stop, Errc::ok, on_result)) on_result(*result);
}

void Axis::end_expired_lease() {
  const auto expired = ownership_.take_expired(core_.turn.now);
  if (!expired) return;
  const Command action = command_of(ownership_.rules().on_expiry);
  std::string what = "nobody has taken over the enabled axis";
  if (expired->owner) {
    what = "the lease of " + expired->owner->name + " has run out";
    if (!expired->owner->connected)
      what += is_dds(*expired->owner)      ? " after it had gone"
              : expired->owner->is_address ? " after its connections had ended"
                                           : " after its connection had ended";
  }
  const bool acts = may_be_enabled() || pending_.writes();
  if (!acts || action == Command::none) {
    halt_jog("its owner's lease has run out");
    host_.event(image_.number, EventKind::lease, 0, what + (acts ? ": nothing is done (on_expiry none)" : ""));
    return;
  }
  what += fmt::format(": {}, axis in state \"{}\"", in_words(action), text(image_.axis_state));
  if (expired->owner) what += silence(*expired->owner, ownership_.rules(), expired->timeout);
  host_.event(image_.number, EventKind::lease, static_cast<std::uint32_t>(action), std::move(what));
  stop_by_itself(action, true, [this](const BatchResult& result) { on_lease_action(result); });
}

// By its state, its position and its velocity a motion is seen to end, to stand and to keep within its limits: one that
// is seen no more is stopped as one whose client is gone.
void Axis::on_blind(model::ObjectId object) {
  const auto gives = [&](Quantity quantity) {
    const model::Binding* binding = core_.model.binding(quantity);
    return binding != nullptr && binding->object == object;
  };
  const bool shows = core_.model.needs_for_state(object) || gives(Quantity::position_actual) ||
                     (core_.model.moving ? core_.model.moving->object == object : gives(Quantity::velocity_actual));
  const bool moves = core_.motion.running() != MotionKind::none || core_.motion.runs_raw() || jog_.active() ||
                     pending_.starts_motion() || core_.facts().moving;
  if (!shows || !moves || core_.motion.stopping()) return;
  Command stop = command_of(ownership_.rules().on_expiry);
  if (stop == Command::none) stop = Command::quick_stop;
  host_.event(
      image_.number, EventKind::command, static_cast<std::uint32_t>(stop),
      fmt::format("{} is told no more, and the motion needs it: {}", core_.object(object).name, in_words(stop)));
  stop_by_itself(stop, true, [](const BatchResult&) {});
}

// It is owed on: what the drive shows decides when it is sent again.
void Axis::on_lease_action(const BatchResult& result) {
  if (result.outcome.code == Errc::ok || !core_.facts().enabled()) return;
  host_.event(image_.number, EventKind::lease, 0, "the stop that the lease asked for has failed: it is tried again");
}

void Axis::on_adopted() {
  if (!core_.facts().enabled() || ownership_.owner() || !ownership_.rules().on) return;
  ownership_.open(core_.turn.now);
  const Command action = command_of(ownership_.rules().on_expiry);
  host_.event(image_.number, EventKind::lease, 0,
              fmt::format("found enabled, and nobody owns it: {} unless a client writes to it within {} ms",
                          action == Command::none ? "nothing is done" : in_words(action),
                          ownership_.rules().timeout / std::chrono::milliseconds(1)));
}

void Axis::on_client_gone(ClientId client) {
  if (ownership_.rules().on) {
    if (ownership_.is_owner(client))
      tell_owner(ownership_.owner()->name + (is_dds(*ownership_.owner()) ? " is gone" : " has closed its connection") +
                 ": its lease goes on until it runs out");
    return;
  }
  // Leases are off: others go on with what they were told. But where neither the drive nor anybody else would ever stop
  // the motor, it is not left running.
  const bool nothing_else_would = core_.is_virtual() && !core_.drive.stops_by_itself;
  if (!nothing_else_would || motion_by_.client != client) return;
  if (core_.motion.running() == MotionKind::none && !core_.facts().moving && !pending_.starts_motion()) return;
  host_.event(image_.number, EventKind::command, 0,
              "the client that commanded the motion is gone: quick stop" +
                  (motion_by_.life ? " (" + motion_by_.life->name + ")" : std::string()));
  stop_by_itself(Command::quick_stop, false, [](const BatchResult&) {});
}

}  // namespace axisgate::drive
