// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/writers.hpp"

namespace axisgate::test::judged {

using namespace reference;

namespace {
constexpr std::int64_t kEnabledWord = 15;
constexpr std::int64_t kMoveNow = 63;                   // start, and change at once
constexpr std::uint8_t kHomeCoil = 23, kReleases = 22;  // of Step::number
/// Of Step::number as well: the flaws of a sample, from the first one on.
constexpr std::uint8_t kWithMode = 6;  // of Step::length
constexpr std::uint8_t kFirstFlaw = 19, kAfterFlaws = 22;
Flaw flaw_of(std::uint8_t number) {
  return number >= kFirstFlaw && number < kAfterFlaws ? static_cast<Flaw>(number - kFirstFlaw + 1) : Flaw::none;
}

}  // namespace

std::int64_t Writers::start_command(const Step& step) const {
  const std::int64_t command = kCommands.at(step.command);
  if (command < kMove) return command;
  if (command > kRun) {
    const bool can = (commands_ >> command & 1U) != 0 && (leases_ || command != kTakeOver);
    return can && (command != kTorque || flavour_ != Flavour::moves) ? command : kHalt;
  }
  if (flavour_ == Flavour::speeds) return kRun;
  if (flavour_ == Flavour::moves && command == kRun) return kMove;
  return command;
}

// The steps of CiA 402 in their order, sometimes from the beginning.
std::int64_t Writers::next_word(const Step& step, Writer& writer) const {
  if (flavour_ == Flavour::both) return 0;
  if (step.number % 3 != 0) return writer.word;
  if (writer.word == 6)
    writer.word = 7;
  else if (writer.word == 7 || writer.word == kMoveNow)
    writer.word = 15;
  else if (writer.word == 15 && flavour_ == Flavour::moves && step.on)
    writer.word = kMoveNow;
  else
    writer.word = step.number % 8 == 7 ? 0 : 6;
  return writer.word;
}

Write Writers::registers(const Step& step) {
  Writer& writer = writers_.at(step.client);
  const int function = step.number % 4 == 3 ? fc::read_write : fc::write_registers;
  const auto pick = [&](std::uint16_t offset, const auto& list, std::uint8_t index, bool has) {
    if (index < list.size() || !writer.rows.contains(offset)) writer.rows[offset] = has ? list[index % list.size()] : 0;
  };
  pick(row::target_position, kPositions, step.position, has_positions(subject_));
  pick(row::target_velocity, kSpeeds, step.speed, has_speeds(subject_));
  Rows rows = writer.rows;
  if (step.client == 0) rows.insert(profile_.begin(), profile_.end());
  if (step.number % 2 == 0 && flavour_ != Flavour::both)
    rows[row::mode] = flavour_ == Flavour::moves ? 1 : kVelocityMode;
  if (step.id > 1) ++writer.id;
  rows[row::command] = start_command(step);
  rows[row::command_id] = step.id == 0 ? 0 : writer.id;
  std::uint16_t first = row::controlword;
  std::uint16_t last = row::heartbeat;
  switch (step.deed) {
    case Deed::command_by_id:
      first = row::command, last = row::command_id;
      break;
    case Deed::order:
      first = row::target_position, last = row::command_id;
      break;
    case Deed::mode_block:
      first = row::mode, last = row::target_position + 1;
      break;
    case Deed::word_block:
      last = row::target_velocity + 1;
      rows[row::controlword] = next_word(step, writer);
      break;
    case Deed::zeros:
      rows.clear();
      break;
    default:
      rows[row::controlword] = next_word(step, writer);
      // A word that would undo the stop beside it (3.3: one request has a fixed order).
      if (is_stop(rows[row::command]) && step.length % 2 == 1 && flavour_ != Flavour::both)
        rows[row::controlword] = writer.word = flavour_ == Flavour::moves && step.on ? kMoveNow : kEnabledWord;
  }
  return block(first, last, {rows.lower_bound(first), rows.upper_bound(last)}, function);
}

// What the drive holds, or somewhat less where no motion depends on it.
Write Writers::parameter(const Step& step) const {
  constexpr std::array<std::uint16_t, 10> kRows{46, 47, 62, 64, 66, 68, 70, 72, 74, 76};
  constexpr std::int64_t kMostOfAFloat = 1 << 23;
  const std::uint16_t offset = kRows.at(step.number % kRows.size());
  const auto held = parameters_.find(offset);
  std::int64_t value = held == parameters_.end() ? 1 : held->second;
  const bool harmless = offset >= row::homing_speed_switch && offset <= row::homing_acceleration;
  if (harmless && step.on) value -= value / 4;
  if (value <= 0 || value >= kMostOfAFloat) return one(row::command, kHalt);  // 0 alone is refused; never received
  return one(offset, value);
}

Write Writers::write_of(const Step& step) {
  Writer& writer = writers_.at(step.client);
  switch (step.deed) {
    case Deed::command:
      return one(row::command, start_command(step), step.number % 4 == 3 ? fc::mask_write : 0);
    case Deed::parameter:
      return parameter(step);
    case Deed::release:
      return one(row::command, leases_ ? kRelease : kHalt);
    case Deed::word:
      if (flavour_ == Flavour::both) return one(row::command, start_command(step));
      return one(row::controlword, next_word(step, writer), step.number % 4 == 3 ? fc::mask_write : 0);
    case Deed::sample: {
      Rows rows;
      rows[row::command] = start_command(step);
      if (step.number == kReleases && leases_) rows[row::command] = kRelease;
      if (step.position < kPositions.size() && has_positions(subject_))
        rows[row::target_position] = kPositions[step.position];
      if (step.speed < kSpeeds.size() && has_speeds(subject_)) rows[row::target_velocity] = kSpeeds[step.speed];
      if (step.length == kWithMode && flavour_ != Flavour::both)
        rows[row::mode] = flavour_ == Flavour::moves ? kPositionMode : kVelocityMode;
      if (rows[row::command] == kSetPosition)
        rows[row::set_position_value] = kPositions[step.length % kPositions.size()];
      // A sample that asks for nothing is an error of its own.
      if (rows.size() == 1 && rows[row::command] == 0) rows[row::command] = kHalt;
      return {.function = fc::sample, .sample = rows, .flaw = flaw_of(step.number)};
    }
    case Deed::object: {
      constexpr std::uint16_t kLast = 85;
      const auto target = target_object(subject_);
      if (!target) return one(row::command, kHalt);
      return block(row::object_request, kLast,
                   {{row::object_request, 2},
                    {81, target->index},
                    {82, target->subindex},
                    {83, 4},
                    {84, kPositions[step.position % kPositions.size()]}},
                   step.on ? fc::general_reference : fc::write_registers);
    }
    case Deed::halves:
    case Deed::target: {
      if (step.number % 6 == 5 && (commands_ >> kSetPosition & 1U) != 0)
        return one(row::set_position_value, kPositions[step.position % kPositions.size()]);
      // As fast as at the beginning, or slower.
      if (step.number % 6 == 4 && profile_.contains(row::profile_velocity))
        return one(row::profile_velocity, profile_.at(row::profile_velocity) / (1 + step.speed % 3));
      const bool move = flavour_ == Flavour::moves || (flavour_ == Flavour::both && step.on);
      if (move) return one(row::target_position, kPositions[step.position % kPositions.size()]);
      return one(row::target_velocity, kSpeeds[step.speed % kSpeeds.size()]);
    }
    case Deed::coil: {
      constexpr std::array<std::uint16_t, 8> kCoils{coil::enable,         coil::start_absolute, coil::run_velocity,
                                                    coil::start_relative, coil::halt,           coil::quick_stop,
                                                    coil::fault_reset,    coil::enable};
      std::uint16_t number = kCoils[step.number % kCoils.size()];
      if (flavour_ == Flavour::speeds && (number == coil::start_absolute || number == coil::start_relative))
        number = coil::run_velocity;
      if (flavour_ == Flavour::moves && number == coil::run_velocity) number = coil::start_absolute;
      if (step.number == kHomeCoil && has_homing(subject_)) number = coil::home;
      return one_coil(number, step.on, step.number >= 16 ? fc::write_coils : fc::write_coil);
    }
    case Deed::start_coils: {
      std::vector<std::uint16_t> values(4);
      const bool run = flavour_ == Flavour::speeds || (flavour_ == Flavour::both && step.number % 2 == 0);
      if (step.on) values[run ? 3 : step.number % 4 == 3 ? 1 : 0] = 1;
      return coil_block(coil::start_absolute, values);
    }
    case Deed::again:
    case Deed::scan:
      if (!writer.last.words.empty()) return writer.last;
      return registers({.deed = Deed::zeros, .client = step.client});
    default:
      return registers(step);
  }
}

}  // namespace axisgate::test::judged
