// SPDX-License-Identifier: Apache-2.0
// What a client asks of an axis becomes what is carried out, or is answered at once: who asks, buttons, a lease that is
// given back or taken over (design 3.4 Jog, 3.5).
#include <algorithm>
#include <utility>

#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/plan/admission.hpp"

namespace axisgate::drive {
namespace {

bool is_dds(const WriteBatch& batch) { return batch.life && batch.life->strength; }

}  // namespace

std::optional<BatchResult> Axis::submit(const WriteBatch& asked, BatchCallback on_result) {
  settle();
  WriteBatch batch = asked;
  if (batch.zero_speed) admission_.add_zero_speed(batch, pending());
  // Bits 0..3 = 6 or 7 are a stop of the owner's in a block of registers as well.
  if (batch.controlword && guard_.ownership().is_owner(batch.client)) batch.single_controlword = true;
  // A coil that is held although its jog has ended asks for nothing until it was 0.
  const bool hold_is_not_new = batch.jog_again && !guard_.jog().again(*batch.jog_again, batch.client, core_.turn.now);
  if (hold_is_not_new) batch.jog_again.reset();
  // While something may run, the end of a run is a stop, and so open to every operator.
  if (batch.command == Command::end_run && admission_.may_run(pending())) batch.command = Command::halt;
  Errc refusal = admission_.judge(batch);
  // An object that is read is no write: a monitor on the PLC's computer keeps no dead PLC's motor running.
  if (!reads_alone(batch))
    guard_.ownership().wrote(batch.renews ? batch.life : nullptr, batch.beats, !asks_nothing(batch) || batch.jog_again,
                             core_.turn.now);
  const auto stop_comes_first = [&](const Axis* axis) { return axis->admission_.stop_comes_first(batch); };
  const bool owed = stop_comes_first(this) || std::ranges::any_of(shared_, stop_comes_first);
  if (refusal == Errc::ok && !asks_nothing(batch) && owed) refusal = Errc::stop_owed;
  if (refusal == Errc::ok && queue_.closing() && !asks_nothing(batch) && !stops_at_most(batch))
    refusal = Errc::never_started;
  if (refusal != Errc::ok) {
    if (!holds_stop(batch)) return refuse(asked, refusal);
    batch = stop_alone(batch);
    batch.claims = false;
  }
  // It claims nothing, for nobody has judged whether it may. It may take over an axis that waits for its client all the
  // same.
  const auto nothing_asked = [&] {
    if (admission_.waits_for(batch)) admission_.make_owner(batch);
    return nothing_left(batch, false);
  };
  const Jog before = guard_.jog();
  switch (batch.command) {
    case Command::release:
      return release(batch, std::move(on_result));
    case Command::take_over:
      return take_over(batch, std::move(on_result));
    case Command::jog_forward:
    case Command::jog_reverse:
      if (const Errc code = jog_.begin(batch, shown_.cycle()); code != Errc::ok) return refuse(asked, code);
      break;
    case Command::jog_end: {
      // A coil that is let go is that of its client; a DDS program asks for the end by name, and is not told done for
      // nothing.
      const Jog& jog = guard_.jog();
      const bool may_end = jog.client() == batch.client || is_dds(batch);
      if (!jog_.may_be_jog() && !(jog.active() && may_end)) return nothing_asked();
      batch.command = Command::halt;
      break;
    }
    case Command::end_run:
      return nothing_asked();
    default:
      break;
  }
  if (asks_nothing(batch)) {
    const BatchResult result = nothing_asked();
    return hold_is_not_new ? BatchResult{{Errc::not_new, 0}} : result;
  }
  // A stop is accepted in every state, also where it cannot be sent.
  const bool stop = holds_stop(batch);
  const WriteBatch& told = refusal == Errc::ok ? asked : batch;
  if (stop) events_.asked(told, batch);
  auto result = carry_out(batch, refusal, std::move(on_result));
  if (!stop && (!result || result->outcome.code == Errc::ok)) events_.asked(told, batch);
  if (result && is_jog(asked.command)) guard_.jog() = before;  // what ran before needs its button as before
  settle();
  return result;
}

// Command 13. What else stands in the request comes before it. It takes no lease for that, nor the time of one that is
// open to all: whoever gives it back must not be left with it where something fails.
std::optional<BatchResult> Axis::release(const WriteBatch& batch, BatchCallback on_result) {
  // What its own ended connection has left is its own.
  const Ownership& ownership = guard_.ownership();
  if (ownership.owner() && ownership.waits_for(batch.life, batch.all_zero)) admission_.claim(batch);
  settle();
  WriteBatch rest = batch;
  rest.command = Command::none;
  if (!ownership.is_owner(batch.client)) rest.claims = rest.reclaims = false;
  if (asks_nothing(rest)) return released(batch);
  auto done = submit(rest, [this, batch, on_result](const BatchResult& result) {
    on_result(result.outcome.code == Errc::ok ? released(batch) : result);
  });
  return done && done->outcome.code == Errc::ok ? std::optional(released(batch)) : done;
}

BatchResult Axis::released(const WriteBatch& batch) {
  if (const Errc code = admission_.release(batch, pending().enables()); code != Errc::ok) return refuse(batch, code);
  return nothing_left(batch);
}

// Command 14: from a lower rank, after a halt, which ends what waits or has begun as well. What else stands in the
// request comes after it, as the new owner's.
std::optional<BatchResult> Axis::take_over(const WriteBatch& batch, BatchCallback on_result) {
  if (!admission_.must_halt_for(batch, pending())) return taken_over(batch, std::move(on_result));
  WriteBatch halt;
  halt.client = batch.client;
  halt.role = batch.role;
  halt.life = batch.life;
  halt.command = Command::halt;
  halt.command_id = batch.command_id;
  halt.start_by = batch.start_by;
  halt.answer_by = batch.answer_by;
  admission_.is_taken_by(batch.client);
  auto halted = carry_out(halt, Errc::ok, [this, batch, on_result](const BatchResult& result) {
    admission_.is_taken_by({});
    if (result.outcome.code != Errc::ok) {
      on_result(result);
    } else if (const auto done = taken_over(batch, on_result)) {
      on_result(*done);
    }
  });
  if (halted) admission_.is_taken_by({});
  if (halted && halted->outcome.code == Errc::ok) return taken_over(batch, std::move(on_result));
  return halted;
}

std::optional<BatchResult> Axis::taken_over(const WriteBatch& batch, BatchCallback on_result) {
  admission_.make_owner(batch);
  settle();
  WriteBatch rest = batch;
  rest.command = Command::none;
  if (!asks_nothing(rest)) return submit(rest, std::move(on_result));
  return nothing_left(batch);
}

BatchResult Axis::nothing_left(const WriteBatch& batch, bool shown) {
  settle();
  if (shown) shown_.result(batch, command_result(Errc::ok));
  publish();
  return {};
}

}  // namespace axisgate::drive
