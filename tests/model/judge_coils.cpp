// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "tests/model/judge.hpp"

namespace axisgate::test::reference {

// 3.3 Edges, level coils: 0 enable, 3 halt, 7 run_velocity, 8 and 9 jog.
Judge::Edge Judge::level_edge(std::uint16_t number, std::int64_t value, bool single) {
  Item& item = me().coils.at(number);
  const std::optional<std::int64_t> before = item.value;
  item.value = value;
  item.written_ms = seen_.now_ms;
  if (value == 0) {
    // "A single write of 0 always acts ...; in a block on an empty memory it is only remembered."
    if (single) return Edge::acts;
    return !before ? Edge::remembered : *before == 0 ? Edge::nothing : Edge::acts;
  }
  if (number == coil::halt) return single || before != 1 ? Edge::acts : Edge::nothing;  // 3.4 Stops: an asserted stop
  // "Coils 7, 8, 9 act on 1 only after this client wrote 0 to them on this memory. Coil 0 = 1 the same while the stop
  // latch is set ...; else a single write of 1 on an empty memory enables."
  if (item.unsure && readings_.other()) return Edge::not_new;
  if (before == 0) return Edge::acts;
  if (before == 1) return Edge::not_new;  // "rearm_ms never applies to them"
  return number == coil::enable && single && !world_.latched ? Edge::acts : Edge::remembered;
}

// 3.4 Jog: "the axis runs at jog_velocity while the coil is 1 and its owner writes the 1 again at least each
// jog_timeout_ms; then halt. ... Both 1: halt."
void Judge::jog(std::int64_t direction, std::int64_t value, Edge edge, bool single, Verdict& verdict) {
  const bool mine = world_.jog == direction && world_.jog_client == client_;
  if (value == 0) {
    // "A single write of 0 always acts (...; 8, 9 end a jog)": anybody's.
    const bool its_own = mine || (single && world_.jog == direction);
    // Whether the coil of the other way ends it too is not said.
    if (edge == Edge::acts && (its_own || (single && world_.jog != 0 && readings_.other()))) halted(false);
    return;
  }
  const Item& other = me().coils.at(direction > 0 ? coil::jog_reverse : coil::jog_forward);
  const bool newly = edge == Edge::acts || (single && edge == Edge::remembered);
  if (other.value == 1 && newly) {
    jog_both(true, verdict);
    // A coil that has never been 0 is told as "not new" besides.
    if (single && edge == Edge::remembered) verdict.answers.insert(6);
    return;
  }
  if (edge != Edge::acts) {
    if (mine) world_.jog_ends_ms = seen_.now_ms + options_.jog_timeout_ms;
    // 3.3 Not new: "a held level is refused", and what is told of it.
    if (single && !mine) verdict = {"jog: write 0 first", {0, 6}, !world_.accepted.contains(row::jog_velocity)};
    return;
  }
  begin_jog(direction, verdict);
}

void Judge::begin_jog(std::int64_t direction, Verdict& verdict) {
  if (!world_.accepted.contains(row::jog_velocity)) {
    verdict = {"jog at a speed that a new gateway does not know", {0}, true};
    // Refused it is no press, and may be repeated at once (NEW-5).
    if (readings_.other())
      world_.motor = Motor::unknown;
    else
      me().coils.at(direction > 0 ? coil::jog_forward : coil::jog_reverse).value = 0;
    return;
  }
  if (start_refused(kRun, verdict)) return;
  claim();
  for (ClientMemory& client : world_.clients) {
    client.command.ended = true;
    for (Item& coil : client.coils) coil.ended = true;
  }
  // A jog into another motion: what becomes of that is not said.
  world_.motor = world_.motor == Motor::stands ? Motor::runs : Motor::unknown;
  world_.jog = direction;
  world_.speed_mode = true;
  world_.mode = kVelocityMode;
  world_.jog_client = client_;
  world_.jog_ends_ms = seen_.now_ms + options_.jog_timeout_ms;
  world_.started_ms = seen_.now_ms;
  verdict = {"jogs", {0}};
}

// JOG-6: a run that is no jog ends where the two come to be 1 together; while they stay so, a jog alone does. Whether
// it halts a move is not said.
void Judge::jog_both(bool newly, Verdict& verdict) {
  const bool runs = world_.jog != 0 || (newly && world_.motor == Motor::runs && world_.motion().kind != Motor::unknown);
  if (newly) stopped_ = true;
  if (runs || (world_.motor != Motor::stands && readings_.other())) halted(false);
  verdict = {"jog both ways: halt", {0}, true};
}

// 3.3 Edges: "7 halts while run_velocity runs"; 3.4: a stop, "open to every operator". Of a coil that ends nothing
// another client's is refused, or not.
void Judge::end_run(Verdict& verdict) {
  verdict = {"coil 7 = 0", {0}};
  stopped_ = true;
  const bool runs = world_.motor == Motor::runs && world_.jog == 0 && world_.motion().kind != Motor::unknown;
  if (runs || (world_.motor != Motor::stands && readings_.other()))
    halted(readings_.other());
  else if (foreign())
    verdict.answers = {0, 6};
}

Verdict Judge::coils(const Write& write) {
  const bool single = write.words.size() == 1;
  Verdict verdict{"nothing", {0}};
  int acted = 0;
  const std::size_t jogs = coil::jog_forward - write.first;  // in one request neither of the two comes first
  const bool both = write.first <= coil::jog_forward && jogs + 1 < write.words.size() && write.words[jogs] != 0 &&
                    write.words[jogs + 1] != 0;
  const auto rises = [&](std::uint16_t number) { return me().coils.at(number).value == 0; };
  const bool newly_both = both && (rises(coil::jog_forward) || rises(coil::jog_reverse));
  for (std::size_t i = 0; i < write.words.size(); ++i) {
    const auto number = static_cast<std::uint16_t>(write.first + i);
    if (number >= me().coils.size()) continue;
    const std::int64_t value = write.words[i];
    Item& item = me().coils[number];
    const Item was = item;
    constexpr std::array<std::int64_t, 8> kCommands{1, 5, 3, 4, 6, 7, 10, 8};
    const bool level = number == coil::enable || number == coil::halt || number >= coil::run_velocity;
    Edge edge = level ? level_edge(number, value, single)
                      : this->edge(item, value, single, number == coil::quick_stop && value != 0);
    if (!level && value == 0) edge = Edge::nothing;  // it arms
    if (number > coil::run_velocity && both) {
      if (number == coil::jog_forward) jog_both(newly_both, verdict);
      continue;
    }
    if (number > coil::run_velocity) {
      jog(number == coil::jog_forward ? 1 : -1, value, edge, single, verdict);
      continue;
    }
    const std::int64_t command = kCommands[number];
    const bool so_already = world_.enabled && !world_.latched;
    const bool under_way =
        seen_.now_ms - world_.off_asked_ms < kUnderWayMs || seen_.now_ms - world_.enable_asked_ms < kUnderWayMs;
    if (single && edge == Edge::not_new && value == 1) {
      answer_not_new(command, was, verdict);
      // 3.3 Not new: "or a held level is refused"; unless it is so already.
      if (level && number == coil::run_velocity) verdict.answers = {0, 6};
      if (level && number == coil::enable)
        verdict.answers = under_way ? std::set{0, 6} : so_already ? std::set{0} : std::set{6};
    }
    if (single && level && edge == Edge::remembered && value == 1)
      verdict = {"only remembered: write 0 first", under_way ? std::set<int>{0, 6} : std::set<int>{6}};
    if (edge != Edge::acts) continue;
    ++acted;
    if (value == 0) {
      if (number == coil::run_velocity) end_run(verdict);
      if (number == coil::enable) this->command(2, item, verdict);
      if (number == coil::halt) world_.held = false;  // "ends the halt without moving"
      if (number == coil::halt && foreign()) verdict.answers = {0, 6};
      continue;
    }
    item.refused = is_start(command) && start_refused(command, verdict);
    if (item.refused) continue;
    if (number == coil::halt) world_.held = true;
    this->command(command, item, verdict);
    if (single && number == coil::enable && value == 1 && under_way) verdict.answers.insert(6);
  }
  // Which of two goes first in one row of coils is not said.
  if (acted > 1) world_.motor = Motor::unknown, verdict.any_answer = true;
  tell_foreign(verdict);
  return verdict;
}

}  // namespace axisgate::test::reference
