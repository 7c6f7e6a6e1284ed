// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/command_sequence/command_sequence.hpp"

#include <algorithm>

#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/write_exchange.hpp"

namespace axisgate::drive {
namespace {

// How long a stop may take to show before it is sent once more.
constexpr Duration kStopShows = std::chrono::milliseconds(250);
// That a motor gets slower shows in the sampled velocity alone: so much later than that lags.
constexpr Duration kSampleOfStop = std::chrono::milliseconds(100);

}  // namespace

CommandSequence::CommandSequence(AxisCore& core, const WriteBatch& batch, bool stop, bool by_mailbox)
    : core_(core),
      batch_(batch),
      stop_(stop),
      by_mailbox_(by_mailbox),
      asked_(core.motion.record().now()),
      phase_(stop ? Phase::stop : Phase::setpoints) {
  // In the write batch's order the controlword comes before the command: carried out after the stop it could undo it,
  // and before it the stop would have to wait for it. A stop by controlword is part of the stop; anything else the stop
  // has made void.
  if (stop_ && axisgate::is_stop(batch_.command) && !stops_by_word(batch_)) batch_.controlword.reset();
}

// --- Phases --------------------------------------------------------------------------------------------------------

Plan CommandSequence::plan_of(Phase phase) {
  switch (phase) {
    case Phase::stop:
      return plan_stop(core_, batch_, stop_attempt_.unheeded());
    case Phase::setpoints:
      return plan_setpoints(core_, batch_);
    case Phase::mode:
      return batch_.mode ? plan_raw_mode(core_, *batch_.mode) : Plan{};
    case Phase::controlword: {
      const bool done_as_stop = stop_ && stops_by_word(batch_);
      return batch_.controlword && !done_as_stop
                 ? plan_controlword(core_, *batch_.controlword, batch_.command != Command::none)
                 : Plan{};
    }
    case Phase::preparation:
      if (!mode_before_) mode_before_ = core_.mode_in_force();
      return batch_.command == Command::none || axisgate::is_stop(batch_.command)
                 ? Plan{}
                 : plan_preparation(core_, batch_.command);
    case Phase::command:
      return batch_.command == Command::none || axisgate::is_stop(batch_.command)
                 ? Plan{}
                 : plan_command(core_, batch_.command, mode_before_.value_or(0));
    case Phase::settle_stop:
    case Phase::object:
    case Phase::settle:
    case Phase::finished:
      break;
  }
  return {};
}

// "Set-points beside a command that is refused are accepted only if they would be without it."
void CommandSequence::drop_setpoints_of_a_refused_command() {
  // A controlword beside it may be what makes the axis ready.
  if (batch_.controlword || !refused_by_state(core_, batch_.command)) return;
  auto& setpoints = batch_.setpoints;
  setpoints.erase(
      std::remove_if(setpoints.begin(), setpoints.end(), [](const Setpoint& sp) { return sp.with_command; }),
      setpoints.end());
}

void CommandSequence::plan_phase() {
  if (phase_ == Phase::setpoints) {
    drop_setpoints_of_a_refused_command();
    remember_setpoints(core_, batch_);
  }
  Plan plan = plan_of(phase_);
  // A mode that a client asks for is its choice, also where it is in force already.
  if (phase_ == Phase::mode && batch_.mode && !plan.refused()) core_.mode_chosen = true;
  plan_.made = true;
  plan_.begun = false;
  plan_.actions = with_directions(core_, std::move(plan.actions), phase_ == Phase::command);
  plan_.at = 0;
  awaiting_.end();
  if (plan.refused()) fail(plan.refusal.code, plan.refusal.detail);
}

void CommandSequence::next_phase() {
  // What was done stays done, whatever becomes of the rest.
  if (phase_ == Phase::controlword && batch_.controlword) {
    result_.controlword_done = true;
    result_.command_sent = false;
  }
  phase_ = static_cast<Phase>(static_cast<std::uint8_t>(phase_) + 1);
  plan_.made = false;
}

void CommandSequence::fail(Errc code, std::uint32_t detail) {
  result_.outcome = {code, detail};
  phase_ = Phase::finished;
}

void CommandSequence::abort(Outcome outcome) {
  if (!finished()) fail(outcome.code, outcome.detail);
}

// --- The next move -------------------------------------------------------------------------------------------------

CommandSequence::Move CommandSequence::granted() {
  if (plan_.made && !plan_.begun) {
    plan_.made = false;
    // Whether it may start at all is judged with the preparation; but not once the preparation has changed the mode:
    // what was at rest in mode 1 would have to prove it again in mode 6, and the mode would stay changed.
    if (phase_ == Phase::command && !preparation_sent_) phase_ = Phase::preparation;
  }
  Move move = advance();
  if (move.kind == Move::Kind::exchange && !within_nvm_budget(move.exchange)) {
    fail(Errc::busy);
    return {};
  }
  if (move.kind == Move::Kind::exchange) {
    begun_ = plan_.begun = true;
    if (in_command() && move.exchange.access != bus::Access::read) acted_ = result_.command_sent = true;
    // What it copies may come anew, by process data, before the write is acknowledged.
    if (!plan_.at_end() && plan_.action().kind == Action::Kind::write && !writes_.verifying) {
      for (std::size_t i = plan_.at; i < plan_.at + plan_.request().size(); ++i) {
        plan_.actions[i].number = number_of(plan_.actions[i]);
        plan_.actions[i].copy_of = model::kNoObject;
      }
      ++writes_.count;
      effect_.sending(core_);
      writes_.last = plan_.action();
      writes_.under_way = true;
    }
    if (phase_ == Phase::preparation) preparation_sent_ = true;
  }
  return move;
}

// Stops are exempt: a worn memory cell is the smaller harm.
bool CommandSequence::within_nvm_budget(const bus::Exchange& exchange) {
  if (exchange.access == bus::Access::read || phase_ == Phase::stop) return true;
  const auto worn = [&](const ObjectAddress& address) {
    const model::ObjectId id = core_.drive.find(address);
    return core_.nvm.take(id == model::kNoObject ? core_.drive.nvm : core_.object(id).nvm, core_.turn.now);
  };
  if (!worn(exchange.object)) return false;
  return !core_.drive.composed.empty() ||
         std::ranges::all_of(exchange.more, [&](const bus::Neighbour& each) { return worn(each.object); });
}

CommandSequence::Move CommandSequence::advance() {
  while (!finished()) {
    if (phase_ == Phase::setpoints && core_.turn.now < rest_held_) return {Move::Kind::wait, {}, rest_held_};
    if (phase_ == Phase::settle_stop || phase_ == Phase::settle) {
      if (const auto move = advance_settle()) return *move;
      if (phase_ == Phase::settle_stop) stop_attempt_.state_was_read();
      if (phase_ == Phase::settle && has_lost_torque())
        fail(Errc::state_unsuitable, kDetailDeviceState);
      else
        next_phase();
      continue;
    }
    if (phase_ == Phase::object) {
      if (batch_.object && !mailbox_.done() && !MailboxAccess::is_needless(core_, *batch_.object))
        return {Move::Kind::exchange, mailbox_.next(core_.drive, *batch_.object), kLongAgo};
      next_phase();
      continue;
    }
    if (!plan_.made) {
      plan_phase();
      continue;
    }
    if (plan_.at_end()) {
      next_phase();
      continue;
    }
    const Action& action = plan_.action();
    if (action.kind == Action::Kind::mark) {
      const Action mark = action;  // reaching it may plan anew
      pop();
      reach(mark);
    } else if (action.kind == Action::Kind::wait) {
      if (const auto move = advance_wait(action)) return *move;
    } else if (action.kind == Action::Kind::write && core_.object(action.object).emulated) {
      const Action emulated = action;
      pop();
      // A stop never opens the gate: another one may have closed it since this halt was planned.
      const AxisFacts facts = core_.facts();
      const bool stays_open = facts.enabled() && facts.commanded;
      if (phase_ != Phase::stop || !is_enabling_word(core_, emulated.object, emulated.number) || stays_open)
        core_.make(emulated.object, emulated.number);
      acted_ = acted_ || in_command();
      result_.command_sent = result_.command_sent || in_command();
    } else if (enables_uncommanded(action)) {
      // It was enabled when this was planned. The same word would now take it back there, which nobody asked for.
      if (phase_ == Phase::stop) {
        stop_attempt_.withhold();
        pop();
      } else {
        fail(Errc::state_unsuitable, kDetailDeviceState);
      }
    } else {
      return exchange_for(action);
    }
  }
  return {};
}

// A word with the bits of operation enabled, for an axis that is not, by a write batch that does not ask for an enable.
bool CommandSequence::enables_uncommanded(const Action& action) const {
  const bool asked = batch_.command == Command::enable || phase_ == Phase::controlword;
  const auto enables = [this](const Action& each) { return is_enabling_word(core_, each.object, number_of(each)); };
  if (asked || action.kind != Action::Kind::write || writes_.verifying ||
      std::ranges::none_of(plan_.request(), enables))
    return false;
  const AxisFacts facts = core_.facts();
  return !facts.enabled() || !facts.commanded;
}

void CommandSequence::pop() {
  plan_.at += writes_.verifying ? 1 : plan_.request().size();
  writes_.verifying = false;
  awaiting_.end();
}

std::int64_t CommandSequence::number_of(const Action& action) const {
  return action.copy_of == model::kNoObject ? action.number : core_.store[action.copy_of].number;
}

CommandSequence::Move CommandSequence::exchange_for(const Action& action) const {
  const bool write = action.kind == Action::Kind::write && !writes_.verifying;
  if (write) {
    Move out{Move::Kind::exchange, write_of(core_.drive, action.object, number_of(action)), kLongAgo};
    for (const Action& each : plan_.request().subspan(1)) {
      const bus::Exchange next = write_of(core_.drive, each.object, number_of(each));
      out.exchange.more.push_back({next.object, next.size, next.raw});
    }
    return out;
  }
  const model::ObjectDef& object = core_.object(core_.to_read(action.object));
  return {Move::Kind::exchange, {core_.drive.node, bus::Access::read, object.address, object.size, 0}, kLongAgo};
}

std::optional<CommandSequence::Move> CommandSequence::advance_wait(const Action& action) {
  const Instant now = core_.turn.now;
  if (!awaiting_.begun()) {
    const bool by_motor = action.effect != Effect::none;
    const Duration shows = by_motor ? core_.model.velocity_lag + kSampleOfStop : kStopShows;
    const Instant until = now + action.limit;
    awaiting_.begin(phase_ == Phase::stop ? stop_attempt_.begin_wait(by_motor, until, now + shows) : until);
  }
  const model::ObjectId look_at =
      action.effect == Effect::none ? action.until.object : EffectWatch::to_read(core_, action.effect);
  if (look_at == model::kNoObject || has_come(action, core_.store[look_at])) {
    pop();
    return std::nullopt;
  }
  const ObjectState& state = core_.store[look_at];
  const bool fresh = state.known && state.exchange > writes_.acknowledged_by;
  if (fresh) awaiting_.judged(state, now);
  // One look there is in any case.
  const bool looked = fresh && awaiting_.is_last_look(state, now);
  if (awaiting_.is_over(now) && (looked || (fresh && action.limit == Duration{}))) {
    if (action.optional) {
      // Nobody answers a frame, and the motor has not told either that it was heard.
      if (phase_ == Phase::stop && !core_.drive.composed.empty() && core_.is_continuous(core_.mode_in_force()) &&
          core_.moving())
        stop_attempt_.withhold();
      pop();
    } else {
      fail(action.otherwise, action.otherwise == Errc::not_reached ? writes_.count : refusal(action.otherwise).detail);
    }
    return std::nullopt;
  }
  // Where nobody answers a frame, what may run out without a failure tells as well that it was lost.
  const bool tells = !action.optional || !core_.drive.composed.empty();
  if (fresh && phase_ == Phase::stop && tells && stop_attempt_.repeat_is_due(now) && repeat_stop()) {
    if (action.effect == Effect::none) stop_attempt_.was_not_heeded();
    return std::nullopt;
  }
  if (fresh && now < awaiting_.look_after()) return Move{Move::Kind::wait, {}, awaiting_.look_after()};
  return exchange_for(Action::read(look_at));
}

bool CommandSequence::has_come(const Action& action, const ObjectState& looked_at) {
  if (action.effect != Effect::none) return effect_.shown(core_, action.effect, writes_.acknowledged_by);
  return looked_at.known && looked_at.exchange > writes_.acknowledged_by &&
         action.until.holds(core_.object(action.until.object), static_cast<std::uint32_t>(looked_at.number));
}

// A reply is sent only when the image holds a statusword sampled after the last acknowledgement.
std::optional<CommandSequence::Move> CommandSequence::advance_settle() const {
  if (!begun_ || writes_.acknowledged_by == 0 || core_.model.statusword == model::kNoObject) return std::nullopt;
  const ObjectState& status = core_.store[core_.model.statusword];
  if (status.refused || (status.known && status.exchange > writes_.acknowledged_by)) return std::nullopt;
  return exchange_for(Action::read(core_.model.statusword));
}

// The drive may answer such a write all the same, or answers none at all: whether the motor could obey, its state
// tells.
bool CommandSequence::has_lost_torque() const { return moved_by_write_ && !core_.state().enabled(); }

bool CommandSequence::passes_resync() {
  if (phase_ != Phase::stop || writes_.verifying) return false;
  if (!plan_.made || !plan_.begun) plan_phase();
  // What stands beside a part must be known for sure before it is written back.
  return phase_ == Phase::stop && !plan_.at_end() && plan_.action().kind == Action::Kind::write &&
         !core_.object(plan_.action().object).is_part();
}

bool CommandSequence::repeat_stop() {
  if (phase_ != Phase::stop || !would_repeat()) return false;
  stop_attempt_.repeat();
  plan_.made = writes_.verifying = false;
  return true;
}

}  // namespace axisgate::drive
