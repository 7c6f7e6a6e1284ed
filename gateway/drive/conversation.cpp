#include "gateway/drive/conversation.hpp"

namespace axisgate::drive {
namespace {

// Between two looks at an awaited condition, so that a waiting group leaves the wire to others.
constexpr Duration kLookAgain = std::chrono::milliseconds(5);
// How long a stop may take to show before it is sent once more.
constexpr Duration kStopShows = std::chrono::milliseconds(250);

std::uint32_t wire_bits(std::int64_t number, std::uint8_t size) {
  const std::uint32_t mask = size >= 4 ? ~0U : (1U << (8U * size)) - 1U;
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(number)) & mask;
}

}  // namespace

Conversation::Conversation(AxisCore& core, const Group& group, bool stop, bool by_mailbox)
    : core_(core),
      group_(group),
      stop_(stop),
      by_mailbox_(by_mailbox),
      stops_before_(core.motion.stops()),
      phase_(stop ? Phase::stop : Phase::setpoints) {
  // In the group's order the controlword comes before the command: carried out after the stop it could undo it, and before it
  // the stop would have to wait for it. A stop by controlword is part of the stop; anything else the stop has made void.
  if (stop_ && axisgate::is_stop(group_.command) && group_.controlword &&
      !drive::is_stop(*group_.controlword, group_.single_controlword))
    group_.controlword.reset();
}

// --- Phases ----------------------------------------------------------------------------------------------------------

Plan Conversation::plan_of(Phase phase) {
  switch (phase) {
    case Phase::stop:
      return plan_stop(core_, group_);
    case Phase::setpoints:
      return plan_setpoints(core_, group_);
    case Phase::mode:
      return group_.mode ? plan_raw_mode(core_, *group_.mode) : Plan{};
    case Phase::controlword: {
      const bool done_as_stop = stop_ && group_.controlword &&
                                drive::is_stop(*group_.controlword, group_.single_controlword);
      return group_.controlword && !done_as_stop ? plan_controlword(core_, *group_.controlword) : Plan{};
    }
    case Phase::preparation:
      mode_before_ = core_.mode_in_force();
      return group_.command == Command::none || axisgate::is_stop(group_.command)
                 ? Plan{}
                 : plan_preparation(core_, group_.command);
    case Phase::command:
      return group_.command == Command::none || axisgate::is_stop(group_.command)
                 ? Plan{}
                 : plan_command(core_, group_.command, mode_before_);
    case Phase::settle_stop:
    case Phase::object:
    case Phase::settle:
    case Phase::finished:
      break;
  }
  return {};
}

void Conversation::plan_phase() {
  if (phase_ == Phase::setpoints) remember_setpoints(core_, group_);
  Plan plan = plan_of(phase_);
  // A mode that a client asks for is its choice, also where it is in force already.
  if (phase_ == Phase::mode && group_.mode && !plan.refused()) core_.mode_chosen = true;
  planned_ = true;
  sent_of_plan_ = false;
  todo_ = std::move(plan.actions);
  at_ = 0;
  wait_until_ = kNever;
  if (plan.refused()) fail(plan.refusal.code, plan.refusal.detail);
}

void Conversation::next_phase() {
  phase_ = static_cast<Phase>(static_cast<std::uint8_t>(phase_) + 1);
  planned_ = false;
}

void Conversation::fail(Errc code, std::uint32_t detail) {
  result_.outcome = {code, detail};
  phase_ = Phase::finished;
}

void Conversation::abort(Outcome outcome) {
  if (!finished()) fail(outcome.code, outcome.detail);
}

// --- The next move ---------------------------------------------------------------------------------------------------

Conversation::Move Conversation::granted(Instant now) {
  if (planned_ && !sent_of_plan_) planned_ = false;
  Move move = advance(now);
  if (move.kind == Move::Kind::exchange) begun_ = sent_of_plan_ = true;
  return move;
}

Conversation::Move Conversation::advance_object() const {
  const ObjectRequest& o = *group_.object;
  const bus::Access access = o.write ? bus::Access::write : bus::Access::read;
  return {Move::Kind::exchange,
          {core_.drive.node, access, {o.index, o.subindex}, o.size, o.write ? wire_bits(o.data, o.size) : 0},
          kLongAgo};
}

