// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/manual/plan/manual_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/core/words.hpp"

namespace axisgate::commands {
namespace {

constexpr std::uint16_t kJogForward = jog_coil(Command::jog_forward), kJogReverse = jog_coil(Command::jog_reverse);
std::uint16_t after(std::uint16_t id) {
  return id == UINT16_MAX ? std::uint16_t{1} : static_cast<std::uint16_t>(id + 1);
}

std::string_view row_text(const ManualWrite& write) {
  switch (write.what) {
    case ManualWrite::What::target_position:
      return "target_position";
    case ManualWrite::What::profile_velocity:
      return "profile_velocity";
    case ManualWrite::What::jog_velocity:
      return "jog_velocity";
    default:
      return write.what == ManualWrite::What::coil ? "jog" : text(write.command);
  }
}

constexpr auto kNotKnown = std::uint16_t{0xFFFF};  // a fault is shown before its cause

std::string cause_text(std::uint16_t error_code) {
  return fmt::format("error_code 0x{0:04X}: axisgate explain 0x{0:04X}", error_code);
}

}  // namespace

std::string_view text(ManualTask task) {
  static constexpr std::array<std::string_view, 4> kNames{"enable", "move", "jog", "stop"};
  return kNames[static_cast<std::size_t>(task)];
}

ManualPlan::ManualPlan(const ManualArguments& arguments, Instant now) : arguments_(arguments) {
  if (arguments_.rpm) rpm_ = *arguments_.rpm;
  // A stop asks nobody, and looks at nothing first.
  if (arguments_.task != ManualTask::stop) return;
  step_ = Step::stop;
  write({.what = ManualWrite::What::stop, .command = Command::quick_stop});
  stand_by_ = now + kStandLimit;
}

std::vector<ManualWrite> ManualPlan::take() {
  std::vector<ManualWrite> out(outbox_.begin(), outbox_.end());
  outbox_.clear();
  return out;
}

void ManualPlan::write(const ManualWrite& write, bool of_step) {
  outbox_.push_back(write);
  waiting_.push_back({write, of_step});
}

void ManualPlan::write_command(Command command) {
  id_ = after(id_);
  write({.what = ManualWrite::What::command, .command = command, .id = id_});
}

void ManualPlan::write_button(const std::optional<JogButton::Write>& button) {
  if (!button) return;
  const bool reverse = button->which == JogButton::Which::reverse;
  write({.what = ManualWrite::What::coil, .coil = reverse ? kJogReverse : kJogForward, .on = button->on}, false);
}

/// What is written now asks for something: from here on signs of life are due.
void ManualPlan::claim(Instant now) {
  if (!std::exchange(claimed_, true)) next_beat_ = now + kHeartbeat;
}

// Answers.

void ManualPlan::on_answer(ModbusException exception, Instant now) {
  if (waiting_.empty() || over()) return;
  const Waiting answer = waiting_.front();
  waiting_.pop_front();
  if (answer.write.what == ManualWrite::What::heartbeat) {
    beat_waits_ = false;
    return;
  }
  ++answered_;
  if (answer.write.what == ManualWrite::What::coil && !answer.of_step) return button_answered(exception, now);
  if (!answer.of_step) return;
  if (exception != ModbusException::none && !ending()) {
    exception_ = exception;
    // These say that nothing was begun; of the others it is not known.
    const bool not_begun =
        exception == ModbusException::illegal_function || exception == ModbusException::illegal_data_address ||
        exception == ModbusException::illegal_data_value || exception == ModbusException::server_device_busy ||
        exception == ModbusException::gateway_path_unavailable;
    if (not_begun && step_ == Step::start) may_move_ = false;
    refused_what_ = row_text(answer.write);
    return go(Step::refused);
  }
  if (exception != ModbusException::none && step_ == Step::set_back)
    words_ += fmt::format("; {} stays at {} rpm, for its {} rpm of before were refused", row_text(answer.write),
                          rpm_.to_double(), answer.write.number.to_double());
  if (exception != ModbusException::none && answer.write.what == ManualWrite::What::stop) {
    code_ = 1;
    const bool owed =
        exception == ModbusException::gateway_path_unavailable || exception == ModbusException::gateway_target_failed;
    words_ += fmt::format("{}{} was answered with {}: {}stop it by its wired stop if it moves",
                          words_.empty() ? "" : "; ", axisgate::text(answer.write.command), exception_text(exception),
                          owed ? "it is owed, and carried out as soon as the drive is back; " : "");
  }
  step_done(now);
}

void ManualPlan::step_done(Instant now) {
  switch (step_) {
    case Step::begin:
      return arguments_.rpm || has_speed() ? write_speed(now) : after_speed(now);
    case Step::speed:
      speed_set_ = true;
      return go(Step::speed_set);
    case Step::enable:
      return go(Step::enabled);
    case Step::released:
      return go(Step::working);
    case Step::target:
      return go(Step::target_set);
    case Step::start:
      return go(Step::working);
    case Step::stop:
      watched_from_ = now;
      return go(Step::standing);
    case Step::disable:
      return after_disable();
    case Step::set_back:
      return give_back();
    case Step::release:
      return go(Step::over);
    default:
      return;
  }
}

void ManualPlan::after_speed(Instant now) {
  note_dangers();
  const bool enabled = view_->has(AxisInput::enabled) && !view_->has(AxisInput::stop_latched);
  if (enabled && arguments_.task != ManualTask::enable) return after_enable(now);
  torque_is_ours_ = !view_->has(AxisInput::enabled);
  claim(now);
  write_command(Command::enable);
  go(Step::enable);
}

void ManualPlan::after_enable(Instant now) {
  if (arguments_.task == ManualTask::move) {
    write({.what = ManualWrite::What::target_position, .number = arguments_.turns});
    claim(now);
    return go(Step::target);
  }
  if (arguments_.task == ManualTask::jog) {
    write_button(button_.up(JogButton::Which::forward));
    write({.what = ManualWrite::What::coil, .coil = kJogReverse});
    return go(Step::released);
  }
  go(Step::working);
}

void ManualPlan::after_target(Instant now) {
  claim(now);
  write_command(arguments_.relative ? Command::move_relative : Command::move_absolute);
  motion_before_ = view_->motion_id;
  may_move_ = true;
  go(Step::start);
}

/// With "writes": "posted" its answer says only that it is on its way: what comes next must not act without it.
bool ManualPlan::settled(const ManualWrite& write, Instant now) {
  if (view_->result <= CommandResult::done) return view_->result != CommandResult::pending;
  refused_what_ = row_text(write);
  finish(1, why_refused(), now);
  return false;
}

void ManualPlan::button_answered(ModbusException exception, Instant now) {
  watched_from_ = now;
  button_.on_answer();
  if (exception == ModbusException::none || ending() || button_.held() == JogButton::Which::none) return;
  write_button(button_.release());
  // The gateway has ended this jog, or its axis is not ready for one: the next press is another one.
  if (exception == ModbusException::server_device_busy && view_ && !view_->anothers()) return;
  exception_ = exception;
  refused_what_ = "jog";
  go(Step::refused);
}

// Looks.

void ManualPlan::on_view(const ManualView& view, std::uint32_t answered, Instant now) {
  if (over()) return;
  view_ = view;
  // The cause of the fault that has ended it comes while it gives back what it has.
  const std::size_t unnamed = words_.find(cause_text(kNotKnown));
  if (unnamed != std::string::npos && view.has(AxisInput::fault))
    words_.replace(unnamed, cause_text(kNotKnown).size(), cause_text(view.error_code));
  stand_watch_.look(view.turns, now);
  if (view.mine() && view.lease_remaining_ms != 0) lease_ms_ = std::max(lease_ms_.value_or(0), view.lease_remaining_ms);
  const bool steps_wait = std::any_of(waiting_.begin(), waiting_.end(),
                                      [](const Waiting& w) { return w.write.what != ManualWrite::What::heartbeat; });
  if (answered != answered_ || steps_wait) return;  // it may be older than what was answered
  switch (step_) {
    case Step::look:
      return first_look(now);
    case Step::speed_set:
      if (settled(speed_write(rpm_), now)) after_speed(now);
      return;
    case Step::target_set:
      if (settled({.what = ManualWrite::What::target_position}, now)) after_target(now);
      return;
    case Step::enabled:
      if (view.has(AxisInput::enabled)) return after_enable(now);
      return watch(now);
    case Step::working:
      if (arguments_.task == ManualTask::jog && button_.held() == JogButton::Which::none && stands(now) &&
          now >= watched_from_ + kStill)
        may_move_ = false;
      return watch(now);
    case Step::refused:
      return lowers_speed() ? write_speed(now) : finish(1, why_refused(), now);
    case Step::standing:
      return stood(now);
    default:
      return;
  }
}

void ManualPlan::first_look(Instant now) {
  const ManualView& view = *view_;
  const std::string name = axis_text();
  if (!view.in_sight())
    return finish(1,
                  fmt::format("{} is out of reach (link {}): nothing was sent", name,
                              name_of(WordKind::link_state, static_cast<std::uint32_t>(view.link))),
                  now);
  if (view.has(AxisInput::fault) && view.error_code == kNotKnown) return;  // it is, at the next look or soon after
  if (view.has(AxisInput::fault))
    return finish(1,
                  fmt::format("{} has a fault, {}; command 5 resets it once its cause is gone", name,
                              cause_text(view.error_code)),
                  now);
  if (view.anothers())
    return finish(1,
                  fmt::format("{} is owned by {}: end that client, or let it release the axis (command 13)", name,
                              owner_text(view)),
                  now);
  const bool ready = view.has(AxisInput::enabled) && !view.has(AxisInput::stop_latched);
  if (!ready && arguments_.task != ManualTask::enable && !arguments_.enable)
    return finish(1,
                  fmt::format("{} is {}: --enable enables it for this {}", name,
                              view.has(AxisInput::enabled) ? "stopped and latched" : "disabled", text(arguments_.task)),
                  now);
  if (const std::string mistake = too_fast(); !mistake.empty()) return finish(1, mistake, now);
  speed_before_ = speed_shown();
  owned_before_ = view.mine();
  id_ = after(view.command_id_seen);
  write({.what = ManualWrite::What::command, .command = Command::none, .id = id_});
  go(Step::begin);
}

/// While it holds, moves or jogs.
void ManualPlan::watch(Instant now) {
  const ManualView& view = *view_;
  const std::string name = axis_text();
  if (!view.in_sight())
    return finish(1,
                  fmt::format("{} went out of reach (link {}); what it does is not known", name,
                              name_of(WordKind::link_state, static_cast<std::uint32_t>(view.link))),
                  now);
  if (view.has(AxisInput::fault))
    return finish(1, fmt::format("{} has a fault, {}", name, cause_text(view.error_code)), now);
  if (view.anothers()) {
    torque_is_ours_ = false;  // its new owner decides
    return finish(1, fmt::format("{} was taken over by {}", name, owner_text(view)), now);
  }
  if (lease_ms_ && !view.mine())
    return finish(1, fmt::format("the lease of {} ran out: the gateway has stopped it", name), now);
  // With "writes": "posted" the answer says only that it is on its way.
  const bool begins = step_ == Step::enabled || (arguments_.task == ManualTask::move && view.motion_id != id_);
  if (begins && view.command_id_seen == id_ && view.result == CommandResult::pending) return;
  if (begins && view.command_id_seen == id_ && view.result > CommandResult::done) {
    refused_what_ = step_ == Step::enabled ? text(Command::enable)
                    : arguments_.relative  ? text(Command::move_relative)
                                           : text(Command::move_absolute);
    return finish(1, why_refused(), now);
  }
  if (view.has(AxisInput::stop_latched) || !view.has(AxisInput::enabled))
    return finish(1, fmt::format("{} was stopped by another client, its lease or its drive", name), now);
  if (arguments_.task != ManualTask::move || step_ != Step::working) return;
  if (view.motion_id == id_)
    motion_before_ = id_;
  else if (view.motion_id == motion_before_)
    return;
  else
    return finish(1, fmt::format("the move of {} has ended: another motion took its place", name), now);
  if (view.motion == MotionState::completed) {
    // At its target it may still be told to turn: velocities are old by a filter's time. No stop is needed for that.
    may_move_ = false;
    words_ = "reached";
    reached_ = true;
    watched_from_ = now;
    stand_by_ = now + kStandLimit;
    return go(Step::standing);
  }
  if (view.motion == MotionState::aborted || view.motion == MotionState::failed)
    return finish(1,
                  fmt::format("the move of {} was {}: {}", name,
                              name_of(WordKind::motion_state, static_cast<std::uint32_t>(view.motion)),
                              manual_line(arguments_.axis, view, "")),
                  now);
}

bool ManualPlan::stands(Instant now) const {
  return view_ && view_->in_sight() && !view_->has(AxisInput::moving) && stand_watch_.still_for(now) >= kStill;
}

// Keys.

void ManualPlan::on_keys(const std::vector<ManualKey>& keys, Instant now) {
  for (const ManualKey key : keys) {
    if (step_ != Step::working || arguments_.task != ManualTask::jog) return;
    if (key == ManualKey::quit) return finish(0, fmt::format("{} is let go", axis_text()), now);
    const auto button = button_.on_key(key, now);
    if (button && button->on) {
      claim(now);
      may_move_ = true;
    }
    write_button(button);
  }
}

void ManualPlan::on_stall(Instant now) {
  write_button(button_.release());
  button_.ignore_keys_until(now + kKeyLapse);
}

// Time.

Instant ManualPlan::due() const {
  if (over()) return kNever;
  return std::min({stand_by_, beat_waits_ ? kNever : next_beat_, button_.due()});
}

void ManualPlan::on_time(Instant now) {
  if (over()) return;
  write_button(button_.on_time(now));
  if (now >= next_beat_ && !beat_waits_ && step_ != Step::release) {
    write({.what = ManualWrite::What::heartbeat, .id = ++beat_}, false);
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

}  // namespace axisgate::commands
