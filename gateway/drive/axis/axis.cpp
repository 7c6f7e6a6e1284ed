// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/axis.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "gateway/drive/axis/command_text.hpp"
#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/planner.hpp"
#include "gateway/model/loss.hpp"

namespace axisgate::drive {

Axis::Axis(const model::DriveModel& drive, AxisSlot slot, ObjectStore& store, const Turn& turn, AxisImage& image,
           AxisHost& host)
    : host_(host),
      image_(image),
      slot_(slot),
      core_{drive, drive.axes[slot], store, turn, Motion{drive.axes[slot].velocity_lag, image.record}},
      shown_(core_, image_, host_),
      ownership_(image.lease, drive.axes[slot].lease),
      watch_(core_, host_) {
  core_.loss_stop_ms = model::loss_stop_ms(drive, std::nullopt);
}

bool Axis::holds(Quantity quantity, std::int64_t value) const {
  if (quantity == Quantity::mode)
    return core_.model.mode != model::kNoObject && core_.store[core_.model.mode].cached &&
           core_.mode_in_force() == value;
  const model::Binding* binding = core_.model.binding(quantity);
  if (binding == nullptr || binding->object == model::kNoObject || !core_.store[binding->object].cached) return false;
  return core_.value(quantity) == value;
}

void Axis::set_alarm(AxisAlarm alarm, bool on) {
  core_.alarms = on ? core_.alarms | bit(alarm) : core_.alarms & ~bit(alarm);
}

void Axis::set_loss_reaction(std::optional<bool> holds) {
  core_.loss_stop_ms = model::loss_stop_ms(core_.drive, holds);
}

void Axis::on_bring_up() {
  watch_.renumbered();
  core_.homing_method.reset();
  if (core_.model.homing_method) core_.homing_method = *core_.model.homing_method;
  core_.offset_owed.reset();
  core_.mode_chosen = false;
  accepted_.forget_parameters();
  core_.fault.forget_emergency();
  reference_invalidated_ = false;
  core_.homed = false;
  core_.counter_wrapped = false;
  counted_.reset();
  // What was not held before is not held until it is read.
  if (core_.loss_stop_ms != kGoesOn) core_.loss_stop_ms = model::loss_stop_ms(core_.drive, std::nullopt);
  on_unreachable();
  if (!core_.is_virtual()) return;
  core_.machine.reset();
  core_.store.forget(core_.model.statusword);
  core_.store.make(core_.model.controlword, 0);
  // Found running, it runs in the mode that it had: no drive of these tells it.
  if (core_.store[core_.model.mode].known) return;
  // But where a mode can be chosen, nobody can tell a new gateway which one an enabled motor has: a speed would be
  // taken for a position. It has none until it is seen disabled, and what moves it is refused.
  const bool chosen = core_.model.mode_needs_disabled && core_.model.modes.size() > 1;
  if (chosen)
    core_.store.make(core_.model.mode, 0);
  else
    core_.begin_mode();
}

// --- Taking a write batch --------------------------------------------------------------------------------------------

Errc Axis::link_admits(bool stop, bool reads_alone) const {
  const bool unlike_profile = core_.alarm(AxisAlarm::profile_mismatch);
  const bool another = unlike_profile || core_.alarm(AxisAlarm::identity_mismatch);
  switch (core_.turn.link) {
    case LinkState::online:
    case LinkState::suspect:
      // A drive that is not the configured one is read-only.
      return another && !stop && !reads_alone ? Errc::identity_mismatch : Errc::ok;
    case LinkState::setup:
    case LinkState::unknown:
      // Nothing is known of it yet, and it may be running: a stop is worth its try. What a device is that refuses what
      // its profile needs, a person finds out by reading.
      return stop || (unlike_profile && reads_alone) ? Errc::ok : Errc::still_in_setup;
    case LinkState::offline:
    case LinkState::link_down:
      break;
  }
  return Errc::offline;
}

// Two panels pressing the same stop need it on the wire once. What else stands beside one is not the other's result;
// and what was asked between the two, an enable perhaps, the later stop must end: it is a bus job of its own.
bool Axis::join_stop(const WriteBatch& batch, BatchCallback& on_result) {
  if (!stops_alone(batch)) return false;
  for (auto newest = pending_.rbegin(); newest != pending_.rend(); ++newest) {
    Pending& p = *newest;
    const WriteBatch& waiting = p.command_sequence->batch();
    if (!p.command_sequence->is_stop()) return false;
    if (p.command_sequence->begun() || p.callbacks.size() >= kMaxJoined) continue;
    if (p.refusal != Errc::ok || !stops_alone(waiting) || waiting.command != batch.command ||
        waiting.controlword != batch.controlword)
      continue;
    p.callbacks.push_back({std::move(on_result), kNever, batch.answer_by});
    return true;
  }
  return false;
}

void Axis::accept_stop(const WriteBatch& batch) {
  core_.motion.stop(stop_latches(core_, batch), core_.turn.now);
  core_.motion.record().stopped(batch.client);
  for (Pending& p : pending_) {
    if (p.stopped_by) continue;
    p.stopped_by = batch.client;
    if (batch.life) p.stopped_by_name = batch.life->name;
  }
  end_jog();
  owe(batch);
}

void Axis::show_latest(const WriteBatch& batch, const Outcome& outcome) {
  image_.latest = {command_result(outcome.code), outcome.detail, batch.command_id};
}

BatchResult Axis::refuse(const WriteBatch& batch, Errc code) {
  BatchResult result{.outcome = refusal(code), .refused_row = refused_row(core_, batch, code)};
  name_limit(batch, result);
  const Outcome& outcome = result.outcome;
  if (!batch.object && command_result(code) != CommandResult::none) show_latest(batch, outcome);
  tell_refused(batch, result);
  return result;
}

// A single row that is refused by a limit has it as detail, in the row's own units; a block has the row there.
void Axis::name_limit(const WriteBatch& batch, BatchResult& result) const {
  if (result.outcome.code != Errc::bad_value) return;
  const auto passed = passed_limit(core_, batch);
  if (!passed) return;
  result.outcome.detail = static_cast<std::uint32_t>(passed->limit);
  result.limit = limit_text(core_, *passed);
}

std::optional<BatchResult> Axis::carry_out(const WriteBatch& asked, Errc refusal, BatchCallback on_result) {
  auto [batch, code] = as_quantities(core_, asked);
  if (asks_for_missing_halt(core_, batch)) {
    batch.controlword.reset();
    batch.command = Command::halt;
  }
  const bool stop = holds_stop(batch);
  // Beside a stop, a controlword that disables is part of it, in a block too: it is not lost.
  if (stop && batch.controlword && is_stop(*batch.controlword, true)) batch.single_controlword = true;
  if (code == Errc::ok) code = admit(core_, batch);
  const bool untrue = core_.alarm(AxisAlarm::units_disagree) && starts_motion(core_, batch);
  if (code == Errc::ok && untrue) code = Errc::state_unsuitable;
  // A run that follows a jog has no button: it runs at what was asked for last, not at the jog's speed.
  const bool runs = batch.command == Command::run_velocity && !batch.jogs && core_.velocity_beside_jog;
  if (runs && std::ranges::none_of(batch.setpoints,
                                   [](const Setpoint& sp) { return sp.quantity == Quantity::target_velocity; }))
    batch.setpoints.push_back(
        {Quantity::target_velocity, core_.velocity_beside_jog->value, core_.velocity_beside_jog->exact, true});
  Pending pending;
  pending.refusal = refusal;
  pending.jogs = batch.jogs;
  if (code != Errc::ok) {
    // A stop is carried out whatever nonsense stands beside it; the answer tells of the nonsense.
    const Errc of_link = code == Errc::still_in_setup ? link_admits(stop, false) : Errc::ok;
    if (!stop) return refuse(asked, of_link == Errc::ok ? code : of_link);
    pending.refusal = code;
    pending.refused_row = refused_row(core_, batch, code);
    batch = stop_alone(batch);
    if (const Errc of_stop = admit(core_, batch); of_stop != Errc::ok) return refuse(asked, of_stop);
  }
  // Accepted in every state: the latch is set even where nothing can be sent.
  if (stop) accept_stop(batch);
  AxisRecord& record = core_.motion.record();
  pending.accepted = stop ? record.newest_stop() : record.accepted();
  if (const Errc of_link = link_admits(stop, reads_alone(batch)); of_link != Errc::ok) {
    if (stop) publish();
    return refuse(asked, of_link);
  }
  // 3.5: owned from the first accepted write; who only waits for the client's return is taken by any write.
  pending.claims_when_begun = accepts_nothing(core_, batch) && !ownership_.waits_for(batch.life, batch.all_zero);
  if (!pending.claims_when_begun) claim(batch);
  if (stop && pending.refusal == Errc::ok && join_stop(batch, on_result)) {
    publish();
    return std::nullopt;
  }
  if (pending_.empty() && nothing_to_send(core_, batch)) {
    // The wire is not needed: a PLC that writes the same block for ever is answered at once.
    accept(batch);
    remember_setpoints(core_, batch);
    core_.mode_chosen = core_.mode_chosen || batch.mode.has_value();
    show_latest(batch, {});
    publish();
    return BatchResult{};
  }
  // "Done" is up to 2 s away by the contract (command 12), later than a client's usual deadline.
  constexpr Duration kSaving = std::chrono::milliseconds(2500);
  if (batch.command == Command::save_parameters) batch.answer_by = std::max(batch.answer_by, core_.turn.now + kSaving);
  // A long object takes many exchanges, and a client that asks for one is told to wait (43/13).
  constexpr Duration kLongObject = std::chrono::seconds(5);
  if (batch.object && batch.object->size == 0)
    batch.answer_by = std::max(batch.answer_by, core_.turn.now + kLongObject);
  pending.by_mailbox = asked.object.has_value();
  pending.command_sequence = std::make_unique<CommandSequence>(core_, batch, stop, asked.object && !batch.object);
  pending.starts_motion = starts_motion(core_, batch);
  if (pending.starts_motion && !pending.jogs) pending.ends_jog = jog_.pressed();
  pending.start_by = stop ? kNever : batch.start_by;
  pending.callbacks.push_back({std::move(on_result), pending.start_by, decide_by(batch)});
  std::optional<BatchResult> refused;
  enqueue(std::move(pending), stop, refused);
  return refused;
}

void Axis::enqueue(Pending pending, bool stop, std::optional<BatchResult>& refused) {
  const WriteBatch& batch = pending.command_sequence->batch();
  bus::BusJob job = job_for(core_, batch, stop);
  job.axis = slot_;
  const AxisHost::Queued queued = host_.queue(std::move(job));
  if (queued.code != Errc::ok) {
    refused = refuse(batch, queued.code);
    if (stop) publish();
    return;
  }
  if (queued.joined) {
    Pending* shared = pending_.find(queued.id);
    if (shared == nullptr || shared->callbacks.size() >= kMaxJoined) {
      refused = refuse(batch, Errc::queue_full);
    } else {
      shared->start_by = std::max(shared->start_by, pending.start_by);
      shared->callbacks.push_back(std::move(pending.callbacks.front()));
    }
    return;
  }
  pending.id = queued.id;
  accept(batch);
  const bool drives = std::any_of(batch.setpoints.begin(), batch.setpoints.end(), [](const Setpoint& sp) {
    return sp.quantity == Quantity::target_velocity || sp.quantity == Quantity::target_torque;
  });
  if (pending.starts_motion || drives) {
    motion_by_ = {batch.client, batch.life};
  }
  if (!pending.by_mailbox) image_.latest = {CommandResult::pending, 0, batch.command_id};
  if (pending.starts_motion) core_.motion.mask_target_reached();
  pending_.push_back(std::move(pending));
  publish();
}

// --- Carrying it out -----------------------------------------------------------------------------------------------

std::optional<bus::Exchange> Axis::on_grant(bus::JobId id) {
  Pending* pending = pending_.find(id);
  if (pending == nullptr) return std::nullopt;
  if (ends_with_gateway(*pending)) {
    end_begun(*pending);
    return std::nullopt;
  }
  if (!pending->command_sequence->is_stop() && pending_.waits_for_stop(*pending)) {
    host_.job_waits(id, core_.turn.now + kStopsFirst);
    return std::nullopt;
  }
  if (!claims_late(*pending)) return std::nullopt;
  hold_rest(*pending);
  const auto move = pending->command_sequence->granted();
  note_commanded(*pending);
  note_begun(*pending, false);
  if (move.kind == CommandSequence::Move::Kind::exchange) return move.exchange;
  if (move.kind == CommandSequence::Move::Kind::wait) {
    host_.job_waits(id, move.until);
  } else {
    complete(id, pending->command_sequence->result());
  }
  return std::nullopt;
}

bool Axis::passes_resync(bus::JobId id) {
  Pending* pending = pending_.find(id);
  if (pending == nullptr) return false;
  return pending->command_sequence->passes_resync();
}

void Axis::on_result(bus::JobId id, const bus::ExchangeResult& result, Instant sent_at, bool trusted) {
  Pending* pending = pending_.find(id);
  if (pending == nullptr) return;
  pending->command_sequence->on_result(result, sent_at, trusted);
  carry_on(*pending);
}

void Axis::carry_on(Pending& pending) {
  hold_rest(pending);
  const auto move = pending.command_sequence->advance();
  if (move.kind == CommandSequence::Move::Kind::finished) {
    complete(pending.id, pending.command_sequence->result());
    return;
  }
  if (ends_with_gateway(pending)) return end_begun(pending);
  if (move.kind == CommandSequence::Move::Kind::wait) host_.job_waits(pending.id, move.until);
  if (!pending.command_sequence->stop_is_over()) return;
  note_stop(pending, false);
  // What commands waited behind this stop, and a later one drops it, as it drops whatever commands and waits.
  if (pending.stopped_by && asks_to_begin(pending.command_sequence->batch()))
    return on_job_ended(pending.id, Errc::dropped_by_stop);
  // The stop is done; the rest of its write batch goes on where it stands, and has no precedence any more.
  bus::BusJob rest = job_for(core_, pending.command_sequence->batch(), false);
  rest.read.reset();
  rest.setpoints_only = false;
  rest.start_by = kNever;
  if (!host_.job_goes_on_as(pending.id, rest)) {
    complete(pending.id, {{Errc::queue_full, 0}, 0, 0});
    return;
  }
  pending.command_sequence->stop_was_handed_over();
}

void Axis::on_job_ended(bus::JobId id, Errc code) {
  Pending* pending = pending_.find(id);
  if (pending == nullptr) return;
  CommandSequence& command_sequence = *pending->command_sequence;
  const bool begun = command_sequence.begun();
  const bool by_other = pending->stopped_by && *pending->stopped_by != command_sequence.batch().client;
  if (code == Errc::dropped_by_stop && begun && by_other) code = Errc::stopped_by_other;
  // Whether something was sent is what tells the two apart, not whether the bus had granted it a turn.
  if (code == Errc::link_lost && !begun) code = Errc::offline;
  if (code == Errc::offline && begun) code = Errc::link_lost;
  command_sequence.abort(refusal(code));
  complete(id, command_sequence.result());
}

void Axis::complete(bus::JobId id, const BatchResult& result) {
  const auto found = std::find_if(pending_.begin(), pending_.end(), [&](const Pending& p) { return p.id == id; });
  if (found == pending_.end()) return;
  Pending pending = std::move(*found);
  pending_.erase(found);
  host_.job_done(id);
  note_commanded(pending);
  note_begun(pending, result.outcome.code == Errc::ok);
  note_stop(pending, true);
  note_jog(pending, result.outcome.code);
  watch_.finished(pending.batch(), result.outcome.code, pending.command_sequence->begun());
  if (!pending_.starts_motion()) core_.motion.unmask_target_reached();
  BatchResult told = result;
  told.stop = pending.command_sequence->began_as_stop() ? pending.accepted : 0;
  told.refused_row = refused_row(core_, pending.command_sequence->batch(), told.outcome.code);
  if (told.outcome.code == Errc::ok && pending.refusal != Errc::ok) {
    told.outcome = {pending.refusal, 0};
    told.refused_row = pending.refused_row;
  }
  name_limit(pending.command_sequence->batch(), told);
  if (told.outcome.code != Errc::ok) {
    forget_accepted_speeds(core_, pending.command_sequence->batch());
    if (!pending.command_sequence->begun()) forget_accepted(pending.command_sequence->batch());
  }
  if (!pending.by_mailbox) {
    show_latest(pending.command_sequence->batch(), told.outcome);
    image_.latest.stop = told.stop;
  }
  tell_ended(pending, told.outcome);
  if (told.outcome.code == Errc::timed_out) watch_enable(*pending.command_sequence);
  if (told.outcome.code == Errc::not_reached) {
    tell_not_reached(pending);
    const Command stop = pending.command_sequence->withdrawn_by();
    if (stop != Command::none)
      return withdraw(pending.command_sequence->batch(), stop, told, std::move(pending.callbacks));
  }
  if (!pending.callbacks.empty()) due_.push_back({told, std::move(pending.callbacks)});
}

}  // namespace axisgate::drive
