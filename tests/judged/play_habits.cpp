// SPDX-License-Identifier: Apache-2.0
// What the programs that are out there do again and again, each in several requests.
#include "tests/judged/foreign_frames.hpp"
#include "tests/judged/playing.hpp"

namespace axisgate::test::judged {

using namespace reference;

namespace {

constexpr std::int64_t kLongestHabitMs = 1500;
constexpr std::uint8_t kEnables = 1, kFirstStart = 3, kStarts = 5, kStops = 8;  // of kCommands

/// A single start, of this client.
Step press(const Step& step, Deed deed = Deed::command) {
  constexpr std::array<std::uint8_t, 3> kStartCoils{1, 2, 3};
  Step out{.deed = deed, .client = step.client, .position = step.position, .speed = step.speed};
  out.command = static_cast<std::uint8_t>(kFirstStart + step.command % kStarts);
  if (deed == Deed::coil) out.number = kStartCoils.at(step.command % kStartCoils.size());
  out.on = true;
  return out;
}

}  // namespace

// Each of them goes out before the one before is answered, so that they meet in every order.
void Play::send_crossed(const Step& step) {
  constexpr std::array<std::uint8_t, 6> kCrossed{kEnables, kFirstStart, 6, kStops, kStops + 1, kStops + 2};
  unsigned drawn = step.command + 18U * (step.number + 24U * (step.position + 6U * step.speed));
  for (unsigned i = 0; i < 3U + step.id % 3U; ++i, drawn /= static_cast<unsigned>(kCrossed.size())) {
    Step one{.deed = Deed::command, .command = kCrossed.at(drawn % kCrossed.size())};
    one.client = static_cast<std::uint8_t>((step.client + (step.on ? 0 : i)) % kModbus);
    send(one.client, writers_->write_of(one), true);
    pass(kStepMs * (step.id % 4));
  }
}

void Play::hold_button(const Step& step) {
  constexpr std::int64_t kAgainMs = 200;
  constexpr std::uint8_t kOtherToo = 3, kBothAtOnce = 4;  // of Step::id
  if (!has_speeds(program_.subject)) return;
  const std::uint16_t number = step.number % 2 == 0 ? coil::jog_forward : coil::jog_reverse;
  const std::uint16_t other = step.number % 2 == 0 ? coil::jog_reverse : coil::jog_forward;
  const bool both = step.id == kBothAtOnce;
  send(step.client, both ? coil_block(coil::jog_forward, {0, 0}) : one_coil(number, false), false);
  if (step.id == kOtherToo) send(step.client, one_coil(other, false), false);
  for (std::int64_t gone = 0; gone <= kLengths.at(step.length) && gone < kLongestHabitMs && !over(); gone += kAgainMs) {
    send(step.client, both ? coil_block(coil::jog_forward, {1, 1}) : one_coil(number, true), step.at_once);
    if (step.id == kOtherToo && gone == kAgainMs) send(step.client, one_coil(other, true), step.at_once);
    pass(kAgainMs);
  }
  if (step.on) send(step.client, one_coil(number, false), false);
}

// A PLC that writes the same block again and again. Another program, perhaps of its address, presses something
// meanwhile.
void Play::scan(const Step& step) {
  constexpr std::int64_t kEachMs = 50;
  constexpr std::array<std::uint8_t, 4> kPressed{kStops, kStops + 1, kEnables, kFirstStart};
  for (std::int64_t gone = 0; gone < kLengths.at(step.length) && gone < kLongestHabitMs && !over(); gone += kEachMs) {
    send(step.client, writers_->write_of(step), step.at_once);
    pass(kEachMs);
    if (!step.on || gone != 2 * kEachMs) continue;
    Step other{.deed = Deed::command_by_id, .id = 2};
    other.client = static_cast<std::uint8_t>((step.client + 1U + step.number % 2U) % kModbus);
    other.command = kPressed.at(step.command % kPressed.size());
    send(other.client, writers_->write_of(other), step.at_once);
  }
}

// The drive was without power for a moment, and on most lines nobody says so: its master enables it and goes on.
void Play::go_on_unaware(const Step& step) {
  constexpr std::int64_t kSeenMs = 2000;
  pass(kSeenMs);
  send(step.client, one(row::command, kEnable), false);
  pass(kPauses.at(step.pause));
  send(step.client, writers_->write_of(press(step, step.at_once ? Deed::order : Deed::command)), false);
  pass(kLongestHabitMs);
}

// One tool for each request, as mbpoll is used, or a person at a panel: set it, press it, and once more.
void Play::use_tool(const Step& step) {
  constexpr std::array<std::int64_t, 4> kBetween{0, 50, 300, 1200};
  constexpr std::uint8_t kEachAnew = 3;  // of Step::id
  constexpr std::uint8_t kHomes = 20;    // of Step::number, and more
  if (step.number >= kHomes && has_homing(program_.subject)) return home_again(step);
  const auto anew = [&] {
    if (step.id >= kEachAnew) replace(step.client, false);
  };
  const Step target = press(step, step.on ? Deed::coil : Deed::command);
  const bool runs = step.on ? target.number == 2 : kCommands.at(target.command) == kRun;
  for (unsigned i = 0; i < 2U + step.number % 2U && !over(); ++i) {
    // The same start with another target, with the same one, or with none.
    if (i == 0 || step.number % 3 != 0) {
      Step set = target;
      set.deed = Deed::target;
      set.position = static_cast<std::uint8_t>(step.position + (step.number % 3 == 1 ? i : 0));
      set.speed = static_cast<std::uint8_t>(step.speed + (step.number % 3 == 1 ? i : 0));
      set.on = !runs;
      send(step.client, writers_->write_of(set), step.at_once);
      anew();
    }
    send(step.client, writers_->write_of(target), step.at_once);
    anew();
    pass(kBetween.at(step.length % kBetween.size()));
  }
}

// A homing that is halted, or has come to its end, and what comes after it: another one, or a move.
void Play::home_again(const Step& step) {
  constexpr std::array<std::int64_t, 4> kHomes{50, 300, 1200, 3000};
  constexpr std::int64_t kHaltMs = 1000;
  const auto say = [&](std::int64_t command) { send(step.client, one(row::command, command), false); };
  for (unsigned i = 0; i < 2U + step.id % 2U && !over(); ++i) {
    say(kHome);
    pass(kHomes.at((step.length + i) % kHomes.size()));
    if (step.on || i == 0) say(step.speed == 0 ? kQuickStop : kHalt);
    pass(kHaltMs);
    if (step.speed == 0) say(kEnable);
  }
  say(step.command % 2 == 0 ? kMove : kRelative);
}

void Play::use_monitor(const Step& step) {
  constexpr std::int64_t kEachMs = 100, kLongestMs = 4000;
  for (std::int64_t gone = 0; gone < kLengths.at(step.length) && gone < kLongestMs && !over(); gone += kEachMs) {
    read(step.client);
    pass(kEachMs);
  }
}

void Play::insist(const Step& step) {
  constexpr int kNotNow = 6, kUnknown = 11;
  constexpr std::array<std::int64_t, 3> kAgainMs{5, 100, 400};
  Step order = press(step, step.on ? Deed::order : Deed::command);
  order.id = step.id;
  const Write write = writers_->write_of(order);
  for (int tries = 0; tries < 4 && !over(); ++tries) {
    send(step.client, write, false);
    const auto told = told_.at(step.client);
    if (told != kNotNow && told != kUnknown) return;
    pass(kAgainMs.at(step.number % kAgainMs.size()));
  }
}

void Play::take_away(const Step& step) {
  constexpr std::uint8_t kTakesOver = 15;  // of kCommands
  Step start = press(step, Deed::order);
  start.id = 2;
  send(step.client, writers_->write_of(start), step.at_once);
  pass(kPauses.at(step.length % kPauses.size()));
  const auto rival = static_cast<std::uint8_t>((step.client + 1U + step.number % 2U) % kModbus);
  const bool answers_back = step.number / 2 % 2 != 0;
  send(rival, writers_->write_of({.deed = Deed::command, .client = rival, .command = kTakesOver}),
       step.at_once || answers_back);
  if (!answers_back) return;
  pass(kPauses.at(step.id % kPauses.size()));
  send(step.client, writers_->write_of(start), true);
}

// 3.4 Owed stops: what is let go, or stopped, while the drive cannot be asked. Before that it may have been started.
void Play::press_out_of_sight(const Step& step) {
  constexpr std::uint8_t kStarted = 2, kHeld = 4;  // of Step::id
  const std::uint16_t button = step.number % 2 == 0 ? coil::jog_forward : coil::jog_reverse;
  const bool jogs = step.id == kHeld && has_speeds(program_.subject);
  if (jogs) {
    send(step.client, one_coil(button, false), false);
    if (step.speed % 2 == 1) return jog_unanswered(step, button);
    send(step.client, one_coil(button, true), step.at_once);
  } else if (step.id >= kStarted) {
    Step start = press(step, Deed::order);
    start.id = 2;
    send(step.client, writers_->write_of(start), step.at_once);
  }
  pass(kPauses.at(step.length % kPauses.size()));
  outage({.deed = step.number % 4 < 2 ? Deed::cut : Deed::unplug, .at_once = true, .length = step.length});
  pass(kPauses.at(step.command % 5U));
  Step let_go{.deed = Deed::command, .client = step.client};
  let_go.command = static_cast<std::uint8_t>(kStops + step.number % 3);
  if (jogs)
    send(step.client, one_coil(button, false), step.on);
  else if (step.number % 6 == 5)
    send(step.client, one_coil(coil::enable, false), step.on);
  else
    send(step.client, writers_->write_of(let_go), step.on);
  pass(std::min(kLengths.at(step.length), kLongestHabitMs));
  mend();
}

// The drive jogs, and its acknowledgement is lost: the button that is let go ends what may be a jog.
void Play::jog_unanswered(const Step& step, std::uint16_t button) {
  constexpr std::int64_t kQuietMs = 3000;
  if (!plant_.stage.gateway_runs() || !wire_whole_) return;
  begin_trouble();
  watches_->cable.lie_in_wait(std::chrono::milliseconds(kLongestHabitMs));
  send(step.client, one_coil(button, true), false);
  pass(kPauses.at(step.length % kPauses.size()));
  send(step.client, one_coil(button, false), step.on);
  pass(kQuietMs);
}

// What it makes of the motor is its own affair; stops, leases and buttons act all the same.
void Play::be_commanded_by_another(const Step& step) {
  constexpr std::array<std::int64_t, 4> kOwnMs{20, 200, 1000, 3000};
  const std::vector<ForeignFrame> frames = foreign_frames(program_.subject, step);
  if (frames.empty() || !plant_.stage.gateway_runs() || !wire_whole_ || over()) return;
  begin_trouble();
  watches_->line_is_troubled(true);
  another_master_ = true;
  outcome_.story.push_back(stamp() + ": another master: " + text(frames));
  for (const ForeignFrame& frame : frames) {
    contract_->commanded_by_another();
    plant_.other_master_sends(frame.id, frame.bytes);
    pass(kStepMs);
  }
  contract_->commanded_by_another();
  watches_->cable.commanded_by_another();
  pass(kOwnMs.at(step.position % kOwnMs.size()));
  if (step.on)
    send(step.client, writers_->write_of({.deed = Deed::command, .client = step.client, .command = kStops}),
         step.at_once);
}

// The drive shows quick stop active, and its motor turns on.
void Play::be_nearly_right(const Step& step) {
  constexpr std::int64_t kStartsMs = 400;
  send(step.client, one(row::command, kEnable), false);
  Step start = press(step, Deed::order);
  start.id = 2;
  send(step.client, writers_->write_of(start), false);
  pass(kStartsMs);
  begin_trouble();
  wire_whole_ = false;
  was_nearly_right_ = true;
  ignore_quick_stop(plant_.stage, program_.subject, true);
  send(step.client, writers_->write_of({.deed = Deed::command, .client = step.client, .command = kStops}), false);
  pass(kLengths.at(step.length));
}

// Design 4: a DDS master begins something and stays, or falls silent, or is gone; mostly another writer comes then.
void Play::follow_each_other(const Step& step) {
  constexpr std::int64_t kAgainMs = 200;
  constexpr std::array<std::uint8_t, 4> kSuccessors{kEnables, kFirstStart, kStops, kStops + 1};  // of kCommands
  enum Sign : std::uint8_t { none, liveliness, heartbeat, standing_heartbeat, vain_heartbeat };
  const auto writer = static_cast<std::uint8_t>(step.client);
  // Its program may have begun to beat before.
  if (step.command / kStarts % 2 == 1) beat(writer, true);
  Step start = press(step, Deed::sample);
  send(kModbus + writer, writers_->write_of(start), step.at_once);
  for (std::int64_t gone = 0; gone <= kLengths.at(step.length) && gone < 2 * kLongestHabitMs && !over();
       gone += kAgainMs) {
    if (step.id == liveliness) be_alive(writer);
    if (step.id == heartbeat || step.id == standing_heartbeat) beat(writer, step.id == heartbeat || gone == 0);
    if (step.id == vain_heartbeat) beat_in_vain(writer, step.number % 2 == 0);
    pass(kAgainMs);
  }
  if (step.on) replace(kModbus + writer, step.number % 4 != 3);
  if (step.number % 3 == 0) return;
  Step next = press(step, Deed::sample);
  next.client = static_cast<std::uint8_t>((writer + step.number % 3) % kWriters);
  next.command = kSuccessors.at(step.position % kSuccessors.size());
  send(kModbus + next.client, writers_->write_of(next), step.at_once);
}

// Design 4: "request ids seen in the last 10 s are answered as already seen, not run again": of whoever missed a reply.
void Play::say_once_more(const Step& step) {
  if (over() || !clients_.connected(kModbus + step.client)) return;
  if (step.on) {  // which gateway: "commands need an exact match"
    Step other = press(step, Deed::sample);
    other.command = step.command;
    clients_.dds().ask_another_gateway(writers_->write_of(other), step.client);
  }
  if (const auto write = clients_.dds().said(step.client, 1U + step.id % 3U))
    send(kModbus + step.client, *write, step.at_once);
}

// Design 4: "a crash in the DDS library costs topics for a moment, never the drives".
void Play::kill_dds(const Step& step) {
  if (over() || !clients_.connected(kModbus)) return;
  outcome_.story.push_back(stamp() + ": axisgate-dds dies");
  contract_->dds_died();
  for (const Open& open : open_)
    if (is_dds(open.client)) never_answered(open);
  std::erase_if(open_, [](const Open& open) { return is_dds(open.client); });
  clients_.dds().process_dies();
  pass(std::min(kLengths.at(step.length), 2 * kLongestHabitMs));
  if (over()) return;
  clients_.dds().process_returns();
  outcome_.story.push_back(stamp() + ": it is back");
}

// Design 4: "jog with the same deadline". Let go, or forgotten; sometimes the other direction is pressed meanwhile.
void Play::jog_by_dds(const Step& step) {
  constexpr std::int64_t kAgainMs = 200;
  constexpr std::uint8_t kOtherToo = 3;  // of Step::id
  if (!has_speeds(program_.subject)) return;
  const std::size_t client = kModbus + step.client;
  const auto say = [&](std::int64_t command) {
    Rows rows{{row::command, command}};
    if (command != kJogEnd && step.speed < kSpeeds.size() && kSpeeds.at(step.speed) > 0)
      rows[row::jog_velocity] = kSpeeds.at(step.speed);
    send(client, {.function = fc::sample, .sample = rows}, step.at_once);
  };
  const std::int64_t way = step.number % 2 == 0 ? kJogForward : kJogReverse;
  if (step.number % 4 == 0) say(kJogEnd);
  for (std::int64_t gone = 0; gone <= kLengths.at(step.length) && gone < kLongestHabitMs && !over(); gone += kAgainMs) {
    say(step.id == kOtherToo && gone == kAgainMs ? kJogForward + kJogReverse - way : way);
    pass(kAgainMs);
  }
  if (step.on) say(kJogEnd);
}

// 3.1 Panels: panels that only have function 6; of others a target in one request. With another write between, or a
// half of another row, the first one is dropped.
void Play::write_halves(const Step& step) {
  constexpr std::array<std::int64_t, 5> kBetween{0, 50, 50, 400, 1500};
  constexpr std::uint8_t kWhole = 8;
  const Write whole = writers_->write_of(step);
  const bool all_the_same = !plant_.listener.staged_halves && step.number % kWhole != 0;
  if (all_the_same || whole.words.size() != 2) return send(step.client, whole, step.at_once);
  const auto half = [&](std::uint16_t row, bool second) {
    const std::size_t at = second ? 1 : 0;
    send(step.client, {fc::write_register, static_cast<std::uint16_t>(row + at), {whole.words[at]}}, step.at_once);
  };
  half(whole.first, step.on);
  pass(kBetween.at(step.id));
  if (step.number % 4 == 1) send(step.client, one(row::heartbeat, step.number), step.at_once);
  const bool both = has_positions(program_.subject) && has_speeds(program_.subject);
  if (step.number % 4 == 2 && both)
    half(whole.first == row::target_position ? row::target_velocity : row::target_position, !step.on);
  half(whole.first, !step.on);
  if (step.length % 2 == 1) send(step.client, writers_->write_of(press(step)), step.at_once);
}

}  // namespace axisgate::test::judged
