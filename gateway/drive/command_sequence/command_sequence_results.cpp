// SPDX-License-Identifier: Apache-2.0
// What a command sequence makes of an answer, and what it tells the motion rules at its turning points.
#include <fmt/format.h>

#include <algorithm>

#include "gateway/drive/command_sequence/command_sequence.hpp"
#include "gateway/drive/plan/admission.hpp"

namespace axisgate::drive {

namespace {

constexpr std::uint32_t kNoSuchSubindex = 0x06090011;  // CiA 301 table 22; Kinco's serial too

/// For whoever reads of it.
std::string named(const AxisCore& core, model::ObjectId object) {
  return fmt::format("{} ({})", core.object(object).name, place_of(core.drive, object));
}

bool is_not_there(std::uint32_t detail) {
  return detail == kNoSuchObject || detail == kNoSuchSubindex || detail == kModbusIllegalAddress;
}

}  // namespace

// --- Results -------------------------------------------------------------------------------------------------------

void CommandSequence::on_result(const bus::ExchangeResult& result, Instant sent_at, bool trusted) {
  writes_.under_way = false;
  if (finished()) return;
  if (result.code == Errc::link_lost) {
    fail(Errc::link_lost);
  } else if (phase_ == Phase::object) {
    on_object(result);
  } else if (phase_ == Phase::settle || phase_ == Phase::settle_stop) {
    if (result.code == Errc::refused_by_drive) {
      next_phase();  // what a drive never shows nothing can confirm
    } else if (result.code != Errc::ok && phase_ == Phase::settle_stop && !stop_attempt_.may_look_again()) {
      fail(Errc::not_reached, writes_.count);
    }
  } else if (!plan_.at_end()) {
    const Action& action = plan_.action();
    if (action.kind == Action::Kind::write && !writes_.verifying) {
      on_write(action, result, sent_at, trusted);
    } else {
      on_read(action.kind == Action::Kind::wait ? action.until.object : action.object, result);
    }
  }
}

bool CommandSequence::is_command_of_motion(model::ObjectId object) const {
  const auto& bindings = core_.model.bindings;
  return moves_by_write(core_, object) &&
         std::ranges::any_of(bindings, [&](const model::Binding& b) { return b.object == object && b.writable; });
}

void CommandSequence::on_write(const Action& action, const bus::ExchangeResult& result, Instant sent_at, bool trusted) {
  // Anything sampled from the next request on has seen this write, if it was one.
  writes_.acknowledged_by = core_.store.exchange();
  switch (result.code) {
    case Errc::ok:
      // What a trigger object reads as proves nothing; whether the stop was seen, its wait tells.
      if (!trusted && core_.object(action.object).readable && !core_.object(action.object).trigger && !action.joined) {
        core_.store.invalidate(action.object);
        writes_.verifying = true;
        return;
      }
      for (const Action& each : plan_.request()) {
        // Of several in one request none is read back: what is not believed is not cached, and the step after it tells.
        const model::ObjectDef& def = core_.object(each.object);
        if (trusted || !def.readable || def.trigger)
          core_.store.acknowledged(each.object, number_of(each), sent_at);
        else
          core_.store.invalidate(each.object);
        moved_by_write_ =
            moved_by_write_ || (phase_ != Phase::stop && is_command_of_motion(each.object) && core_.state().enabled());
      }
      writes_.acknowledged = true;
      if (by_mailbox_) core_.store.invalidate_all(action.object);
      pop();
      return;
    case Errc::refused_by_drive:
      if (action.optional && is_not_there(result.detail)) {
        pop();
        return;
      }
      if (!repeat_stop()) fail(Errc::refused_by_drive, result.detail);
      return;
    default:
      on_lost_write(action);
  }
}

// Unknown, and never sent again blindly: read back before it is reported. A stop is sent again, unless it is a halt
// that could enable a drive which has meanwhile restarted: that one is looked at first.
void CommandSequence::on_lost_write(const Action& action) {
  const model::ObjectDef& object = core_.object(action.object);
  const bool could_enable = is_enabling_word(core_, action.object, number_of(action));
  for (const Action& each : plan_.request()) core_.store.invalidate(each.object);
  if (!could_enable && repeat_stop()) return;
  if (action.joined || object.trigger || !object.readable || (phase_ == Phase::stop && !could_enable)) {
    fail(Errc::timed_out);
  } else {
    writes_.verifying = true;
  }
}

void CommandSequence::on_read(model::ObjectId object, const bus::ExchangeResult& result) {
  const Action& action = plan_.action();
  if (result.code == Errc::refused_by_drive) {
    // What it refuses for now may be shown yet; the wait has its end.
    if (phase_ == Phase::stop && action.effect == Effect::stop && result.for_now && stop_attempt_.may_look_again())
      return;
    // What a drive never shows nothing can confirm.
    if (action.kind == Action::Kind::wait && (action.optional || action.effect != Effect::none)) {
      pop();
    } else {
      fail(writes_.verifying ? Errc::timed_out : Errc::refused_by_drive, result.detail);
    }
    return;
  }
  // A read that was not answered is asked again once the resynchronisation read is answered: it changes nothing. The
  // drive goes offline first.
  if (result.code != Errc::ok) {
    // A stop is not held up by a look that nobody answers: what it writes is planned without it, and where it has
    // written all, it is owed until the drive shows it.
    if (phase_ != Phase::stop || writes_.verifying || result.code == Errc::link_lost) return;
    if (action.kind == Action::Kind::read)
      plan_.made = false;
    else if (!stop_attempt_.may_look_again())
      fail(Errc::not_reached, writes_.count);
    return;
  }
  stop_attempt_.was_answered();
  if (writes_.verifying) {
    const model::ObjectDef& def = core_.object(object);
    if (core_.store[object].number == def.number(def.raw(number_of(action)))) {
      pop();
    } else if (!repeat_stop()) {
      fail(Errc::timed_out);
    }
  } else if (action.kind == Action::Kind::read && (!core_.object(object).emulated || core_.store[object].cached)) {
    pop();  // a virtual axis's statusword may need more than one request
  }
}

void CommandSequence::on_object(const bus::ExchangeResult& result) {
  const Outcome outcome = mailbox_.take(core_.drive, *batch_.object, result, result_);
  if (outcome.code != Errc::ok) return fail(outcome.code, outcome.detail);
  if (!mailbox_.done() || !batch_.object->write) return;
  writes_.acknowledged_by = core_.store.exchange();
  core_.store.invalidate_all();
}

// --- Not reached ---------------------------------------------------------------------------------------------------

Outcome CommandSequence::outcome_if_late() const {
  // Nothing was sent, so no acknowledgement is lost. A stop waits on, and is owed.
  if (!begun_) return {stop_ ? Errc::not_reached : Errc::never_started, 0};
  const bool asks_for_a_state = phase_ == Phase::stop || phase_ == Phase::mode || in_command();
  // That a look was lost since, and the drive is suspect, takes back no acknowledgement; nor does a stop that is sent
  // once more.
  const bool acknowledged =
      (!writes_.under_way && !writes_.verifying) || (phase_ == Phase::stop && writes_.acknowledged);
  return asks_for_a_state && acknowledged ? Outcome{Errc::not_reached, writes_.count} : Outcome{Errc::timed_out, 0};
}

std::string CommandSequence::missed() const {
  if (result_.outcome.code == Errc::refused_by_drive) {
    if (plan_.at_end()) return {};
    const Action& action = plan_.action();
    return named(core_, action.kind == Action::Kind::wait ? action.until.object : action.object);
  }
  std::string out = writes_.count == 0 ? "nothing was sent" : fmt::format("step {}", writes_.count);
  const auto hex = [&](model::ObjectId id, std::int64_t number) {
    const model::ObjectDef& def = core_.object(id);
    return fmt::format("0x{:0{}X}", def.raw(number), 2 * def.size);
  };
  if (writes_.last)
    out += fmt::format(" ({} = {})", core_.object(writes_.last->object).name,
                       hex(writes_.last->object, writes_.last->number));
  if (plan_.at_end() || plan_.action().kind != Action::Kind::wait) return out + ": what follows was not sent in time";
  if (plan_.action().effect == Effect::homing) return out + ": awaited a motion or a change of its bits, read none";
  if (plan_.action().effect == Effect::stop) {
    const auto speed = core_.value(Quantity::velocity_actual);
    return out + ": awaited that it slows down, read " +
           (speed ? fmt::format("velocity_actual {}", *speed) : std::string("nothing"));
  }
  const model::Condition& until = plan_.action().until;
  const bool negated = until.test == model::Condition::Test::not_equals || until.test == model::Condition::Test::not_in;
  constexpr std::uint32_t kFaultBit = 0x0008;  // of the statusword: a reset waits for it to go
  const ObjectState& state = core_.store[until.object];
  const bool since = state.known && state.exchange > writes_.acknowledged_by;
  const std::string read = ", read " + (since ? hex(until.object, state.number) : std::string("nothing since"));
  if (until.object == core_.model.statusword && until.mask == kFaultBit)
    return out + (since ? ": the fault's cause is still there, statusword reads " + hex(until.object, state.number)
                        : ": whether the fault has gone is not known" + read);
  out += ": awaited " + core_.object(until.object).name;
  if (until.mask != 0) out += fmt::format(" & {}", hex(until.object, until.mask));
  out += negated ? " other than" : " =";
  constexpr std::size_t kMostNamed = 4;  // of a window of values the first tell enough
  for (std::size_t i = 0; i < std::min(until.values.size(), kMostNamed); ++i)
    out += (i == 0 ? " " : " or ") + hex(until.object, until.values[i]);
  return out + read;
}

// A start waits for its drive no longer, and the drive must not come back to it; nor may a mode that comes late make
// the motor follow what it did not follow before.
Command CommandSequence::withdrawn_by() const {
  if (is_stop() || writes_.count == 0) return Command::none;
  const bool enabled = core_.state().enabled();
  if (batch_.command == Command::enable || (asks_to_enable(batch_) && !enabled)) return Command::disable;
  const bool starts = needs_ready(batch_.command);
  const bool follows = batch_.mode && enabled;
  return starts || follows ? Command::halt : Command::none;
}

// --- Turning points ------------------------------------------------------------------------------------------------

// A stop accepted after this write batch ends what it would begin: nothing that it reaches late counts as a start or an
// enable.
bool CommandSequence::overtaken_by_stop(Mark mark) const {
  switch (mark) {
    case Mark::enabled:
    case Mark::found_enabled:
    case Mark::start_discrete:
    case Mark::start_velocity:
    case Mark::start_torque:
    case Mark::start_homing:
    case Mark::controlword_passed:
    case Mark::run_raw:
      return core_.motion.record().stopped_since(asked_);
    default:
      return false;
  }
}

void CommandSequence::reach(const Action& action) {
  if (overtaken_by_stop(action.mark)) return;
  Motion& motion = core_.motion;
  const auto start = [&](MotionKind kind) {
    // A set-point that changes what runs is no new motion.
    const bool goes_on = batch_.command == Command::none && !batch_.controlword;
    motion.start(kind, goes_on ? motion.id() : batch_.command_id, core_.turn.now, core_.store.exchange());
    core_.started(kind, action.number != 0, action.ends_at);
  };
  switch (action.mark) {
    case Mark::enabled:
      motion.enabled();
      break;
    case Mark::found_enabled:
      motion.unlatch();
      break;
    case Mark::start_discrete:
      start(MotionKind::discrete);
      break;
    case Mark::start_velocity:
      start(MotionKind::velocity);
      break;
    case Mark::start_torque:
      start(MotionKind::torque);
      break;
    case Mark::start_homing:
      start(MotionKind::homing);
      break;
    case Mark::controlword_passed:
      motion.passed(model::request_of(*batch_.controlword));
      break;
    case Mark::quick_stopped:
      // The stop that it takes the place of is no newer for it: what was accepted since comes after both.
      if (!motion.latched()) motion.stop(true, core_.turn.now, stop_ ? motion.record().newest_stop() : asked_);
      motion.disarm();
      break;
    case Mark::halted:
      motion.stop(false, core_.turn.now, asked_);
      break;
    case Mark::run_raw:
      core_.sent_to.reset();
      motion.run_raw(action.number != 0);
      break;
    case Mark::mode_changed:
      motion.mode_changed();
      if (phase_ == Phase::mode && core_.state().enabled() && core_.is_continuous(core_.mode_in_force()))
        motion.run_raw();
      break;
    case Mark::values_invalidated:
      core_.store.invalidate_all(action.object);
      break;
    case Mark::not_homed:
      core_.homed = false;
      core_.counter_wrapped = false;
      break;
    case Mark::borrow_homing:
      core_.asked.owe(Quantity::homing_offset, core_.value(Quantity::homing_offset));
      break;
    case Mark::return_homing:
      core_.asked.forget(Quantity::homing_offset);
      break;
    case Mark::look_again:
      plan_.made = false;
      break;
  }
}

}  // namespace axisgate::drive
