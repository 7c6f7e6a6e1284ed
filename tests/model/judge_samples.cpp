// SPDX-License-Identifier: Apache-2.0
// What DDS writers ask (design 4): samples of axis_command.
#include "tests/model/judge.hpp"

namespace axisgate::test::reference {

// Design 4: "Every request gets its one reply"; each sample is new, and what its mask names asks.
Verdict Judge::sample(const Write& write) {
  Verdict verdict{"a sample", {0}};
  const std::int64_t number = write.sample.contains(row::command) ? write.sample.at(row::command) : 0;
  const bool jogs = number >= kJogForward;
  // Design 4: "request ids seen in the last 10 s are answered as already seen, not run again".
  if (seen_before_ == SeenBefore::yes || (seen_before_ == SeenBefore::perhaps && readings_.other()))
    return {"seen before", {kAlreadySeen}};
  // Design 4, age: what is too old "or as far ahead gets result 6 and is not carried out"; which gateway: "commands
  // need an exact match"; "Stops, jog_end and release are never refused for age or name".
  const bool flawed = write.flaw != Flaw::none;
  if (write.flaw == Flaw::half && !lets_go(number)) return {"not surely for this gateway", {3}};
  if (flawed && !lets_go(number)) return {"too old, or too far ahead: never started", {6}};
  if (number == kTakeOver && options_.leases && write.sample.size() > 1 && readings_.other()) return refused_whole();
  changes_mode_ = write.sample.contains(row::mode);
  const bool refused = is_start(number) && start_refused(number, verdict);
  const bool claims = !options_.leases || !takes_no_lease(number) || readings_.other();
  // 3.3 What asks: "Set-points beside a command that is refused are accepted only if they would be without it": whether
  // that speaks of samples is not said.
  // Whether commands 9 to 11 will be refused is not known here.
  const bool will_be = number > kRun && number <= kSetPosition && readings_.other();
  // A button that is held tells the same velocity again and again: whether that asks for it is not said.
  const auto told_again = [&](std::uint16_t offset, std::int64_t value) {
    const bool held = jogs && world_.pressed.at(client_ - kModbus) != 0;
    return held && world_.accepted.contains(offset) && world_.accepted[offset] == value;
  };
  if (!flawed && ((!refused && !will_be) || readings_.other()))
    for (const auto& [offset, value] : write.sample)
      if (offset != row::command && options_.rows.contains(offset))
        accept(offset, value, claims && (!told_again(offset, value) || readings_.other()));
  verdict.acts = number != 0;
  if (jogs)
    jog_sample(number, verdict);
  else if (number != 0 && !refused)
    command(number, me().command, verdict);
  if (flawed) verdict.answers.insert(6);  // of what stands beside it
  tell_foreign(verdict);
  me() = {};
  return verdict;
}

// Design 4: "jog with the same deadline". The IDL: "It is a button: once a jog has ended, jog_end comes before the next
// one."
void Judge::jog_sample(std::int64_t number, Verdict& verdict) {
  std::int64_t& pressed = world_.pressed.at(client_ - kModbus);
  const std::int64_t direction = number == kJogForward ? 1 : -1;
  const bool mine = world_.jog != 0 && world_.jog_client == client_;
  if (number == kJogEnd) {
    pressed = 0;
    stopped_ = true;
    verdict = {"jog_end", {0}};
    // Whether it ends a jog of another client, or another motion, is not said.
    if (mine || (world_.motor != Motor::stands && readings_.other())) halted(false);
    return;
  }
  if (pressed != direction) {
    begin_jog(direction, verdict);
    // Whether one that was refused must be let go first is not said.
    const bool surely = verdict.answers == std::set{0} && !verdict.any_answer && !seen_.troubled;
    pressed = surely || readings_.other() ? direction : 0;
    return;
  }
  if (refuse_foreign(verdict)) return;
  if (mine && world_.jog == direction) {
    world_.jog_ends_ms = seen_.now_ms + options_.jog_timeout_ms;
    claim();
    return;
  }
  verdict = {"a jog that has ended: jog_end first", {0, 4, 6}};
  if (readings_.other()) claim();  // whether it asks for anything is not said
}

}  // namespace axisgate::test::reference
