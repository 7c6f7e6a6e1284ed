#include "gateway/drive/conversation.hpp"

namespace axisgate::drive {
namespace {

// Between two looks at an awaited condition, so that a waiting group leaves the wire to others.
constexpr Duration kLookAgain = std::chrono::milliseconds(5);

std::uint32_t wire_bits(std::int64_t number, std::uint8_t size) {
  const std::uint32_t mask = size >= 4 ? ~0U : (1U << (8U * size)) - 1U;
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(number)) & mask;
}

}  // namespace

Conversation::Conversation(AxisCore& core, const Group& group, bool stop)
    : core_(core), group_(group), stop_(stop), phase_(stop ? Phase::stop : Phase::setpoints) {}

// --- Phases ----------------------------------------------------------------------------------------------------------

Plan Conversation::plan_of(Phase phase) {
  switch (phase) {
    case Phase::stop: {
      const bool by_command = axisgate::is_stop(group_.command);
      return by_command ? plan_stop(core_, group_.command) : plan_stop_controlword(core_, *group_.controlword);
    }
    case Phase::setpoints:
      return plan_setpoints(core_, group_);
    case Phase::mode:
      return group_.mode ? plan_mode(core_, *group_.mode) : Plan{};
    case Phase::controlword: {
      const bool done_as_stop = stop_ && !axisgate::is_stop(group_.command);
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
  Plan plan = plan_of(phase_);
  planned_ = true;
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

Conversation::Move Conversation::advance(Instant now) {
  while (!finished()) {
    if (phase_ == Phase::settle_stop || phase_ == Phase::settle) {
      if (const auto move = advance_settle()) return *move;
      next_phase();
      continue;
    }
    if (phase_ == Phase::object) {
      if (group_.object && !object_done_) {
        const ObjectRequest& o = *group_.object;
        return {Move::Kind::exchange,
                {core_.drive.node, o.write ? bus::Access::write : bus::Access::read, {o.index, o.subindex}, o.size,
                 o.write ? wire_bits(o.data, o.size) : 0},
                kLongAgo};
      }
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
      reach(action.mark, now);
      pop();
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
  if (wait_until_ == kNever) wait_until_ = now + action.limit;
  const ObjectState& state = core_.store[action.until.object];
  const bool fresh = state.known && state.exchange > last_acknowledged_;
  if (fresh && action.until.holds(core_.object(action.until.object), static_cast<std::uint32_t>(state.number))) {
    pop();
    return std::nullopt;
  }
  if (now >= wait_until_ && (fresh || action.limit > Duration{})) {
    if (action.optional) {
      pop();
    } else if (!repeat_stop()) {
      fail(action.otherwise, action.otherwise == Errc::state_unsuitable ? kDetailDeviceState : 0);
    }
    return std::nullopt;
  }
  if (fresh && now < state.sent_at + kLookAgain) return Move{Move::Kind::wait, {}, state.sent_at + kLookAgain};
  Action look = Action::read(action.until.object);
  return exchange_for(look);
}

// A reply is sent only when the image holds a statusword sampled after the last acknowledgement.
std::optional<Conversation::Move> Conversation::advance_settle() const {
  if (!begun_ || last_acknowledged_ == 0 || core_.model.statusword == kNoObject) return std::nullopt;
  const ObjectState& status = core_.store[core_.model.statusword];
  if (status.refused || (status.known && status.exchange > last_acknowledged_)) return std::nullopt;
  return exchange_for(Action::read(core_.model.statusword));
}

bool Conversation::passes_fence() const {
  return phase_ == Phase::stop && planned_ && at_ < todo_.size() && todo_[at_].kind == Action::Kind::write &&
         !verifying_;
}

bool Conversation::repeat_stop() {
  if (phase_ != Phase::stop || ++stop_attempts_ >= kStopAttempts) return false;
  planned_ = verifying_ = false;
  return true;
}

// --- Results ---------------------------------------------------------------------------------------------------------

void Conversation::on_result(const bus::ExchangeResult& result, Instant sent_at, bool trusted) {
  if (finished()) return;
  begun_ = true;
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
  const ObjectDef& object = core_.object(action.object);
  switch (result.code) {
    case Errc::ok:
      if (!trusted && object.readable) {
        core_.store.doubt(action.object);
        verifying_ = true;
        return;
      }
      core_.store.acknowledged(action.object, number_of(action), sent_at);
      // Anything sampled from the next request on has seen this write.
      last_acknowledged_ = core_.store.exchange();
      pop();
      return;
    case Errc::refused_by_drive:
      fail(Errc::refused_by_drive, result.detail);
      return;
    default:
      // Unknown, and never sent again blindly. A stop is: a state read shows whether it took.
      core_.store.doubt(action.object);
      last_acknowledged_ = core_.store.exchange();
      if (repeat_stop()) return;
      if (phase_ == Phase::stop || object.trigger || !object.readable) {
        fail(Errc::timed_out);
      } else {
        verifying_ = true;
      }
      return;
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
    if (core_.store[object].number == number_of(action)) {
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
    core_.store.doubt_all();
  } else {
    result_.object_data = result.fields.front().raw;
    result_.object_size = result.fields.front().size;
  }
}

// --- Turning points --------------------------------------------------------------------------------------------------

void Conversation::reach(Mark mark, Instant now) {
  Motion& motion = core_.motion;
  const std::uint16_t id = group_.command_id;
  switch (mark) {
    case Mark::enabled:
      motion.enabled();
      break;
    case Mark::start_discrete:
      motion.start(MotionKind::discrete, id, now, core_.store.exchange());
      break;
    case Mark::start_velocity:
      motion.start(MotionKind::velocity, id, now, core_.store.exchange());
      break;
    case Mark::start_torque:
      motion.start(MotionKind::torque, id, now, core_.store.exchange());
      break;
    case Mark::start_homing:
      motion.start(MotionKind::homing, id, now, core_.store.exchange());
      break;
    case Mark::controlword_passed:
      motion.passed(request_of(*group_.controlword));
      break;
    case Mark::run_raw:
      motion.run_raw();
      break;
    case Mark::mode_changed:
      motion.mode_changed();
      if (phase_ == Phase::mode) {
        core_.mode_chosen = true;
        if (core_.facts().enabled() && is_continuous(core_.mode_in_force())) motion.run_raw();
      }
      break;
    case Mark::values_doubtful:
      core_.store.doubt_all();
      break;
    case Mark::not_homed:
      core_.homed = false;
      break;
  }
}

}  // namespace axisgate::drive
