// SPDX-License-Identifier: Apache-2.0
// What commands do, and what they are answered with (3.4).
#include <algorithm>
#include <cstdlib>

#include "tests/model/judge.hpp"

namespace axisgate::test::reference {
namespace {

constexpr std::int64_t kJustBegunMs = 1100;  // over CANopen the end of a move is told up to 1 s late

}  // namespace

// It was accepted, and cannot have ended: whether it is seen to turn already is no matter.
bool Judge::is_under_way() const {
  if (world_.awaits != 0 || !world_.pending.empty() || seen_.troubled || world_.broken || world_.held) return false;
  const Motion motion = world_.motion();
  return motion.kind == Motor::moves ? std::abs(motion.value - seen_.position) > kClose
                                     : motion.kind == Motor::runs && motion.value != 0;
}

bool Judge::start_refused(std::int64_t command, Verdict& verdict) {
  if (refuse_foreign(verdict)) return true;
  // 3.4: "they need an axis that is enabled, not faulted and not stop-latched".
  if (world_.adopted && readings_.other()) {
    verdict = {"refused: found enabled after a loss", {4}};
    return true;
  }
  if (!world_.enabled || world_.latched || (world_.faulted && !options_.by_gateway)) {
    // A stop that has not shown yet keeps it waiting, and then it has not started in time.
    verdict = {"refused: not enabled, faulted or latched", {4, 6}};
    // 3.5: "from its first accepted write": what is refused claims nothing. A fault that the gateway has not heard of
    // yet, a stop on its way, or what it could not see, may make the drive refuse what was accepted.
    const bool unseen = world_.faulted || seen_.troubled ||
                        std::ranges::any_of(world_.pending, [](const auto& each) { return each.second.verdict.stop; });
    if (world_.faulted && seen_.troubled) verdict.answers.insert(0);  // the drive has acknowledged it all the same
    if (unseen && world_.owner != client_ && options_.leases && readings_.other()) claim();
    return true;
  }
  // 3.4, command 7: "at standstill; while moving 0x06".
  // A move to where it is already is not over before the drive has said so.
  const bool just_begun = seen_.now_ms - world_.started_ms < kJustBegunMs;
  const bool under_way =
      world_.motor == Motor::moves && (just_begun || std::abs(world_.target - seen_.position) > kClose);
  if (command == 7 && (just_begun || !seen_.stands || world_.motor == Motor::runs || world_.motor == Motor::unknown ||
                       !seen_.clear || under_way)) {
    const bool unsure = changes_mode_ || (!is_under_way() && (seen_.stands || !seen_.clear));
    if (!unsure || readings_.other()) {
      verdict = {"refused: relative while moving", {6}};
      for (ClientMemory& client : world_.clients) client.command.ended = true;
      return true;
    }
  }
  // 3.4, command 4: whether a halt that is held by coil 3 keeps starts away is not said.
  if (world_.held && readings_.other()) {
    verdict = {"refused: held by coil 3", {4, 6}};
    return true;
  }
  return false;
}

/// 3.4 Owed stops: "An owed halt becomes quick_stop if the drive restarted, was lost for over 1 s, or its state ... is
/// not certain."
bool Judge::may_have_no_halt() const {
  const bool elsewhere = options_.both_modes || changes_mode_ || world_.mode != kVelocityMode;
  return (options_.no_halt && elsewhere) || world_.other_mode || seen_.troubled;
}

// 3.4, command 4: "Where a drive has no halt, the profile names the replacement".
void Judge::halted(bool asserted) {
  stopped(asserted);
  if (!may_have_no_halt() || !readings_.other()) return;
  world_.latched = true;
  world_.latch_unsure = seen_.troubled;
  world_.enabled = false;
  world_.ladder = 0;
}

void Judge::speed_accepted() {
  world_.stale_speed = seen_.troubled;  // what ends in trouble nobody outside knows
  world_.surely_stale = false;
  speed_here_ = true;
}

// 3.3 What asks: "the last accepted set-point is the one that every start uses"; 3.4: after a stop "velocity, torque
// and start are needed anew". Where none came since, a raw word runs at that or at 0.
void Judge::renew_speed() {
  if (world_.stale_speed && readings_.other()) world_.accepted[row::target_velocity] = 0;
  world_.stale_speed = world_.surely_stale = false;
}

/// It stands, and nothing is under way.
bool Judge::at_rest() const {
  return seen_.stands && seen_.clear && !seen_.troubled && world_.motor == Motor::stands && world_.earlier.empty() &&
         !world_.broken && !world_.adopted && !world_.held && world_.awaits == 0 && world_.pending.empty();
}

// 3.3 What asks: "the last accepted set-point is the one that every start uses": the speed of a move (MOVE-17). A
// homing has speeds of its own.
std::int64_t Judge::fastest_of(std::int64_t start) const {
  if (!seen_.stands || !seen_.clear || seen_.troubled || !world_.earlier.empty()) return kNever;
  if (start == kHome) return options_.homing_speed;
  const auto speed = world_.accepted.find(row::profile_velocity);
  return start > kRelative || speed == world_.accepted.end() ? kNever : speed->second;
}

void Judge::command(std::int64_t number, Item& item, Verdict& verdict) {
  if (is_start(number)) {
    // 3.3, the fixed order of one request: its set-points act before it starts.
    const std::int64_t fastest = fastest_of(number);
    const bool homes = number == kHome && at_rest() && world_.accepted.contains(row::homing_method);
    leave_motion();
    // Commands 9 and 10 need what is not judged here: a known max_velocity, a homing method since bring-up. Whether one
    // was refused before it claimed, or by the drive, is not judged either.
    // G1: "a start whose target does not hold is refused"; whether one that came beside a stop holds is not said.
    const bool no_target = number == kRun && (world_.stale_speed || !world_.accepted.contains(row::target_velocity)) &&
                           (world_.surely_stale || readings_.other());
    const bool refused = no_target || (number > kRun && !homes && readings_.other());
    if (!refused || world_.owner == client_ || readings_.other()) claim();
    // 3.3 Not new: "or another client".
    for (std::size_t c = 0; c < world_.clients.size(); ++c) {
      if (c == client_) continue;
      world_.clients[c].command.ended = true;
      for (Item& coil : world_.clients[c].coils) coil.ended = true;
    }
    item.changed = item.ended = item.spoilt = item.refused = false;
    item.acted = true;
    // 3.4: "Commands 6 to 11 select the mode they need and wait for it".
    world_.mode.reset();
    if (refused) {
      verdict = {"refused: command " + std::to_string(number), {3, 4, 6}};
      item.refused = true;
      // 3.3: "what was done stays done": whether its mode was taken from a jog is not known.
      if (world_.jog == 0 || !readings_.other()) return;
      leave_motion();
      world_.motor = Motor::stands;
      world_.jog = 0;
      world_.started_ms = seen_.now_ms;
      return;
    }
    world_.raw_mode.reset();
    if (number <= kRun) world_.mode = number == kRun ? kVelocityMode : kPositionMode;
    world_.speed_mode = number == kRun;
    world_.other_mode = number > kRun;
    world_.jog = 0;
    world_.start_bit = true;
    world_.started_ms = seen_.now_ms;
    // 3.3 What asks: "the last accepted set-point is the one that every start uses".
    const auto of = [&](std::uint16_t offset) {
      return world_.accepted.contains(offset) ? world_.accepted[offset] : std::int64_t{0};
    };
    world_.motor = number > kRun ? Motor::unknown : number == kRun ? Motor::runs : Motor::moves;
    if (number == kRun) world_.stale_speed = world_.surely_stale = false;
    if (number == 6) world_.target = of(row::target_position);
    if (number == 7) world_.target = seen_.position + of(row::target_position);
    // What a gateway that is new reads from the drive nobody has accepted.
    if (number != kRun && !world_.accepted.contains(row::target_position)) world_.motor = Motor::unknown;
    verdict = {"acts: command " + std::to_string(number), {0}};
    verdict.starts = true;
    world_.fastest = fastest;
    return;
  }
  if (number == kTakeOver) return take_over(verdict);
  if (!is_stop(number) && refuse_foreign(verdict)) {
    item.refused = true;
    return;
  }
  if (number == kSetPosition) return set_position(verdict);
  if (number == 1) {
    // A Keya's watchdog trip is over with the next command (keya-kydas4860-2e.md); it is shown as disabled.
    const bool refused = world_.faulted && (!options_.by_gateway || readings_.other());
    // A fault that the gateway has heard of refuses it, and then it claims nothing.
    if (!refused || world_.owner == client_ || readings_.other()) claim();
    // Whether an enable ends what another client has begun (3.3 Not new) is not said.
    for (ClientMemory& client : world_.clients) {
      client.command.ended = true;
      for (Item& coil : client.coils) coil.ended = true;
    }
    if (refused) {
      verdict = {"enable while faulted", {4, 6}};
      if (seen_.troubled) verdict.answers.insert(0);  // it was enabled, and the gateway has not heard of the fault
      world_.latch_unsure = true;                     // whether one that fails is "accepted after the stop" is not said
      item.refused = true;
      return;
    }
    world_.enable_asked_ms = seen_.now_ms;
    // 3.4, command 1: "Already enabled: nothing is sent. Clears the stop latch".
    const bool was = world_.enabled && !world_.latched;
    if (!was && (!seen_.stands || !seen_.clear) && readings_.other()) {
      verdict = {"enable while it still turns: not reached", {4, 6, 11}};
      return;
    }
    if (!was) world_.motor = Motor::stands;
    if (!was) world_.started_ms = seen_.now_ms;  // what a drive shows of standing still lags behind
    world_.enabled = true;
    world_.adopted = false;
    world_.latched = false;
    world_.held = world_.held && readings_.other();
    world_.ladder = 15;
    item.changed = item.ended = item.spoilt = item.refused = false;
    verdict = {"acts: enable", {0}};
    return;
  }
  if (is_stop(number)) {
    stopped(true);
    // A raw step in the same request may count as one out of the latch, or not.
    if (number == 2) world_.enabled = false, world_.ladder = readings_.other() ? world_.ladder : 0;
    // 3.4, command 4: "Where a drive has no halt, the profile names the replacement".
    if (number == 4 && may_have_no_halt() && readings_.other())
      world_.latched = true, world_.enabled = false, world_.ladder = 0;
    if (number == 3) world_.latched = true, world_.enabled = false, world_.ladder = 0;
    verdict = {"acts: stop " + std::to_string(number), {0}};
    return;
  }
  // 3.5 lists what claims: registers 40 to 79, coils 4 to 9, coil 0.
  if (number == 5 && &item == &me().command) claim();
  if (number == 5 && reset_fault(verdict)) return;
  if (number == 5) {
    verdict = {"fault_reset without a fault", {0}};
    return;
  }
  // 3.4, command 13: "gives the lease back". Of an axis that is enabled the lease stays, open to all (3.5: only so is
  // it never without one).
  if (number == kRelease) {
    if (world_.retaken && readings_.other()) {
      world_.orphan = true;
      verdict = {"release of what its former connection owns", {6}};
      return;
    }
    if (world_.owner == client_) {
      world_.owner.reset();
      world_.orphan = false;
      world_.lease_until(world_.enabled ? seen_.now_ms + options_.lease_ms : kNever);
    }
    verdict = {"acts: release", {0, 6}};  // of one that does not own it
    return;
  }
  // 3.4, command 12: "only disabled, else 0x06". Whether latched or faulted is disabled is not said.
  if (number == kSave && (world_.enabled || ((world_.latched || world_.faulted) && readings_.other()))) {
    verdict = {"save_parameters: not disabled", {6}};
    item.refused = true;
    return;
  }
  claim();
  verdict = {"acts: command " + std::to_string(number), {0}};
}

// 3.5: "command 14 takes a lease from a lower rank"; 3.4: "after a halt"; 3.5 Signs of life: between connections of one
// address it needs no rank.
void Judge::take_over(Verdict& verdict) {
  verdict = {"take_over", {0}};
  if (!options_.leases || !world_.owner || *world_.owner == client_) {
    verdict.answers.insert(6);  // of what nobody else owns nothing is said
    if (readings_.other()) claim();
    return;
  }
  const std::size_t owner = *world_.owner % kGhost;
  if (is_dds(owner) || is_dds(client_)) {
    // 3.5 speaks of ranks in `allow`; what a DDS writer's is, is not said.
    if (!readings_.other()) {
      verdict = {"take_over of or from a DDS writer", {6}};
      return;
    }
  } else if (options_.address_of(owner) != options_.address_of(client_) &&
             options_.ranks.at(client_) <= options_.ranks.at(owner)) {
    verdict = {"take_over from no lower rank", {6}};
    return;
  }
  verdict.answers.insert(6);  // what stands beside it may be refused before it is carried out
  if (world_.enabled && !world_.latched && (world_.motor != Motor::stands || readings_.other())) halted(true);
  // "After a halt": until it is answered nobody can tell whose the axis is.
  takes_over_ = readings_.other();
  if (!takes_over_) claim();
}

// 3.4, command 11: "the position becomes set_position_value ..., at standstill, else 0x06".
void Judge::set_position(Verdict& verdict) {
  // Not each drive can do it in each state, and one that stands for us may be under way for itself.
  if ((!seen_.stands && seen_.clear) || readings_.other()) {
    verdict = {"refused: set_position", {3, 4, 6}};
    me().command.refused = true;
    if (readings_.other()) claim();
    // 3.3: "it stops at the first failure": a stop may have found it behind the drive's other mode.
    world_.other_mode = world_.other_mode || readings_.other();
    return;
  }
  claim();
  world_.mode.reset();
  world_.other_mode = true;  // some drives take it in a mode of its own
  verdict = {"acts: set_position", {0}};
  // A raw run that its own request has begun.
  if (world_.motor == Motor::runs) {
    world_.motor = Motor::unknown;
    return;
  }
  world_.motor = Motor::stands;
  if (world_.accepted.contains(row::set_position_value)) verdict.position = world_.accepted[row::set_position_value];
}

// A row of what a program sets once, alone.
Verdict Judge::parameter(std::uint16_t offset, std::int64_t value) {
  Verdict verdict{"a parameter", {0}};
  me().rows[offset] = value;
  if (!options_.parameters.contains(offset)) return {"a row that the drive has not", {2}};  // 3.3 Outcomes
  if (!refuse_foreign(verdict)) claim();
  return verdict;
}

// 3.4, command 5: "clears, never enables: the axis ends disabled". Whether its cause is gone the drive alone knows.
bool Judge::reset_fault(Verdict& verdict) {
  if (!world_.faulted) return false;
  if (readings_.other()) {
    verdict = {"fault_reset: not reached", {4}};
    return true;
  }
  world_.faulted = false;
  verdict = {"fault_reset", {0}};
  return true;
}

// 3.3 Not new: "A single write that is not new in one of these ways is answered with exception 0x06 each time".
void Judge::answer_not_new(std::int64_t number, const Item& item, Verdict& verdict) {
  verdict = {"not new", {0}};
  if (foreign()) {
    verdict.answers = {0, 6};
    return;
  }
  if (!is_start(number) && number != 1) {
    // What was only remembered, and has nothing to do: whether that is "so already" is not said.
    if (!is_stop(number) && (item.ended || item.spoilt || !item.acted)) verdict.answers = {0, 6};
    return;
  }
  if (item.refused) {
    verdict.answers = {0, 4, 6};  // what a repeated refusal is answered with is not said
    return;
  }
  // "A single write that asks for what is so already ... is answered normally."
  const bool same_target = number == 6 && world_.motor == Motor::moves &&
                           world_.accepted.contains(row::target_position) &&
                           world_.accepted[row::target_position] == world_.target;
  // It was only remembered: 3.3 Not new does not say what a single write that repeats it is answered with. And a start
  // that was refused may be tried again at once: 0x04, as it may be told that it is not new.
  if (is_start(number) && (!item.acted || world_.motor == Motor::unknown))
    verdict = {"not new, only remembered before", {0, 4, 6}};
  else if (number == 7)
    verdict = {"not new, relative: 0x06", {4, 6}};
  else if (number == 1 && seen_.now_ms - world_.enable_asked_ms < kUnderWayMs)
    verdict.answers = {0, 6};
  else if (number == 1)
    verdict.answers = world_.enabled && !world_.latched && !world_.adopted ? std::set<int>{0} : std::set<int>{0, 6};
  else if (item.ended)
    verdict = {"not new, perhaps ended by a stop: 0x06", {0, 6}};
  else if (item.changed)
    verdict = {"not new, target changed: 0x06", same_target || number == 8 ? std::set<int>{0, 6} : std::set<int>{6}};
}

}  // namespace axisgate::test::reference