Conversation::Move Conversation::advance(Instant now) {
  core_.now = now;
  while (!finished()) {
    if (phase_ == Phase::settle_stop || phase_ == Phase::settle) {
      if (const auto move = advance_settle()) return *move;
      next_phase();
      continue;
    }
    if (phase_ == Phase::object) {
      if (group_.object && !object_done_) return advance_object();
      next_phase();
      continue;
    }
    if (!planned_) {
      plan_phase();
      continue;
    }
    if (at_ == todo_.size()) {
      next_phase();
      continue;
    }
    const Action& action = todo_[at_];
    if (action.kind == Action::Kind::mark) {
      const Action mark = action;  // reaching it may plan anew
      pop();
      reach(mark, now);
    } else if (action.kind == Action::Kind::wait) {
      if (const auto move = advance_wait(action, now)) return *move;
    } else {
      return exchange_for(action);
    }
  }
  return {};
}

void Conversation::pop() {
  ++at_;
  verifying_ = false;
  wait_until_ = kNever;
}

std::int64_t Conversation::number_of(const Action& action) const {
  return action.copy_of == kNoObject ? action.number : core_.store[action.copy_of].number;
}

Conversation::Move Conversation::exchange_for(const Action& action) const {
  const ObjectDef& object = core_.object(action.object);
  bus::Exchange exchange{core_.drive.node, bus::Access::read, object.address, object.size, 0};
  if (action.kind == Action::Kind::write && !verifying_) {
    exchange.access = bus::Access::write;
    exchange.raw = wire_bits(number_of(action), object.size);
  }
  return {Move::Kind::exchange, exchange, kLongAgo};
}

std::optional<Conversation::Move> Conversation::advance_wait(const Action& action, Instant now) {
  if (wait_until_ == kNever) {
    wait_until_ = now + action.limit;
    if (phase_ == Phase::stop) {
      // However often the stop is repeated: the time it has in all began with its first look.
      if (stop_until_ == kNever) stop_until_ = wait_until_;
      wait_until_ = stop_until_;
      repeat_at_ = now + kStopShows;
    }
  }
  const ObjectState& state = core_.store[action.until.object];
  const bool fresh = state.known && state.exchange > last_acknowledged_;
  if (fresh && action.until.holds(core_.object(action.until.object), static_cast<std::uint32_t>(state.number))) {
    pop();
    return std::nullopt;
  }
  // A fence may have kept the look away until the time was over: one look there is in any case.
  const bool looked = fresh && state.sent_at + kLookAgain >= std::min(now, wait_until_);
  if (now >= wait_until_ && (looked || (fresh && action.limit == Duration{}))) {
    if (action.optional) {
      pop();
    } else {
      fail(action.otherwise, action.otherwise == Errc::state_unsuitable ? kDetailDeviceState : 0);
    }
    return std::nullopt;
  }
  if (fresh && phase_ == Phase::stop && !action.optional && now >= repeat_at_ && repeat_stop()) return std::nullopt;
  if (fresh && now < state.sent_at + kLookAgain) return Move{Move::Kind::wait, {}, state.sent_at + kLookAgain};
  return exchange_for(Action::read(action.until.object));
}

// A reply is sent only when the image holds a statusword sampled after the last acknowledgement.
std::optional<Conversation::Move> Conversation::advance_settle() const {
  if (!begun_ || last_acknowledged_ == 0 || core_.model.statusword == kNoObject) return std::nullopt;
  const ObjectState& status = core_.store[core_.model.statusword];
  if (status.refused || (status.known && status.exchange > last_acknowledged_)) return std::nullopt;
  return exchange_for(Action::read(core_.model.statusword));
}

bool Conversation::passes_fence() {
  if (phase_ != Phase::stop || verifying_) return false;
  if (!planned_ || !sent_of_plan_) plan_phase();
  return phase_ == Phase::stop && at_ < todo_.size() && todo_[at_].kind == Action::Kind::write;
}

bool Conversation::repeat_stop() {
  if (phase_ != Phase::stop || !would_repeat()) return false;
  ++attempts_;
  planned_ = verifying_ = false;
  return true;
}

// --- Results ---------------------------------------------------------------------------------------------------------

void Conversation::on_result(const bus::ExchangeResult& result, Instant sent_at, bool trusted) {
  if (finished()) return;
  if (result.code == Errc::link_lost) {
    fail(Errc::link_lost);
  } else if (phase_ == Phase::object) {
    on_object(result);
  } else if (phase_ == Phase::settle || phase_ == Phase::settle_stop) {
    if (result.code == Errc::refused_by_drive) next_phase();
  } else if (at_ < todo_.size()) {
    const Action& action = todo_[at_];
    if (action.kind == Action::Kind::write && !verifying_) {
      on_write(action, result, sent_at, trusted);
    } else {
      on_read(action.kind == Action::Kind::wait ? action.until.object : action.object, result);
    }
  }
}

