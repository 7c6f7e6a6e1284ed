// SPDX-License-Identifier: Apache-2.0
// How a command that moves an axis by hand ends: stopped, without torque where it had none, given back.
#include <fmt/format.h>

#include <algorithm>

#include "gateway/commands/manual/plan/manual_plan.hpp"

namespace axisgate::commands {

// The end.

void ManualPlan::end(std::string_view why, Instant now) {
  if (ending()) return;
  const bool held = arguments_.task == ManualTask::enable && step_ == Step::working && stands(now);
  const std::string_view what = !claimed_         ? " was asked for nothing"
                                : !held           ? " is stopped"
                                : torque_is_ours_ ? " is disabled"
                                                  : " is given back, enabled as it was found";
  finish(held ? 0 : 1, fmt::format("{}: {}{}", why, axis_text(), what), now);
}

void ManualPlan::end_at_once() {
  if (over()) return;
  words_ += (words_.empty() ? "" : "; ") + std::string("ended at once, without waiting for the axis");
  code_ = 1;
  go(Step::over);
}

void ManualPlan::lost(std::string_view why) {
  if (over()) return;
  code_ = 1;
  words_ = fmt::format("the gateway is out of reach ({})", why);
  if (claimed_)
    words_ += out_of_reach();
  else if (arguments_.task == ManualTask::stop && outbox_.empty())
    words_ += fmt::format("; whether {} was stopped is not known: use its wired stop", axis_text());
  step_ = Step::over;
}

/// Nobody here knows which of the two has failed, gateway or network.
std::string ManualPlan::out_of_reach() const {
  const std::string_view doing = arguments_.task == ManualTask::enable ? "keeps its torque" : "goes on";
  const std::uint16_t within = view_ ? view_->loss_stop_ms : kLossNotKnown;
  const std::string dead = within == kGoesOn ? fmt::format("{} GOES ON: use its wired stop", axis_text())
                           : within == kLossNotKnown
                               ? fmt::format("nobody knows whether {} stops: use its wired stop", axis_text())
                               : fmt::format("the drive begins to stop by itself within {} ms", within);
  const std::string cut = lease_ms_
                              ? fmt::format("{} is stopped as its lease says, within {} ms", axis_text(), *lease_ms_)
                              : fmt::format("{} {}, for it has no lease: only a stop ends that", axis_text(), doing);
  return fmt::format("\n  if the gateway has died: {}\n  if only the network has failed: {}", dead, cut);
}

void ManualPlan::refuse_number(Instant now) {
  waiting_.pop_back();
  fail(fmt::format("{} does not fit its register, in the units of {}",
                   step_ == Step::speed ? fmt::format("{} rpm", rpm_.to_double())
                                        : fmt::format("{} turns", arguments_.turns.to_double()),
                   axis_text()),
       now);
}

void ManualPlan::fail(std::string_view why, Instant now) {
  if (!ending()) return finish(1, std::string(why), now);
  // A stop has nothing left to do where its axis cannot be seen; any other end has its own limit of time.
  if (arguments_.task != ManualTask::stop || over()) return;
  code_ = 1;
  if (words_.empty()) words_ = why;
  go(Step::over);
}

void ManualPlan::finish(int code, std::string words, Instant now) {
  code_ = code;
  words_ = std::move(words);
  write_button(button_.release());
  // What was asked for before is none of the end's steps.
  for (Waiting& waiting : waiting_) waiting.of_step = false;
  stand_by_ = now + kStandLimit;
  // An enabled axis that turns is stopped whoever made it turn; one that another client owns as well.
  const bool enabled_and_turns = claimed_ && !stands(now);
  if (!may_move_ && !enabled_and_turns) return after_stop();
  write({.what = ManualWrite::What::stop, .command = Command::quick_stop});
  go(Step::stop);
}

void ManualPlan::stood(Instant now) {
  if (view_->in_sight() && (!stands(now) || now < watched_from_ + kStill)) return;
  may_move_ = false;
  if (arguments_.task == ManualTask::stop) {
    stand_by_ = kNever;
    const bool known = view_->in_sight();
    code_ = std::max(code_, known ? 0 : 1);
    if (words_.empty())
      words_ = known ? "stopped: " + manual_line(arguments_.axis, *view_, "")
                     : fmt::format("{} is out of reach: what it does is not known", axis_text());
    return go(Step::over);
  }
  if (code_ == 0) words_ += ": " + manual_line(arguments_.axis, *view_, "");
  after_stop();
}

void ManualPlan::after_stop() {
  stand_by_ = kNever;
  if (!torque_is_ours_) return after_disable();
  torque_is_ours_ = false;
  write({.what = ManualWrite::What::stop, .command = Command::disable});
  go(Step::disable);
}

void ManualPlan::after_disable() {
  stand_by_ = kNever;
  if (!claimed_ || arguments_.task == ManualTask::stop || (view_ && view_->anothers())) return go(Step::over);
  const bool another = speed_set_ && speed_before_ && speed_before_->numerator() > 0 && *speed_before_ != rpm_;
  // A motor that was not seen to stand may still move at the speed that is set.
  if (!another || may_move_) return give_back();
  write(speed_write(*speed_before_));
  go(Step::set_back);
}

void ManualPlan::give_back() {
  if (owned_before_) return go(Step::over);
  write_command(Command::release);
  go(Step::release);
}

}  // namespace axisgate::commands
