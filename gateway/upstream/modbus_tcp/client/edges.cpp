// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/client/edges.hpp"

#include <algorithm>

namespace axisgate::modbus_tcp {
namespace {

constexpr std::size_t kEnable = 0;  // offsets of the coils
constexpr std::size_t kRunVelocity = 7;

/// "A single write that asks for what is so already is answered normally."
bool is_so(Command command, const Writing& writing) {
  if (command == Command::enable) return writing.enabled;
  if (command == Command::run_velocity) return writing.runs_velocity;
  return command == Command::fault_reset && !writing.needs_zero;
}

const AxisRecord& record_of(const Writing& writing) {
  static const AxisRecord kNothing;
  return writing.record == nullptr ? kNothing : *writing.record;
}

/// A program that has lost its connection brings what another one has stopped since.
bool repeats_interrupted(std::uint16_t id, const CommandIds& ids, const Writing& writing) {
  constexpr ClientId kAnybody = ~ClientId{0};
  return !writing.own.id && std::ranges::any_of(ids.overtaken, [&](const CommandIds::Overtaken& each) {
    return each.id == id && record_of(writing).interrupted(each.since, kAnybody);
  });
}

void note_id(std::uint16_t id, bool acts, CommandIds& ids, const Writing& writing) {
  const auto forget = [&ids](std::uint16_t gone) {
    auto& all = ids.overtaken;
    all.erase(std::remove_if(all.begin(), all.end(), [gone](const auto& each) { return each.id == gone; }), all.end());
  };
  const bool differs = ids.last != id;
  if (differs && ids.last && writing.own.id != ids.last && writing.connected_at < ids.last_at) {
    const bool known = std::ranges::any_of(ids.overtaken, [&](const auto& each) { return each.id == *ids.last; });
    if (!known && ids.overtaken.size() == CommandIds::kMaxOvertaken) ids.overtaken.erase(ids.overtaken.begin());
    if (!known) ids.overtaken.push_back({*ids.last, ids.since});
  }
  if (writing.own.id && *writing.own.id != id) forget(*writing.own.id);  // its program has gone on
  if (acts) forget(id);
  if (differs) ids.since = record_of(writing).now();
  ids.last = id;
  ids.last_at = writing.now;
}

}  // namespace

// --- Values --------------------------------------------------------------------------------------------------------

/// A single write of what was written before: new again after rearm_ms, unless what it asked for then was ended by
/// somebody or something else: then 0 or another value must come first. Whoever could believe that it has acted is
/// told.
Verdict EdgeMemory::judge_single(const Item& item, const Kind& kind, const Writing& writing) {
  const bool rearmed = item.at == kLongAgo || writing.now - item.at >= writing.rearm;
  const AxisRecord& record = record_of(writing);
  const AxisRecord::Point since = item.acted.value_or(0);
  const bool interrupted = item.acted && record.interrupted(since, writing.client);
  // A stop too many is the smaller harm: a scanner's block may carry the same word all the time.
  if ((rearmed && !interrupted) || kind.unserved || kind.stop_word) return Verdict::acts;
  const bool changed = item.targets != writing.targets;
  const bool over = !item.acted || record.ended(since, writing.client);
  return kind.relative || ((changed || over) && !kind.is_so) ? Verdict::not_new : Verdict::nothing;
}

Verdict EdgeMemory::judge(Item& item, std::uint16_t value, const Kind& kind, const Writing& writing,
                          std::optional<std::uint16_t> own) {
  const bool repeats = writing.form == WriteForm::block && own == value && !kind.stop && !kind.stop_word;
  const bool same = item.written && (value == item.value || repeats);
  if (writing.form == WriteForm::single) {
    if (kind.stop || !same) return Verdict::acts;
    return judge_single(item, kind, writing);
  }
  if (!item.written) {
    // Remembered alone. A 0 asks for nothing, so there is nothing to tell of it.
    if (kind.stop) return Verdict::acts;
    return value == 0 ? Verdict::nothing : Verdict::not_new;
  }
  if (!same) return Verdict::acts;
  if (!kind.held_start || item.answered_not_new || item.targets == writing.targets) return Verdict::nothing;
  item.answered_not_new = true;
  return Verdict::not_new;
}

void EdgeMemory::remember(Item& item, std::uint16_t value, const Writing& writing) {
  if (!item.written || item.value != value)
    item = {.written = true, .value = value, .since = writing.request, .acted = {}};
  item.at = writing.now;
  item.request = writing.request;
  item.done = false;
}

Verdict EdgeMemory::conclude(Item& item, std::uint16_t value, Verdict verdict, const Writing& writing) {
  const bool fresh = !item.written || item.value != value;
  remember(item, value, writing);
  if (fresh || verdict == Verdict::acts) item.targets = writing.targets;
  if (verdict != Verdict::acts) return verdict;
  item.acted = record_of(writing).now();
  item.answered_not_new = false;
  return verdict;
}

Verdict EdgeMemory::controlword(std::uint16_t value, const Writing& writing) {
  constexpr std::uint16_t kStepsAndStart = 0x001F, kEnabled = 0x000F;  // "enabled" is all that this word asks for
  const Kind kind{.stop_word = is_stop_controlword(value),
                  .is_so = writing.enabled && (value & kStepsAndStart) == kEnabled};
  return conclude(controlword_, value, judge(controlword_, value, kind, writing, writing.own.controlword), writing);
}

Verdict EdgeMemory::command(Command value, const Writing& writing) {
  const auto number = static_cast<std::uint16_t>(value);
  const Kind kind{.stop = is_stop(value),
                  .relative = value == Command::move_relative,
                  .unserved = value == Command::release && writing.owns,
                  .is_so = is_so(value, writing),
                  .held_start = starts_motion(value)};
  // "0 in `command` does nothing and arms it."
  const Verdict verdict =
      value == Command::none ? Verdict::nothing : judge(command_, number, kind, writing, writing.own.command);
  return conclude(command_, number, verdict, writing);
}

Verdict EdgeMemory::command_with_id(Command value, std::uint16_t id, CommandIds& ids, const Writing& writing) {
  const auto number = static_cast<std::uint16_t>(value);
  const bool kept = ids.last.has_value();
  const bool differs = !kept || id != *ids.last;
  Verdict verdict = Verdict::nothing;
  if (is_stop(value)) {
    // A stop too many is the smaller harm: one that a connection repeats acts where another has written since, and the
    // first one that it writes with an id whatever the id of its address is.
    const bool other_command = !command_.written || command_.value != number;
    const bool other_id = differs || writing.own.id != id;
    if (other_id || other_command || writing.form == WriteForm::single) verdict = Verdict::acts;
  } else if (value != Command::none && differs && id != writing.own.id) {
    // The first id of an address is only remembered: nobody knows whether it is one from before a restart.
    verdict = kept && !repeats_interrupted(id, ids, writing) ? Verdict::acts : Verdict::not_new;
  }
  note_id(id, verdict == Verdict::acts, ids, writing);
  if (verdict == Verdict::acts || value == Command::none) ids.seen = id;
  return conclude(command_, number, verdict, writing);
}

bool EdgeMemory::zeros(const Writing& writing) {
  const bool stops = controlword_.written && controlword_.value != 0;
  remember(controlword_, 0, writing);
  remember(command_, 0, writing);
  return stops;
}

// --- Coils ---------------------------------------------------------------------------------------------------------

/// Level coils: rearm_ms never applies to them, and a 1 is no standing right. Coil 3 = 1 is a stop and not judged here.
Verdict EdgeMemory::judge_level(const Item& item, const CoilRow& coil, bool value, const Writing& writing) {
  const bool single = writing.form == WriteForm::single;
  const bool held = writing.own.coils[coil.offset];
  if (!value) return single || held || item.is_on() ? Verdict::acts : Verdict::nothing;
  const bool was_zero = item.written && item.value == 0 && !held;
  if (was_zero) return Verdict::acts;
  if (!item.written) {
    const bool first_enable = coil.offset == kEnable && single && !writing.needs_zero;
    return first_enable ? Verdict::acts : Verdict::not_new;
  }
  // Held. A scanner repeats itself; a single write is told, unless what it asks for is so.
  const bool is_so = coil.offset == kEnable ? writing.enabled : coil.offset == kRunVelocity && writing.runs_velocity;
  return single && !is_so ? Verdict::not_new : Verdict::nothing;
}

CoilAsks EdgeMemory::coil(const CoilRow& coil, bool value, const Writing& writing) {
  Item& item = coils_.at(coil.offset);
  const Command asked = value ? coil.on : coil.off;
  Verdict verdict = Verdict::nothing;
  if (coil.level && !is_stop(asked == Command::disable ? Command::none : asked)) {
    verdict = judge_level(item, coil, value, writing);
  } else if (asked != Command::none) {
    const Kind kind{
        .stop = is_stop(asked), .relative = asked == Command::move_relative, .is_so = is_so(asked, writing)};
    verdict = judge(item, value ? 1 : 0, kind, writing, writing.own.coils[coil.offset] ? 1 : 0);
  }
  const bool swallowed = !value && writing.form == WriteForm::block && item.is_on() && item.disowned;
  if (swallowed) verdict = Verdict::nothing;
  static_cast<void>(conclude(item, value ? 1 : 0, verdict, writing));
  return {verdict, verdict == Verdict::acts ? asked : Command::none};
}

JogAsks EdgeMemory::jog(const JogWrite& write, const Writing& writing) {
  struct Side {
    Item& item;
    std::optional<bool> value;
    Command start;
    bool was_on;
    bool own;  ///< this connection has written it 1 itself
    bool single;
    [[nodiscard]] bool on() const { return value.value_or(was_on); }
    [[nodiscard]] bool rises() const { return value.value_or(false) && item.written && !was_on && !own; }
    [[nodiscard]] bool first() const { return value.value_or(false) && !item.written; }
    [[nodiscard]] bool held() const { return value.value_or(false) && (was_on || own); }
    /// A single 0 always ends: it may be a button that is let go after a reconnect.
    [[nodiscard]] bool falls() const { return value && !*value && (single || (was_on ? !item.disowned : own)); }
  };
  const bool single = writing.form == WriteForm::single;
  const auto side_of = [&](std::uint16_t coil, std::optional<bool> value, Command start) {
    Item& item = coils_.at(coil);
    return Side{item, value, start, item.is_on(), writing.own.coils[coil], single};
  };
  const std::array sides{side_of(kJogForward, write.forward, Command::jog_forward),
                         side_of(kJogReverse, write.reverse, Command::jog_reverse)};

  JogAsks asks;
  const bool both = sides[0].on() && sides[1].on();
  for (const Side& side : sides) {
    if (side.falls() || (both && side.value.value_or(false))) asks.ends = true;
    if (both && side.value.value_or(false) && !side.was_on && (single || !side.first())) asks.ends_run = true;
    if (!both && side.rises()) asks.start = side.start;
    if (!both && side.held()) asks.again = side.start;
    if (side.first()) asks.not_new = true;
  }
  for (const Side& side : sides)
    if (side.value) remember(side.item, *side.value ? 1 : 0, writing);
  return asks;
}

// --- What became of it ---------------------------------------------------------------------------------------------

void EdgeMemory::controlword_done(std::uint64_t request) {
  if (controlword_.request == request) controlword_.done = true;
}

void EdgeMemory::command_done(std::uint64_t request, Command command) {
  if (command_.request == request && command_.value == static_cast<std::uint16_t>(command)) command_.done = true;
  for (const CoilRow& coil : coil_rows()) {
    Item& item = coils_.at(coil.offset);
    if (item.request == request && (item.value != 0 ? coil.on : coil.off) == command) item.done = true;
  }
}

void EdgeMemory::forget_presses(std::uint64_t request, bool sent) {
  const auto forget = [request, sent](Item& item) {
    if (item.request != request || item.done) return;
    item.at = kLongAgo;
    if (!sent) item.acted.reset();
  };
  forget(controlword_);
  forget(command_);
  for (Item& item : coils_) forget(item);
}

void EdgeMemory::disown(std::uint64_t request) {
  for (const CoilRow& coil : coil_rows()) {
    Item& item = coils_.at(coil.offset);
    // A stop is carried out whoever owns the axis.
    if (item.is_on() && item.since == request && !is_stop(coil.on)) item.disowned = true;
  }
}

void EdgeMemory::own(std::uint64_t request) {
  for (Item& item : coils_)
    if (item.request == request) item.disowned = false;
}

}  // namespace axisgate::modbus_tcp
