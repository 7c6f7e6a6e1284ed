#include "tests/obey/sequence.hpp"

namespace axisgate::test::obey {
namespace {

// Few of them, so that what was written before is written again.
constexpr std::array<std::int64_t, 4> kPositions{-20'000, 5'000, 12'000, 30'000};
constexpr std::array<std::int64_t, 4> kSpeeds{-120'000, 60'000, 150'000, 0};
constexpr std::array<std::int64_t, 8> kPauses{0, 0, 0, 50, 50, 300, 300, 1200};
constexpr std::int64_t kMoveNow = 63;  // start, and change at once

Flavour flavour_of(Subject subject, std::uint64_t seed) {
  if (!has_positions(subject)) return Flavour::speeds;
  if (!has_speeds(subject)) return Flavour::moves;
  return static_cast<Flavour>(seed % 3);
}

}  // namespace

std::string text(const Step& step) {
  std::string out = step.client == 0 ? "a " : "b ";
  out += text(step.write);
  if (step.pause_ms != 0) out += ", then " + std::to_string(step.pause_ms) + " ms";
  return out;
}

Sequence::Sequence(Subject subject, std::uint64_t seed, std::size_t clients, Rows profile)
    : subject_(subject),
      random_(seed * 64 + static_cast<std::uint64_t>(subject)),
      clients_(clients),
      profile_(std::move(profile)),
      flavour_(flavour_of(subject, seed)) {
  for (Writer& writer : writers_) writer.zeros = once_in(2);
}

std::int64_t Sequence::position() { return has_positions(subject_) ? any_of(kPositions) : 0; }
std::int64_t Sequence::speed() { return has_speeds(subject_) ? any_of(kSpeeds) : 0; }

std::int64_t Sequence::start_command() {
  if (flavour_ == Flavour::speeds || (flavour_ == Flavour::both && once_in(2))) return 8;
  return once_in(4) ? 7 : 6;
}

std::int64_t Sequence::some_command() {
  switch (below(10)) {
    case 0:
    case 1:
      return 0;
    case 2:
    case 3:
      return 1;
    case 4:
      return static_cast<std::int64_t>(2 + below(4));
    default:
      return start_command();
  }
}

std::int64_t Sequence::word(Writer& writer) {
  if (flavour_ == Flavour::both) return 0;
  if (once_in(3)) {
    // The steps of CiA 402 in their order, sometimes from the beginning.
    if (writer.word == 6)
      writer.word = 7;
    else if (writer.word == 7 || writer.word == kMoveNow)
      writer.word = 15;
    else if (writer.word == 15 && flavour_ == Flavour::moves && !once_in(4))
      writer.word = kMoveNow;
    else
      writer.word = once_in(8) ? 0 : 6;
  }
  return writer.word;
}

std::int64_t Sequence::id(Writer& writer) {
  switch (below(4)) {
    case 0:
      return 0;
    case 1:
      return writer.id;
    default:
      return ++writer.id;
  }
}

Rows Sequence::targets(Writer& writer) {
  if (writer.last.empty() || once_in(2)) writer.last[row::target_position] = position();
  if (!writer.last.contains(row::target_velocity) || once_in(2)) writer.last[row::target_velocity] = speed();
  return writer.last;
}

Write Sequence::single(Writer& writer) {
  switch (below(5)) {
    case 0:
    case 1:
      if (flavour_ == Flavour::moves || (flavour_ == Flavour::both && once_in(2)))
        return one(row::target_position, position());
      return one(row::target_velocity, speed());
    case 2:
      if (flavour_ != Flavour::both) return one(row::controlword, word(writer), once_in(3) ? fc::mask_write : 0);
      [[fallthrough]];
    default:
      return one(row::command, some_command(), once_in(4) ? fc::mask_write : once_in(4) ? fc::write_registers : 0);
  }
}

Write Sequence::registers(Writer& writer) {
  const int function = once_in(4) ? fc::read_write : fc::write_registers;
  Rows rows = targets(writer);
  if (!writer.zeros) rows.insert(profile_.begin(), profile_.end());
  const std::int64_t mode = flavour_ == Flavour::both || once_in(2) ? 0 : flavour_ == Flavour::moves ? 1 : 3;
  const auto only = [&](std::uint16_t first, std::uint16_t last) {
    std::erase_if(rows, [&](const auto& r) { return r.first < first || r.first > last; });
    return block(first, last, rows, function);
  };
  switch (below(9)) {
    case 0:
      rows[row::mode] = mode;
      return only(41, 43);
    case 1:
    case 2:
      rows[row::mode] = mode;
      rows[row::controlword] = word(writer);
      return only(40, 45);
    case 3:
    case 4:
      rows[row::command] = some_command();
      rows[row::command_id] = id(writer);
      return only(42, 55);
    case 5:
      rows.clear();
      rows[row::command] = some_command();
      rows[row::command_id] = id(writer);
      return only(54, 55);
    case 6:
      if (once_in(3))
        rows.clear();
      else
        rows[row::controlword] = word(writer);
      return only(40, 56);
    default:
      rows[row::mode] = mode;
      rows[row::controlword] = word(writer);
      rows[row::command] = some_command();
      rows[row::command_id] = id(writer);
      return only(40, 56);
  }
}

Write Sequence::some_coil() {
  const std::uint16_t start = flavour_ == Flavour::moves                  ? coil::start_absolute
                              : flavour_ == Flavour::speeds || once_in(2) ? coil::run_velocity
                                                                          : coil::start_absolute;
  const std::array<std::uint16_t, 8> numbers{coil::enable, coil::enable, coil::quick_stop,     coil::halt,
                                             start,        start,        coil::start_relative, start};
  std::uint16_t number = any_of(numbers);
  if (number == coil::start_relative && flavour_ == Flavour::speeds) number = coil::run_velocity;
  return one_coil(number, !once_in(3), once_in(3) ? fc::write_coils : fc::write_coil);
}

Write Sequence::some_coils() {
  std::vector<std::uint16_t> values(4);
  // 4 to 7: at most one of them on, and never homing.
  const bool run = flavour_ == Flavour::speeds || (flavour_ == Flavour::both && once_in(2));
  if (!once_in(3)) values[run ? 3 : once_in(4) ? 1 : 0] = 1;
  return coil_block(coil::start_absolute, values);
}

Step Sequence::next() {
  Step step;
  step.client = static_cast<std::size_t>(below(clients_));
  step.pause_ms = any_of(kPauses);
  Writer& writer = writers_[step.client];
  switch (below(10)) {
    case 0:
    case 1:
    case 2:
      step.write = single(writer);
      break;
    case 3:
      step.write = some_coil();
      break;
    case 4:
      step.write = some_coils();
      break;
    default:
      step.write = registers(writer);
  }
  return step;
}

std::vector<Step> Sequence::ending() {
  if (once_in(4)) return {};
  const auto client = static_cast<std::size_t>(below(clients_));
  Writer& writer = writers_[client];
  const auto pair = [&](std::int64_t command, std::int64_t number) {
    return block(row::command, row::command_id, {{row::command, command}, {row::command_id, number}});
  };
  std::vector<Step> steps;
  steps.push_back({client, one_coil(coil::halt, false), 1200});
  steps.push_back({client, one(row::command, 0), 50});
  steps.push_back({client, one(row::command, 1), 300});
  writer.id += 2;
  steps.push_back({client, pair(0, writer.id - 1), 0});
  const bool move = flavour_ == Flavour::moves || (flavour_ == Flavour::both && once_in(2));
  steps.push_back({client, pair(move ? 6 : 8, writer.id), 0});
  return steps;
}

}  // namespace axisgate::test::obey
