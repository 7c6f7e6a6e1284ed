#include "gateway/app/hand_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/core/words.hpp"

namespace axisgate::app {
namespace {

using What = HandWrite::What;

constexpr std::string_view kReached = "reached";
constexpr std::uint16_t kJogForward = 8, kJogReverse = 9;
// Modbus application protocol V1.1b3 section 7, as the gateway uses it.
constexpr std::uint8_t kNotAllowed = 0x01, kNotThere = 0x02, kNotInLimits = 0x03, kNotNow = 0x06, kNothingSent = 0x0A,
                       kNotKnown = 0x0B;

std::uint16_t after(std::uint16_t id) {
  return id == UINT16_MAX ? std::uint16_t{1} : static_cast<std::uint16_t>(id + 1);
}

std::string_view row_text(const HandWrite& write) {
  switch (write.what) {
    case What::target_position:
      return "target_position";
    case What::profile_velocity:
      return "profile_velocity";
    case What::jog_velocity:
      return "jog_velocity";
    default:
      return write.what == What::coil ? "jog" : text(write.command);
  }
}

std::string exception_text(std::uint8_t exception) {
  return fmt::format("exception 0x{:02X} {}", exception, name_of(WordKind::exception, exception));
}

}  // namespace

std::string_view text(HandTask task) {
  static constexpr std::array<std::string_view, 4> kNames{"enable", "move", "jog", "stop"};
  return kNames[static_cast<std::size_t>(task)];
}

HandPlan::HandPlan(const HandOrder& order, Instant now) : order_(order) {
  // A stop asks nobody, and looks at nothing first.
  if (order_.task != HandTask::stop) return;
  step_ = Step::stop;
  write({.what = What::stop, .command = Command::quick_stop});
  stand_by_ = now + kStandLimit;
}

std::vector<HandWrite> HandPlan::take() {
  std::vector<HandWrite> out(outbox_.begin(), outbox_.end());
  outbox_.clear();
  return out;
}

void HandPlan::write(const HandWrite& write, bool of_step) {
  outbox_.push_back(write);
  waiting_.push_back({write, of_step});
}

void HandPlan::write_command(Command command) {
  id_ = after(id_);
  write({.what = What::command, .command = command, .id = id_});
}

void HandPlan::write_button(Button button, bool on) {
  write({.what = What::coil, .coil = button == Button::reverse ? kJogReverse : kJogForward, .on = on}, false);
  ++buttons_waiting_;
}

/// What is written now asks for something: from here on signs of life are due.
void HandPlan::claim(Instant now) {
  if (!std::exchange(claimed_, true)) next_beat_ = now + kHeartbeat;
}

// Answers.

void HandPlan::on_answer(std::uint8_t exception, Instant now) {
  if (waiting_.empty() || over()) return;
  const Waiting answer = waiting_.front();
  waiting_.pop_front();
  if (answer.write.what == What::heartbeat) {
    beat_waits_ = false;
    return;
  }
  ++answered_;
  if (answer.write.what == What::coil && !answer.of_step) return button_answered(exception, now);
  if (!answer.of_step) return;
  if (exception != 0 && !ending()) {
    exception_ = exception;
    // These say that nothing was begun; of the others it is not known.
    const bool not_begun = exception == kNotAllowed || exception == kNotThere || exception == kNotInLimits ||
                           exception == kNotNow || exception == kNothingSent;
    if (not_begun && step_ == Step::start) may_move_ = false;
    refused_what_ = row_text(answer.write);
    return go(Step::refused);
  }
  if (exception != 0 && answer.write.what == What::stop) {
    code_ = 1;
    const bool owed = exception == kNothingSent || exception == kNotKnown;
    words_ += fmt::format("{}{} was answered with {}: {}stop it by its wired stop if it moves",
                          words_.empty() ? "" : "; ", axisgate::text(answer.write.command), exception_text(exception),
                          owed ? "it is owed, and carried out as soon as the drive is back; " : "");
  }
  step_done(now);
}

void HandPlan::step_done(Instant now) {
  switch (step_) {
    case Step::begin:
      if (!order_.rpm) return after_speed(now);
      write(
          {.what = order_.task == HandTask::jog ? What::jog_velocity : What::profile_velocity, .number = *order_.rpm});
      claim(now);
      return go(Step::speed);
    case Step::speed:
      return after_speed(now);
    case Step::enable:
      return go(Step::enabled);
    case Step::released:
      return go(Step::working);
    case Step::target:
      claim(now);
      write_command(order_.relative ? Command::move_relative : Command::move_absolute);
      may_move_ = true;
      return go(Step::start);
    case Step::start:
      return go(Step::working);
    case Step::stop:
      watched_from_ = now;
      return go(Step::standing);
    case Step::disable:
      return after_disable();
    case Step::release:
      return go(Step::over);
    default:
      return;
  }
}

void HandPlan::after_speed(Instant now) {
  const bool enabled = view_->has(AxisInput::enabled) && !view_->has(AxisInput::stop_latched);
  if (enabled && order_.task != HandTask::enable) return after_enable(now);
  torque_is_ours_ = !view_->has(AxisInput::enabled);
  claim(now);
  write_command(Command::enable);
  go(Step::enable);
}

void HandPlan::after_enable(Instant now) {
  if (order_.task == HandTask::move) {
    write({.what = What::target_position, .number = order_.turns});
    claim(now);
    return go(Step::target);
  }
  if (order_.task == HandTask::jog) {
    // A button acts on 1 once it was 0.
    write({.what = What::coil, .coil = kJogForward}, false);
    ++buttons_waiting_;
    write({.what = What::coil, .coil = kJogReverse});
    return go(Step::released);
  }
  go(Step::working);
}

void HandPlan::button_answered(std::uint8_t exception, Instant now) {
  watched_from_ = now;
  buttons_waiting_ = std::max(0, buttons_waiting_ - 1);
  if (exception == 0 || ending() || button_ == Button::none) return;
  if (exception == kNotNow && view_ && !view_->anothers()) {
    // The gateway has ended this jog, or its axis is not ready for one: the next press is another one.
    return let_go();
  }
  let_go();
  exception_ = exception;
  refused_what_ = "jog";
  go(Step::refused);
}

// Looks.

void HandPlan::on_view(const HandView& view, std::uint32_t answered, Instant now) {
  if (over()) return;
  view_ = view;
  note_position(now);
  if (view.mine() && view.lease_remaining_ms != 0) {
    has_lease_ = true;
    lease_ms_ = std::max(lease_ms_, view.lease_remaining_ms);
  }
  const bool steps_wait =
      std::any_of(waiting_.begin(), waiting_.end(), [](const Waiting& w) { return w.write.what != What::heartbeat; });
  if (answered != answered_ || steps_wait) return;  // it may be older than what was answered
  switch (step_) {
    case Step::look:
      return first_look(now);
    case Step::enabled:
      if (view.has(AxisInput::enabled)) return after_enable(now);
      return watch(now);
    case Step::working:
      if (order_.task == HandTask::jog && button_ == Button::none && stands(now) && now >= watched_from_ + kStill)
        may_move_ = false;
      return watch(now);
    case Step::refused:
      return finish(1, why_refused(), now);
    case Step::standing:
      return stood(now);
    default:
      return;
  }
}

void HandPlan::first_look(Instant now) {
  const HandView& view = *view_;
  const std::string name = axis_text();
  if (!view.in_sight())
    return finish(1,
                  fmt::format("{} is out of reach (link {}): nothing was sent", name,
                              name_of(WordKind::link_state, static_cast<std::uint32_t>(view.link))),
                  now);
  if (view.has(AxisInput::fault))
    return finish(1,
                  fmt::format("{} has a fault, error_code 0x{:04X}: axisgate explain 0x{:04X}; command 5 resets it "
                              "once its cause is gone",
                              name, view.error_code, view.error_code),
                  now);
  if (view.anothers())
    return finish(1,
                  fmt::format("{} is owned by {}: end that client, or let it release the axis (command 13)", name,
                              owner_text(view)),
                  now);
  const bool ready = view.has(AxisInput::enabled) && !view.has(AxisInput::stop_latched);
  if (!ready && order_.task != HandTask::enable && !order_.enable)
    return finish(1,
                  fmt::format("{} is {}: --enable enables it for this {}", name,
                              view.has(AxisInput::enabled) ? "stopped and latched" : "disabled", text(order_.task)),
                  now);
  owned_before_ = view.mine();
  id_ = after(view.command_id_seen);
  write({.what = What::command, .command = Command::none, .id = id_});
  go(Step::begin);
}

/// While it holds, moves or jogs.
void HandPlan::watch(Instant now) {
  const HandView& view = *view_;
  const std::string name = axis_text();
  if (!view.in_sight())
    return finish(1,
                  fmt::format("{} went out of reach (link {}); what it does is not known", name,
                              name_of(WordKind::link_state, static_cast<std::uint32_t>(view.link))),
                  now);
  if (view.has(AxisInput::fault))
    return finish(1,
                  fmt::format("{} has a fault, error_code 0x{:04X}: axisgate explain 0x{:04X}", name, view.error_code,
                              view.error_code),
                  now);
  if (view.anothers()) {
    torque_is_ours_ = false;  // its new owner decides
    return finish(1, fmt::format("{} was taken over by {}", name, owner_text(view)), now);
  }
  if (has_lease_ && !view.mine())
    return finish(1, fmt::format("the lease of {} ran out: the gateway has stopped it", name), now);
  if (view.has(AxisInput::stop_latched) || !view.has(AxisInput::enabled))
    return finish(1, fmt::format("{} was stopped by another client, its lease or its drive", name), now);
  if (order_.task != HandTask::move || view.motion_id != id_) return;
  if (view.motion == MotionState::completed) {
    // At its target it may still be told to turn: velocities are old by a filter's time. No stop is needed for that.
    may_move_ = false;
    words_ = kReached;
    watched_from_ = now;
    stand_by_ = now + kStandLimit;
    return go(Step::standing);
  }
  if (view.motion == MotionState::aborted || view.motion == MotionState::failed)
    return finish(1,
                  fmt::format("the move of {} was {}: {}", name,
                              name_of(WordKind::motion_state, static_cast<std::uint32_t>(view.motion)),
                              hand_line(order_.axis, view, "")),
                  now);
}

/// A drive's speed may be a filter's time old: a motor that has just begun to turn is told to stand. Its position is
/// not. A motor that is held on its place trembles by less than this.
void HandPlan::note_position(Instant now) {
  constexpr double kTremble = 0.01;  // turns
  if (!view_->turns) return;
  const double away = *view_->turns - still_at_.value_or(*view_->turns);
  if (away > kTremble || away < -kTremble) turned_at_ = now;
  if (!still_at_ || turned_at_ == now) still_at_ = view_->turns;
}

bool HandPlan::stands(Instant now) const {
  return view_ && view_->in_sight() && !view_->has(AxisInput::moving) && now - turned_at_ >= kStill;
}

std::string HandPlan::why_refused() const {
  const auto result = static_cast<std::uint32_t>(view_->result);
  std::string out = fmt::format("{}: {} was refused with {}", axis_text(), refused_what_, exception_text(exception_));
  if (exception_ == kNotAllowed)
    return out + ": the gateway gives this computer another role than operator (key \"allow\")";
  if (exception_ == kNotThere) return out + ": this drive does not have it (axisgate map shows what it has)";
  if (exception_ == kNotInLimits) return out + ": beyond the limits of the axis, its profile or its drive";
  if (view_->result == CommandResult::none) return out;
  const Word* word = find_word(WordKind::result, result);
  out += fmt::format(", result {}", result);
  if (word != nullptr) out += fmt::format(" {}: {}", word->name, word->meaning);
  return out;
}

// Keys.

void HandPlan::on_keys(const std::vector<HandKey>& keys, Instant now) {
  for (const HandKey key : keys) {
    if (step_ != Step::working || order_.task != HandTask::jog) return;
    if (key == HandKey::quit) return finish(0, fmt::format("{} is let go", axis_text()), now);
    if (key == HandKey::other) {
      let_go();
      continue;
    }
    const Button wanted = key == HandKey::forward ? Button::forward : Button::reverse;
    if (button_ != Button::none && button_ != wanted) {
      let_go();  // the next repeat of this key presses the other one
      continue;
    }
    // One press at a time is on its way: what waited in a slow network would be pressed late.
    if (buttons_waiting_ == 0) {
      claim(now);
      write_button(wanted, true);
      button_ = wanted;
      may_move_ = true;
    }
    if (button_ == wanted) last_key_ = now;
  }
}

void HandPlan::let_go() {
  if (button_ == Button::none) return;
  write_button(button_, false);
  button_ = Button::none;
}

void HandPlan::on_stall() { let_go(); }

// Time.

Instant HandPlan::due() const {
  if (over()) return kNever;
  Instant out = std::min(stand_by_, beat_waits_ ? kNever : next_beat_);
  if (button_ != Button::none) out = std::min(out, last_key_ + kKeyLapse);
  return out;
}

void HandPlan::on_time(Instant now) {
  if (over()) return;
  if (button_ != Button::none && now >= last_key_ + kKeyLapse) let_go();
  if (now >= next_beat_ && !beat_waits_ && step_ != Step::release) {
    write({.what = What::heartbeat, .id = ++beat_}, false);
    beat_waits_ = true;
    next_beat_ = now + kHeartbeat;
  }
  if (now < stand_by_) return;
  stand_by_ = kNever;
  code_ = 1;
  words_ += fmt::format("{}{} was not seen to stand within {} s: look at it", words_.empty() ? "" : "; ", axis_text(),
                        kStandLimit / std::chrono::seconds(1));
  // Torque that is taken from a motor that turns lets it coast.
  if (step_ == Step::standing || step_ == Step::stop) after_disable();
}

// The end.

void HandPlan::end(std::string_view why, Instant now) {
  if (ending()) return;
  const bool held = order_.task == HandTask::enable && step_ == Step::working && stands(now);
  const std::string_view what = !claimed_         ? " was asked for nothing"
                                : !held           ? " is stopped"
                                : torque_is_ours_ ? " is disabled"
                                                  : " is given back, enabled as it was found";
  finish(held ? 0 : 1, fmt::format("{}: {}{}", why, axis_text(), what), now);
}

void HandPlan::end_at_once() {
  if (over()) return;
  words_ += (words_.empty() ? "" : "; ") + std::string("ended at once, without waiting for the axis");
  code_ = 1;
  go(Step::over);
}

void HandPlan::lost(std::string_view why) {
  if (over()) return;
  code_ = 1;
  words_ = fmt::format("the gateway is out of reach ({})", why);
  if (claimed_ && has_lease_)
    words_ += fmt::format("; it stops {} when its lease runs out, within {} ms", axis_text(), lease_ms_);
  else if (claimed_)
    words_ += fmt::format("; {} has no lease: a move goes on to its target, and only a stop ends it", axis_text());
  else if (order_.task == HandTask::stop && outbox_.empty())
    words_ += fmt::format("; whether {} was stopped is not known", axis_text());
  step_ = Step::over;
}

void HandPlan::refuse_number(Instant now) {
  waiting_.pop_back();
  fail(fmt::format("{} does not fit its register, in the units of {}",
                   step_ == Step::speed ? fmt::format("{} rpm", order_.rpm->to_double())
                                        : fmt::format("{} turns", order_.turns.to_double()),
                   axis_text()),
       now);
}

void HandPlan::fail(std::string_view why, Instant now) {
  if (!ending()) return finish(1, std::string(why), now);
  // A stop has nothing left to do where its axis cannot be seen; any other end has its own limit of time.
  if (order_.task != HandTask::stop || over()) return;
  code_ = 1;
  if (words_.empty()) words_ = why;
  go(Step::over);
}

void HandPlan::finish(int code, std::string words, Instant now) {
  code_ = code;
  words_ = std::move(words);
  let_go();
  // What was asked for before is none of the end's steps.
  for (Waiting& waiting : waiting_) waiting.of_step = false;
  stand_by_ = now + kStandLimit;
  // An enabled axis that turns is stopped whoever made it turn; one that another client owns as well.
  const bool enabled_and_turns = claimed_ && !stands(now);
  if (!may_move_ && !enabled_and_turns) return after_stop();
  write({.what = What::stop, .command = Command::quick_stop});
  go(Step::stop);
}

void HandPlan::stood(Instant now) {
  if (view_->in_sight() && (!stands(now) || now < watched_from_ + kStill)) return;
  may_move_ = false;
  if (order_.task == HandTask::stop) {
    stand_by_ = kNever;
    const bool known = view_->in_sight();
    code_ = std::max(code_, known ? 0 : 1);
    if (words_.empty())
      words_ = known ? "stopped: " + hand_line(order_.axis, *view_, "")
                     : fmt::format("{} is out of reach: what it does is not known", axis_text());
    return go(Step::over);
  }
  if (code_ == 0) words_ += ": " + hand_line(order_.axis, *view_, "");
  after_stop();
}

void HandPlan::after_stop() {
  stand_by_ = kNever;
  if (!torque_is_ours_) return after_disable();
  torque_is_ours_ = false;
  write({.what = What::stop, .command = Command::disable});
  go(Step::disable);
}

void HandPlan::after_disable() {
  stand_by_ = kNever;
  if (!claimed_ || owned_before_ || order_.task == HandTask::stop || (view_ && view_->anothers()))
    return go(Step::over);
  write_command(Command::release);
  go(Step::release);
}

std::string HandPlan::axis_text() const { return fmt::format("axis {}", order_.axis); }

std::string HandPlan::doing() const {
  if (step_ == Step::stop || (step_ == Step::standing && words_ != kReached)) return "quick stop";
  if (step_ == Step::disable) return "disabling";
  if (step_ < Step::working) return "";
  if (step_ != Step::working) return "";
  switch (order_.task) {
    case HandTask::enable:
      return "held; Ctrl-C disables it";
    case HandTask::move:
      return fmt::format("{} {} turns; Ctrl-C stops", order_.relative ? "by" : "to", order_.turns.to_double());
    case HandTask::jog:
      break;
    case HandTask::stop:
      return "";
  }
  return button_ == Button::none      ? "hold an arrow key; q ends"
         : button_ == Button::forward ? "jogs forward"
                                      : "jogs in reverse";
}

}  // namespace axisgate::app
