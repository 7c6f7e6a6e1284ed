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
namespace {

// What might still happen is withdrawn before the answer, and the answer is not late for it.
Instant decide_by(const WriteBatch& batch, Instant now) {
  constexpr Duration kWithdrawing = std::chrono::milliseconds(100);
  const bool withdrawable = batch.command == Command::enable || batch.mode || needs_ready(batch.command);
  if (!withdrawable || batch.answer_by == kNever || batch.answer_by <= now) return batch.answer_by;
  return batch.answer_by - std::min(kWithdrawing, (batch.answer_by - now) / 4);
}

/// "Done" is up to 2 s away by the contract (command 12), later than a client's usual deadline. A long object takes
/// many exchanges, and a client that asks for one is told to wait (43/13).
void lengthen(WriteBatch& batch, Instant now) {
  constexpr Duration kSaving = std::chrono::milliseconds(2500), kLongObject = std::chrono::seconds(5);
  if (batch.command == Command::save_parameters) batch.answer_by = std::max(batch.answer_by, now + kSaving);
  if (batch.object && batch.object->size == 0) batch.answer_by = std::max(batch.answer_by, now + kLongObject);
}

// A single row that is refused by a limit has it as detail, in the row's own units; a block has the row there.
void name_limit(const AxisCore& core, const WriteBatch& batch, BatchResult& result) {
  if (result.outcome.code != Errc::bad_value) return;
  const auto passed = passed_limit(core, batch);
  if (!passed) return;
  result.outcome.detail = static_cast<std::uint32_t>(passed->limit);
  result.limit = limit_text(core, *passed);
}

}  // namespace

Axis::Axis(const model::DriveModel& drive, AxisSlot slot, ObjectStore& store, const Turn& turn, AxisImage& image,
           const std::vector<Axis*>& shared, AxisHost& host)
    : image_(image),
      shared_(shared),
      lease_(shared.empty() ? image.lease : shared.front()->lease_),
      core_{drive, drive.axes[slot], store, turn, Motion{drive.axes[slot].velocity_lag, image.record}},
      shown_(core_, image_, host),
      guard_(lease_, drive.axes[slot].lease, core_.jog),
      events_(core_, image_, guard_, host),
      admission_(core_, image_, guard_, events_),
      jog_(core_, image_),
      watch_(core_, host),
      signs_(core_, watch_, guard_, host),
      queue_(core_, slot, host, *this) {
  core_.loss_stop_ms = model::loss_stop_ms(drive, std::nullopt);
  for (Axis* other : shared) other->shared_.push_back(this);
  if (!shared.empty()) core_.motion.share(shared.front()->core_.motion, slot);
}

// --- What its drive has found ----------------------------------------------------------------------------------------

void Axis::set_alarm(AxisAlarm alarm, bool on) {
  core_.alarms = on ? core_.alarms | bit(alarm) : core_.alarms & ~bit(alarm);
}

void Axis::set_loss_reaction(std::optional<bool> holds) {
  core_.loss_stop_ms = model::loss_stop_ms(core_.drive, holds);
}