void Conversation::on_write(const Action& action, const bus::ExchangeResult& result, Instant sent_at, bool trusted) {
  // Anything sampled from the next request on has seen this write, if it was one.
  last_acknowledged_ = core_.store.exchange();
  switch (result.code) {
    case Errc::ok:
      if (!trusted && core_.object(action.object).readable) {
        core_.store.doubt(action.object);
        verifying_ = true;
        return;
      }
      core_.store.acknowledged(action.object, number_of(action), sent_at);
      if (by_mailbox_) core_.store.doubt_all(action.object);
      pop();
      return;
    case Errc::refused_by_drive:
      if (!repeat_stop()) fail(Errc::refused_by_drive, result.detail);
      return;
    default:
      on_lost_write(action);
  }
}

// Unknown, and never sent again blindly: read back before it is reported. A stop is sent again, unless it is a halt that could
// enable a drive which has meanwhile restarted: that one is looked at first.
void Conversation::on_lost_write(const Action& action) {
  const ObjectDef& object = core_.object(action.object);
  const bool could_enable = action.object == core_.model.controlword &&
                            request_of(static_cast<std::uint16_t>(number_of(action))) == Request402::enable_operation;
  core_.store.doubt(action.object);
  if (!could_enable && repeat_stop()) return;
  if (object.trigger || !object.readable || (phase_ == Phase::stop && !could_enable)) {
    fail(Errc::timed_out);
  } else {
    verifying_ = true;
  }
}

void Conversation::on_read(ObjectId object, const bus::ExchangeResult& result) {
  const Action& action = todo_[at_];
  if (result.code == Errc::refused_by_drive) {
    if (action.kind == Action::Kind::wait && action.optional) {
      pop();
    } else {
      fail(verifying_ ? Errc::timed_out : Errc::refused_by_drive, result.detail);
    }
    return;
  }
  // A read that was not answered is asked again once the fence stands: it changes nothing. The drive goes offline first.
  if (result.code != Errc::ok) return;
  if (verifying_) {
    const ObjectDef& def = core_.object(object);
    if (core_.store[object].number == def.number(wire_bits(number_of(action), def.size))) {
      pop();
    } else if (!repeat_stop()) {
      fail(Errc::timed_out);
    }
  } else if (action.kind == Action::Kind::read) {
    pop();
  }
}

void Conversation::on_object(const bus::ExchangeResult& result) {
  if (result.code == Errc::ok && !group_.object->write && result.fields.empty()) {
    fail(Errc::bad_reply);
    return;
  }
  if (result.code != Errc::ok) {
    fail(result.code, result.detail);
    return;
  }
  object_done_ = true;
  if (group_.object->write) {
    last_acknowledged_ = core_.store.exchange();
    core_.store.doubt_all();
  } else {
    result_.object_data = result.fields.front().raw;
    result_.object_size = result.fields.front().size;
  }
}

// --- Turning points --------------------------------------------------------------------------------------------------

// A stop accepted after this group ends what it would begin: nothing that it reaches late counts as a start or an enable.
bool Conversation::overtaken_by_stop(Mark mark) const {
  switch (mark) {
    case Mark::enabled:
    case Mark::start_discrete:
    case Mark::start_velocity:
    case Mark::start_torque:
    case Mark::start_homing:
    case Mark::controlword_passed:
    case Mark::run_raw:
      return core_.motion.stops() != stops_before_;
    default:
      return false;
  }
}

void Conversation::reach(const Action& action, Instant now) {
  if (overtaken_by_stop(action.mark)) return;
  Motion& motion = core_.motion;
  const auto start = [&](MotionKind kind) { motion.start(kind, group_.command_id, now, core_.store.exchange()); };
  switch (action.mark) {
    case Mark::enabled:
      motion.enabled();
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
      motion.passed(request_of(*group_.controlword));
      break;
    case Mark::quick_stopped:
      if (!motion.latched()) motion.stop(true, now);
      stops_before_ = motion.stops();
      break;
    case Mark::halted:
      motion.stop(false, now);
      stops_before_ = motion.stops();
      break;
    case Mark::run_raw:
      motion.run_raw();
      break;
    case Mark::mode_changed:
      motion.mode_changed();
      if (phase_ == Phase::mode && core_.facts().enabled() && is_continuous(core_.mode_in_force())) motion.run_raw();
      break;
    case Mark::values_doubtful:
      core_.store.doubt_all(action.object);
      break;
    case Mark::not_homed:
      core_.homed = false;
      break;
    case Mark::borrow_homing:
      if (!core_.offset_owed) core_.offset_owed = core_.value(Quantity::homing_offset);
      break;
    case Mark::return_homing:
      core_.offset_owed.reset();
      break;
    case Mark::look_again:
      planned_ = false;
      break;
  }
}

}  // namespace axisgate::drive
