#include "tests/obey/judge.hpp"

#include <algorithm>
#include <cstdlib>

namespace axisgate::test::obey {
namespace {

constexpr std::int64_t kJustBegunMs = 250;
constexpr std::int64_t kRearmMs = 1000, kRearmUnsureMs = 150;
constexpr std::array<std::uint16_t, 11> kZeroLeaves{41, 47, 48, 50, 52, 58, 62, 64, 66, 70, 76};  // A6

bool is_stop(std::int64_t command) { return command >= 2 && command <= 4; }  // A2

}  // namespace

// A1, A2: what is new, of a command without id, a controlword or an edge coil.
Judge::Edge Judge::edge(Item& item, std::int64_t value, bool single, bool stop) {
  const std::optional<std::int64_t> before = item.value;
  const std::int64_t quiet = seen_.now_ms - item.written_ms;
  item.value = value;
  item.written_ms = seen_.now_ms;
  // A2: "One acts if the command or the id differs from what is remembered, on an empty memory too, and in a single
  // write always."
  if (stop) return single || before != value ? Edge::acts : Edge::not_new;
  // A1: "new if it differs from the command remembered; a single write also on an empty memory ... A block write on an
  // empty memory only remembers."
  if (!before) return single ? Edge::acts : Edge::remembered;
  if (*before != value) return Edge::acts;
  // A1: "and when this client has not written it for rearm_ms, but not after another client's stop ... since it acted".
  // A1 lets a controlword that another's stop has spoilt not act, and so a stop: the reading that stops is allowed too.
  const bool stop_word = (value & 6) != 6 || (value & 15) == 6 || (value & 15) == 7;
  if (single && item.spoilt && &item == &me().controlword && stop_word && readings_.other()) return Edge::acts;
  if (!single || item.spoilt || quiet < kRearmMs - kRearmUnsureMs) return Edge::not_new;
  if (quiet < kRearmMs + kRearmUnsureMs && readings_.other()) return Edge::not_new;
  return Edge::acts;
}

Judge::Edge Judge::command_edge(const Rows& rows, bool single) {
  if (!rows.contains(row::command)) return Edge::absent;  // A1: "Register 55 alone asks for nothing"
  const std::int64_t value = rows.at(row::command);
  const std::int64_t id = rows.contains(row::command_id) ? rows.at(row::command_id) : 0;
  ClientMemory& mine = me();
  const std::optional<std::int64_t> before = mine.command.value;
  const std::optional<std::int64_t> last_id = mine.id;
  Edge edge = Edge::not_new;
  if (id == 0) {
    edge = this->edge(mine.command, value, single, is_stop(value));
  } else {
    mine.id = id;  // A1: "zeros never erase it", "Command 0 with an id sets the last id"
    mine.command.value = value;
    mine.command.written_ms = seen_.now_ms;
    if (is_stop(value))
      edge = before != value || last_id != id ? Edge::acts : Edge::not_new;  // A2
    else if (!last_id)
      edge = Edge::remembered;  // A1: "Where none is kept, the pair is only remembered"
    else
      edge = *last_id != id ? Edge::acts : Edge::not_new;  // A1: "only the id decides"
  }
  return value == 0 && edge != Edge::remembered ? Edge::nothing : edge;
}

// 3.5, A7: "A write claims an axis only if it asks for something."
void Judge::claim() {
  if (options_.leases) world_.owner = client_;
}

void Judge::accept(std::uint16_t offset, std::int64_t value) {
  claim();
  const auto old = world_.accepted.find(offset);
  const bool differs = old == world_.accepted.end() || old->second != value;
  world_.accepted[offset] = value;
  if (offset == row::target_velocity) world_.stale_speed = false;
  if (differs && (offset == row::target_position || offset == row::target_velocity)) {
    me().command.changed = true;
    for (Item& coil : me().coils) coil.changed = true;
  }
  // 3.3: a mode that changes under a motion; 3.4 does not say what becomes of that.
  if (offset == row::mode) {
    world_.raw_mode = value;
    if (world_.motor != Motor::stands) world_.motor = Motor::unknown;
  }
  // 3.4: "target_velocity acts at once only while commands 8, 9 or raw modes 3 ... run". Whether an axis enabled in
  // mode 3 by command 1, or halted in it, is one that runs is not said.
  const bool could_run = world_.enabled && !world_.latched && world_.raw_mode == 3;
  const bool speed = world_.accepted.contains(row::target_velocity) && world_.accepted[row::target_velocity] != 0;
  if (could_run && speed && world_.motor == Motor::stands && readings_.other()) world_.motor = Motor::runs;
}

// A7.
void Judge::setpoints(const Rows& rows, bool single, Edge command, Edge controlword, bool refused) {
  const int carried = (command != Edge::absent ? 1 : 0) + (controlword != Edge::absent ? 1 : 0);
  const int empty = (command == Edge::remembered ? 1 : 0) + (controlword == Edge::remembered ? 1 : 0);
  // "On an empty memory a block that carries 40 or 54 only remembers its set-points." Where one of the two is empty and
  // the other is not, the sentence can be read both ways.
  const bool only_remembers = !single && empty > 0 && (empty == carried || readings_.other());
  const bool acts = (command == Edge::acts && !refused) || controlword == Edge::acts;
  for (const auto& [offset, value] : rows) {
    if (offset == row::controlword || offset == row::command || offset == row::command_id) continue;
    if (!options_.rows.contains(offset)) continue;
    const auto last = me().rows.find(offset);
    const bool differs = last == me().rows.end() || last->second != value;
    me().rows[offset] = value;
    const auto now = world_.accepted.find(offset);
    const bool other_value = now == world_.accepted.end() || now->second != value;
    bool asks = single || differs || acts;
    // "or if this client owns the axis and the value last accepted differs"; not with "lease": null. A lease may have
    // run out while the axis was disabled (A8).
    if (!asks && options_.leases && world_.owner == client_ && other_value) asks = world_.enabled || !readings_.other();
    if (only_remembers) asks = false;
    if (asks) accept(offset, value);
  }
}

void Judge::stopped(bool asserted) {
  world_.motor = Motor::stands;  // 3.4: "a stop end[s] every motion for good"
  world_.stale_speed = true;
  for (std::size_t c = 0; c < world_.clients.size(); ++c) {
    // A1 speaks of "another client's stop"; whether a disabling coil or controlword is one (A2: "nothing else") is
    // open.
    const bool spoils = c != client_ && (asserted || readings_.other());
    const auto mark = [&](Item& item) {
      item.ended = true;
      item.spoilt = item.spoilt || spoils;
    };
    mark(world_.clients[c].command);
    mark(world_.clients[c].controlword);
    for (Item& coil : world_.clients[c].coils) mark(coil);
  }
}

bool Judge::start_refused(std::int64_t command, Verdict& verdict) {
  // 3.4: "they need an axis that is enabled, not faulted and not stop-latched".
  if (!world_.enabled || world_.latched) {
    // A stop that has not shown yet keeps it waiting, and then it has not started in time.
    verdict = {"refused: not enabled, or latched", {4, 6}};
    return true;
  }
  // 3.4, command 7: "at standstill; while moving 0x06".
  // A move to where it is already is not over before the drive has said so.
  const bool just_begun = seen_.now_ms - world_.started_ms < kJustBegunMs;
  const bool under_way =
      world_.motor == Motor::moves && (just_begun || std::abs(world_.target - seen_.position) > kClose);
  if (command == 7 && (just_begun || !seen_.stands || world_.motor == Motor::runs || !seen_.clear || under_way)) {
    const bool unsure = seen_.stands || !seen_.clear;
    if (!unsure || readings_.other()) {
      verdict = {"refused: relative while moving", {6}};
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

// 3.4, command 4: "Where a drive has no halt, the profile names the replacement".
void Judge::halted(bool asserted) {
  stopped(asserted);
  if (!options_.no_halt || !readings_.other()) return;
  world_.latched = true;
  world_.enabled = false;
  world_.ladder = 0;
}

// A7: "the last accepted set-point is the one that every start uses"; 3.4: after a stop "velocity, torque and start are
// needed anew". Where none came since, both are allowed.
void Judge::renew_speed() {
  if (world_.stale_speed && readings_.other()) world_.accepted[row::target_velocity] = 0;
  world_.stale_speed = false;
}

void Judge::command(std::int64_t number, Item& item, Verdict& verdict) {
  if (is_start(number)) {
    claim();
    // A3: "or another client".
    for (std::size_t c = 0; c < world_.clients.size(); ++c) {
      if (c == client_) continue;
      world_.clients[c].command.ended = true;
      for (Item& coil : world_.clients[c].coils) coil.ended = true;
    }
    item.changed = item.ended = item.spoilt = item.refused = false;
    item.acted = true;
    world_.raw_mode.reset();
    world_.start_bit = true;
    world_.started_ms = seen_.now_ms;
    // A7: "the last accepted set-point is the one that every start uses".
    const auto of = [&](std::uint16_t offset) {
      return world_.accepted.contains(offset) ? world_.accepted[offset] : std::int64_t{0};
    };
    world_.motor = number == 8 ? Motor::runs : Motor::moves;
    if (number == 8) renew_speed();
    if (number == 6) world_.target = of(row::target_position);
    if (number == 7) world_.target = seen_.position + of(row::target_position);
    verdict = {"acts: command " + std::to_string(number), {0}};
    return;
  }
  if (number == 1) {
    claim();
    // 3.4, command 1: "Already enabled: nothing is sent. Clears the stop latch".
    const bool was = world_.enabled && !world_.latched;
    if (!was && (!seen_.stands || !seen_.clear) && readings_.other()) {
      verdict = {"enable while it still turns: not reached", {4, 6, 11}};
      return;
    }
    if (!was) world_.motor = Motor::stands;
    if (!was) world_.started_ms = seen_.now_ms;  // what a drive shows of standing still lags behind
    world_.enabled = true;
    world_.latched = false;
    world_.held = world_.held && readings_.other();
    world_.ladder = 15;
    item.changed = item.ended = item.spoilt = item.refused = false;
    verdict = {"acts: enable", {0}};
    return;
  }
  if (is_stop(number)) {
    stopped(true);
    if (number == 2) world_.enabled = false, world_.ladder = 0;
    // 3.4, command 4: "Where a drive has no halt, the profile names the replacement".
    if (number == 4 && options_.no_halt && readings_.other())
      world_.latched = true, world_.enabled = false, world_.ladder = 0;
    if (number == 3) world_.latched = true, world_.enabled = false, world_.ladder = 0;
    verdict = {"acts: stop " + std::to_string(number), {0}};
    return;
  }
  claim();
  verdict = {"acts: command " + std::to_string(number), {0}};  // 5 on an axis without a fault: nothing is sent
}

// A3: "A single write that is not new in one of these ways is answered with exception 0x06 each time".
void Judge::answer_not_new(std::int64_t number, const Item& item, Verdict& verdict) {
  verdict = {"not new", {0}};
  if (!is_start(number) && number != 1) return;
  if (item.refused) {
    verdict.answers = {0, 4, 6};  // what a repeated refusal is answered with is not said
    return;
  }
  // "A single write that asks for what is so already ... is answered normally."
  const bool same_target = number == 6 && world_.motor == Motor::moves &&
                           world_.accepted.contains(row::target_position) &&
                           world_.accepted[row::target_position] == world_.target;
  // It was only remembered: A3 does not say what a single write that repeats it is answered with. And a start that was
  // refused may be tried again at once: 0x04, as it may be told that it is not new.
  if (is_start(number) && !item.acted)
    verdict = {"not new, only remembered before", {0, 4, 6}};
  else if (number == 7)
    verdict = {"not new, relative: 0x06", {4, 6}};
  else if (number == 1)
    verdict.answers = world_.enabled && !world_.latched ? std::set<int>{0} : std::set<int>{0, 6};
  else if (item.ended)
    verdict = {"not new, perhaps ended by a stop: 0x06", {0, 4, 6}};
  else if (item.changed)
    verdict = {"not new, target changed: 0x06", same_target || number == 8 ? std::set<int>{0, 6} : std::set<int>{6}};
}

bool Judge::controlword(std::int64_t value, Verdict& verdict) {
  verdict = {"acts: controlword " + std::to_string(value), {0}, true};
  const std::int64_t step = value & 15;
  const bool start = (value & 16) != 0;
  claim();
  if (step == 15 && !world_.enabled) {
    // 3.4: the latch lasts until "controlword 6 or 7 and then 15". From 6 straight to 15 drives differ, and what a
    // disable or a quick stop leaves is the drive's affair.
    if (world_.latched && world_.ladder == 0) {
      verdict = {"refused: controlword 15 while latched, without 6 or 7", {4}};
      return false;
    }
    if (world_.ladder != 7 && readings_.other()) return true;
    world_.enabled = true;
    world_.latched = false;
    world_.ladder = 15;
    world_.start_bit = start;
    world_.motor = Motor::stands;
    if (world_.accepted.contains(row::mode) && world_.accepted[row::mode] == 3) {
      world_.raw_mode = 3;
      world_.motor = Motor::runs;  // 3.4: raw mode 3 runs
      renew_speed();
    }
    if (start) world_.motor = Motor::unknown;
    return true;
  }
  if (step == 15) {
    const bool rising = start && !world_.start_bit;
    const bool maybe = start && world_.start_bit;  // the gateway's own words set bit 4 as they like
    world_.start_bit = start;
    const bool position = world_.accepted.contains(row::mode) && world_.accepted[row::mode] == 1;
    if (position && (rising || (maybe && readings_.other()))) {
      world_.motor = world_.held ? Motor::unknown : Motor::moves;
      world_.target = world_.accepted.contains(row::target_position) ? world_.accepted[row::target_position] : 0;
    }
    // In mode 3, standing: see accept().
    if (world_.raw_mode == 3 && world_.motor == Motor::stands && readings_.other()) world_.motor = Motor::runs;
    return true;
  }
  // 3.3: bit 1 = 0, bit 2 = 0, or bits 0..3 = 6 or 7; A6: going to 0 is a stop.
  stopped(step == 0 && readings_.other());
  const bool from_ready = world_.ladder == 6 || world_.ladder == 7 || world_.enabled;
  world_.enabled = false;
  if (step != 7)
    world_.ladder = step == 6 ? 6 : 0;
  else if (from_ready || options_.by_gateway || readings_.other())
    world_.ladder = 7;
  return true;
}

// A6: "A block that covers 40..54 and is 0 in all of it asks for nothing and claims nothing".
bool Judge::all_zero(const Write& write, const Rows& rows, Verdict& verdict) {
  const bool covers = write.first <= row::controlword && write.first + write.words.size() > row::command;
  if (!covers || std::ranges::any_of(write.words, [](std::uint16_t word) { return word != 0; })) return false;
  ClientMemory& mine = me();
  const bool falls = mine.controlword.value && *mine.controlword.value != 0;
  mine.controlword.value = mine.command.value = 0;
  mine.controlword.written_ms = mine.command.written_ms = seen_.now_ms;
  // Whether A7's "last write of the row" knows these zeros is not said.
  if (readings_.other())
    for (const auto& [offset, value] : rows) mine.rows[offset] = value;
  verdict = {"all zero: asks for nothing", {0}};
  if (falls) {
    controlword(0, verdict);
    return true;
  }
  // "and the owner's target_velocity or target_torque 0 acts while a run is on"; without leases nobody is the owner.
  if (world_.motor == Motor::runs && (options_.leases ? world_.owner == client_ : readings_.other())) {
    world_.accepted[row::target_velocity] = 0;
    verdict.says = "all zero: the run's speed is 0";
  }
  return true;
}

Verdict Judge::registers(const Write& write) {
  Rows rows = rows_of(write);
  const bool single = write.function != fc::read_write && rows.size() == 1;  // A1: "A single write is ..."
  for (const std::uint16_t offset : kZeroLeaves) {
    if (!rows.contains(offset) || rows[offset] != 0) continue;
    if (single) return {"refused: 0 alone", {3}};  // A6
    rows.erase(offset);
  }
  Verdict verdict;
  if (!single && all_zero(write, rows, verdict)) return verdict;
  Item was = me().command;
  const Edge command = command_edge(rows, single);
  const Edge word =
      rows.contains(row::controlword) ? edge(me().controlword, rows[row::controlword], single, false) : Edge::absent;
  const std::int64_t number = command == Edge::absent ? 0 : rows[row::command];
  bool refused = false;
  if (command == Edge::acts && is_start(number) && word != Edge::acts) refused = start_refused(number, verdict);
  setpoints(rows, single, command, word, refused);
  if (verdict.says.empty())
    verdict.says = command == Edge::remembered || word == Edge::remembered ? "only remembered" : "set-points";
  // 3.3: "it stops at the first failure".
  if (word == Edge::acts && !controlword(rows[row::controlword], verdict)) {
    // A stop is accepted in every state; what the two together are answered with is not said.
    if (command == Edge::acts && is_stop(number)) {
      this->command(number, me().command, verdict);
      verdict.any_answer = true;
    }
    return verdict;
  }
  if (command != Edge::absent && number != was.value.value_or(0)) me().command.refused = false;
  if (refused) me().command.refused = true;
  // Of a controlword that is not new nothing is said but that the motor does nothing.
  if (word != Edge::absent && word != Edge::acts && single) verdict.any_answer = true;
  if (command == Edge::acts && !refused) {
    if (word == Edge::acts && is_start(number)) {
      // Two that act in one request: what the first does decides.
      if (start_refused(number, verdict)) {
        me().command.refused = true;
        return verdict;
      }
    }
    this->command(number, me().command, verdict);
    if (word == Edge::acts) verdict.any_answer = true;
  }
  if (command == Edge::not_new && single) answer_not_new(number, was, verdict);
  return verdict;
}

}  // namespace axisgate::test::obey