void Axis::on_bring_up() {
  watch_.renumbered();
  core_.motion.record().restarted();
  core_.mode_chosen = false;
  core_.fault.forget_emergency();
  signs_.on_bring_up();
  core_.homed = false;
  core_.counter_wrapped = false;
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

// What was accepted stays what it is in register units; the drive's numbers for it are others now.
void Axis::on_scale() {
  shown_.show_model();
  watch_.renumbered();
  rescale(core_);
}

// By its state, its position and its velocity a motion is seen to end, to stand and to keep within its limits.
void Axis::on_blind(model::ObjectId object) {
  const auto gives = [&](Quantity quantity) {
    const model::Binding* binding = core_.model.binding(quantity);
    return binding != nullptr && binding->object == object;
  };
  const bool shows = core_.model.needs_for_state(object) || gives(Quantity::position_actual) ||
                     (core_.model.moving ? core_.model.moving->object == object : gives(Quantity::velocity_actual));
  if (!shows) return;
  guard_.blind(core_.object(object).name, seen());
  settle();
}

void Axis::on_adopted() {
  const Ownership& ownership = guard_.ownership();
  if (!core_.state().enabled() || ownership.owner() || !ownership.rules().on) return;
  guard_.adopted(core_.turn.now);
  settle();
}

void Axis::on_client_gone(ClientId client) {
  const Ownership& ownership = guard_.ownership();
  if (!ownership.rules().on) {
    guard_.client_gone(client, seen());
    return settle();
  }
  if (ownership.is_owner(client))
    events_.owner(ownership.owner()->name + (ownership.owner()->strength ? " is gone" : " has closed its connection") +
                  ": its lease goes on until it runs out");
}

// --- Carrying it out -------------------------------------------------------------------------------------------------

BatchResult Axis::refuse(const WriteBatch& batch, Errc code, bool shown) {
  BatchResult result{.outcome = refusal(code), .refused_row = refused_row(core_, batch, code)};
  name_limit(core_, batch, result);
  const Outcome& outcome = result.outcome;
  if (shown && !batch.object && command_result(code) != CommandResult::none)
    shown_.result(batch, command_result(code), outcome.detail);
  events_.refused(batch, result);
  return result;
}

void Axis::accept(const WriteBatch& batch) {
  if (batch.life && resets_fault(batch)) shown_.reset_asked(batch.life->name);
  watch_.accepted(batch);
  core_.asked.accept(batch);
}

std::optional<BatchResult> Axis::carry_out(const WriteBatch& asked, Errc refusal, BatchCallback on_result,
                                           const OwnStop* own) {
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
  if (code == Errc::ok && !core_.model.counts_known() && starts_motion(core_, batch)) code = Errc::still_in_setup;
  const bool shown = own == nullptr || own->shown;
  Pending pending;
  pending.refusal = refusal;
  pending.jogs = batch.jogs;
  if (code != Errc::ok) {
    // A stop is carried out whatever nonsense stands beside it; the answer tells of the nonsense.
    const Errc of_link = code == Errc::still_in_setup ? admission_.link_admits(stop, false) : Errc::ok;
    if (!stop) return refuse(asked, of_link == Errc::ok ? code : of_link);
    pending.refusal = code;
    pending.refused_row = refused_row(core_, batch, code);
    batch = stop_alone(batch);
    if (const Errc of_stop = admit(core_, batch); of_stop != Errc::ok) return refuse(asked, of_stop, shown);
  }
  // Accepted in every state: the latch is set even where nothing can be sent.
  if (stop && !(own != nullptr && own->again)) accept_stop(batch, own != nullptr && own->with_another);
  AxisRecord& record = core_.motion.record();
  pending.accepted = stop ? record.newest_stop() : record.accepted();
  if (const Errc of_link = admission_.link_admits(stop, reads_alone(batch)); of_link != Errc::ok) {
    if (stop) publish();
    return refuse(asked, of_link, shown);
  }
  // 3.5: owned from the first accepted write; who only waits for the client's return is taken by any write.
  pending.claims_when_begun =
      accepts_nothing(core_, batch) && !guard_.ownership().waits_for(batch.life, batch.all_zero);
  if (!pending.claims_when_begun) admission_.claim(batch);
  if (own == nullptr) settle();
  if (stop && pending.refusal == Errc::ok && queue_.join_stop(batch, on_result)) {
    publish();
    return std::nullopt;
  }
  if (shown && queue_.pending().empty() && nothing_to_send(core_, batch)) {
    // The wire is not needed: a PLC that writes the same block for ever is answered at once.
    accept(batch);
    remember_setpoints(core_, batch);
    core_.mode_chosen = core_.mode_chosen || batch.mode.has_value();
    return nothing_left(batch);
  }
  lengthen(batch, core_.turn.now);
  pending.by_mailbox = asked.object.has_value() || !shown;
  pending.command_sequence = std::make_unique<CommandSequence>(core_, batch, stop, asked.object && !batch.object);
  pending.starts_motion = starts_motion(core_, batch);
  if (pending.starts_motion && !pending.jogs) pending.ends_jog = guard_.jog().pressed();
  pending.start_by = stop ? kNever : batch.start_by;
  pending.callbacks.push_back({std::move(on_result), pending.start_by, decide_by(batch, core_.turn.now)});
  const auto [unqueued, joined] = queue_.push(std::move(pending), stop);
  if (unqueued != Errc::ok) {
    if (stop) publish();
    return refuse(batch, unqueued, shown);
  }
  if (joined) return std::nullopt;
  accept(batch);
  const bool starts = starts_motion(core_, batch);
  const bool drives = std::ranges::any_of(batch.setpoints, [](const Setpoint& sp) {
    return sp.quantity == Quantity::target_velocity || sp.quantity == Quantity::target_torque;
  });
  if (starts || drives) guard_.commanded(batch.client, batch.life);
  if (shown && !asked.object) shown_.result(batch, CommandResult::pending);
  if (starts) core_.motion.mask_target_reached();
  publish();
  return std::nullopt;
}

Errc Axis::may_go_on(Pending& pending) {
  const Errc code = admission_.judge_again(pending);
  settle();
  return code;
}

BatchResult Axis::on_ended(Pending& pending) {
  const CommandSequence& sequence = *pending.command_sequence;
  const WriteBatch& batch = sequence.batch();
  BatchResult result = sequence.result();
  on_begun(pending, result.outcome.code == Errc::ok);
  on_stop_over(pending, true);
  if (jog_.finished(pending, result.outcome.code))
    guard_.halt_jog("jog: another command has taken its mode and failed: halted");
  watch_.finished(batch, result.outcome.code, sequence.begun());
  if (!queue_.pending().starts_motion()) core_.motion.mask_target_reached(false);
  result.stop = sequence.began_as_stop() ? pending.accepted : 0;
  result.refused_row = refused_row(core_, batch, result.outcome.code);
  if (result.outcome.code == Errc::ok && pending.refusal != Errc::ok) {
    result.outcome = {pending.refusal, 0};
    result.refused_row = pending.refused_row;
  }
  name_limit(core_, batch, result);
  const Errc code = result.outcome.code;
  if (code != Errc::ok) {
    forget_speeds(core_, batch);
    // It takes back the stop of its own; another axis's is that axis's to take back.
    const bool refused = code == Errc::state_unsuitable && batch.command == Command::enable;
    if (refused && core_.motion.latched_by_another() && !core_.motion.record().stopped_since(sequence.asked()))
      core_.motion.unlatch();
    // It was dropped before anything of it was begun: a scanner that goes on writing it asks for it anew.
    if (!sequence.begun()) core_.asked.withdraw(batch);
    if (resets_fault(batch)) shown_.reset_failed();
  }
  if (!pending.by_mailbox) shown_.result(batch, command_result(code), result.outcome.detail, result.stop);
  events_.ended(pending, result.outcome);
  if (code == Errc::timed_out && batch.command == Command::enable && sequence.commanded()) {
    // Its acknowledgement was lost, and its client was told that nobody knows. A set-point that was lost beside it, on
    // an axis that was enabled all the time, is no enable.
    guard_.late_enable().unknown(core_.turn.now);
  }
  if (code != Errc::not_reached) return result;
  events_.not_reached(pending);
  if (const Command stop = sequence.withdrawn_by(); stop != Command::none) withdraw(pending, stop, result);
  return result;
}

// --- Each turn -------------------------------------------------------------------------------------------------------

void Axis::on_time() {
  queue_.on_time();
  settle();
}

void Axis::observe() {
  admission_.see_owner();
  const AxisFacts facts = core_.facts();
  core_.watch_fault();
  core_.motion.observe(facts, core_.model.homing_timeout);
  signs_.observe(facts, queue_.pending());
  set_alarm(AxisAlarm::clamped, std::ranges::any_of(core_.model.bindings, [this](const model::Binding& binding) {
              return binding.object != model::kNoObject && binding.object != core_.model.controlword &&
                     core_.store[binding.object].clamped;
            }));
  jog_.observe(queue_.pending().jogs(), shown_.cycle());
  observe_stop();
  watch_.observe(
      std::ranges::any_of(queue_.pending(), [](const Pending& p) { return AxisWatch::explains(p.batch()); }));
  if (const auto stop = watch_.take_stop(); stop && !queue_.closing()) guard_.asks(*stop);
  const ObjectState& status = core_.store[core_.model.statusword];
  const LinkState link = core_.turn.link;
  if (link == LinkState::unknown || link == LinkState::offline || link == LinkState::link_down)
    on_unreachable();
  else if (status.known)
    guard_.shows(model::state_of(static_cast<std::uint16_t>(status.number)), status.exchange,
                 core_.shows_torque() && core_.moving(), seen());
  if (core_.motion.take_homing_timeout()) guard_.homing_timed_out();
  settle();
}

Instant Axis::next_deadline() const {
  return std::min({core_.motion.deadline(), core_.fault.deadline(), guard_.next_deadline(core_.turn.now),
                   jog_.limit_due(), queue_.next_deadline(), shown_.stale_at()});
}

void Axis::publish() {
  guard_.ownership().set_armed(core_.turn.link != LinkState::online || core_.any_shared([](const AxisCore& axis) {
    return model::holds_motor(axis.state().state);
  }));
  if (&lease_ != &image_.lease) image_.lease = lease_;
  // By whatever way a homing was asked for: from when it is asked until it was seen to be over.
  shown_.publish(guard_.jog(), core_.motion.running() == MotionKind::homing || queue_.pending().moves_zero());
}

}  // namespace axisgate::drive
