#include <array>

#include "tests/obey/judge.hpp"

namespace axisgate::test::obey {

// A1, level coils: 0 enable, 3 halt, 7 run_velocity, 8 and 9 jog.
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
  if (number == coil::halt) return single || before != 1 ? Edge::acts : Edge::nothing;  // A2: an asserted stop
  // "Coils 7, 8, 9 act on 1 only after this client wrote 0 to them on this memory. Coil 0 = 1 the same while the stop
  // latch is set ...; else a single write of 1 on an empty memory enables."
  if (before == 0) return Edge::acts;
  if (before == 1) return Edge::not_new;  // "rearm_ms never applies to them"
  return number == coil::enable && single && !world_.latched ? Edge::acts : Edge::remembered;
}

Verdict Judge::coils(const Write& write) {
  const bool single = write.words.size() == 1;
  Verdict verdict{"nothing", {0}};
  int acted = 0;
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
    if (number > coil::run_velocity) continue;       // only zeros are written to these in a sequence
    const std::int64_t command = kCommands[number];
    if (single && edge == Edge::not_new && value == 1) {
      answer_not_new(command, was, verdict);
      // A3: "or a held level is refused"; unless it is so already.
      if (level && number == coil::run_velocity) verdict.answers = {0, 6};
      if (level && number == coil::enable)
        verdict.answers = world_.enabled && !world_.latched ? std::set{0} : std::set{6};
    }
    if (single && level && edge == Edge::remembered && value == 1) verdict = {"only remembered: write 0 first", {6}};
    if (edge != Edge::acts) continue;
    ++acted;
    if (value == 0) {
      if (number == coil::enable) {
        this->command(2, item, verdict);
      } else if (number == coil::halt) {
        world_.held = false;  // "ends the halt without moving"
      } else if (number == coil::run_velocity &&
                 (world_.motor == Motor::runs || (world_.motor == Motor::moves && readings_.other()))) {
        halted(readings_.other());
      }
      if (number != coil::enable) verdict.says = "coil " + std::to_string(number) + " = 0";
      continue;
    }
    item.refused = is_start(command) && start_refused(command, verdict);
    if (item.refused) continue;
    if (number == coil::halt) world_.held = true;
    this->command(command, item, verdict);
  }
  // Which of two goes first in one row of coils is not said.
  if (acted > 1) world_.motor = Motor::unknown, verdict.any_answer = true;
  return verdict;
}

}  // namespace axisgate::test::obey
