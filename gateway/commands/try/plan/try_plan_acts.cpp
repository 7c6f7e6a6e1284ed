// SPDX-License-Identifier: Apache-2.0
// The acts of a trial's steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/commands/try/plan/try_plan.hpp"

namespace axisgate::commands {
namespace {

std::string name_of(const Write& write) {
  if (write.command != Command::none) return std::string(text(write.command));
  return write.setpoints.empty() ? "nothing" : std::string(row(write.setpoints.front().quantity).name);
}

std::string outcome_text(const BatchResult& result) {
  std::string out(text(result.outcome.code));
  if (result.outcome.detail != 0) out += fmt::format(", detail {:#x}", result.outcome.detail);
  if (!result.limit.empty()) out += fmt::format(" (limit {})", result.limit);
  return out;
}

bool is_limit(Quantity quantity) {
  return quantity != Quantity::target_position && quantity != Quantity::target_velocity &&
         quantity != Quantity::target_torque;
}

std::string torque_text(const AxisImage& image) { return may_hold_torque(image) ? "energised" : "without torque"; }

std::int64_t counted(std::uint32_t from, std::uint32_t to) { return static_cast<std::int32_t>(to - from); }

}  // namespace

void TryPlan::look_at_acts(const TryLook& look, Instant now) {
  if (acts_.empty()) return close_step(Verdict::right);
  if (!doing_.begun) doing_ = {.since = now};
  const Act now_doing = acts_.front();
  const bool done = std::visit([&](const auto& it) { return act(it, look, now); }, now_doing);
  doing_.begun = true;
  if (!done || !report_.ended.empty()) return;
  acts_.pop_front();
  doing_ = {};
}

std::optional<std::string> TryPlan::typed(std::string_view prompt, Instant now) {
  if (!doing_.begun) {
    say(fmt::format("  {}", prompt));
    person_ = {.asked = true, .questions = person_.questions + 1};
    patience_ = now + kPersonLimit;
    return std::nullopt;
  }
  if (!person_.line) {
    if (now >= patience_) end("nobody answered");
    return std::nullopt;
  }
  person_.asked = false;
  auto line = *std::exchange(person_.line, std::nullopt);
  if (!line) end("the input ended");
  return line;
}

bool TryPlan::act(const Consent& /*act*/, const TryLook& look, Instant now) {
  const std::string word = fmt::format("{} {}", arguments_.axis, text(step_.step));
  const auto line = typed(fmt::format("type \"{}\" to go on; anything else ends it", word), now);
  if (!line) return false;
  if (*line != word) end(fmt::format("\"{}\" is not \"{}\"", *line, word));
  if (!look.image.reachable()) wrong("the drive does not answer any more");
  if (look.image.has(AxisInput::enabled)) wrong("the axis was enabled meanwhile, not by this command");
  return true;
}

bool TryPlan::act(const Question& act, const TryLook& /*look*/, Instant now) {
  const auto line = typed(fmt::format("{}? yes or no; anything else ends it", act.words), now);
  if (!line) return false;
  if (*line == "yes" || *line == "no") see(fmt::format("{}: the person says {}", act.words, *line));
  if (*line == "no") wrong("not what it should be, says who watched it");
  if (*line != "yes" && *line != "no") end(fmt::format("\"{}\" is neither yes nor no", *line));
  return true;
}

bool TryPlan::act(const TurnByPerson& /*act*/, const TryLook& look, Instant now) {
  const Turned at{turns_of(look.image), look.raw_position};
  if (!doing_.begun) doing_.from = at;
  const auto line = typed(
      "turn the shaft by one turn clockwise, as seen onto its end, then press Enter; \"skip\" leaves this out", now);
  if (!line) return false;
  if (*line == "skip") {
    see("left out");
    acts_.clear();
    close_step(Verdict::not_tried);
    return false;
  }
  if (!line->empty()) {
    end(fmt::format("\"{}\" is neither Enter nor skip", *line));
    return false;
  }
  judge_turn(at);
  return true;
}

void TryPlan::judge_turn(const Turned& to) {
  const Turned& from = doing_.from;
  if (!from.raw || !to.raw) return wrong("the position could not be read");
  const std::int64_t counts = counted(*from.raw, *to.raw);
  see(fmt::format("the drive counted {} {}", std::abs(counts), counts < 0 ? "down" : "up"));
  if (!from.turns || !to.turns) return wrong(fmt::format("the counts of a turn are not known: {}?", std::abs(counts)));
  const double turns = *to.turns - *from.turns;
  if (std::abs(std::abs(turns) - 1) <= MotionCheck::kWithin)
    return see(turns < 0 ? "clockwise counts down: \"inverted\" of the axis turns that round"
                         : "one turn clockwise counts up");
  const double per_turn = turns == 0 ? 0 : std::abs(static_cast<double>(counts) / turns);
  const double other = std::abs(static_cast<double>(counted(other_order(*from.raw), other_order(*to.raw))));
  if (per_turn > 0 && std::abs(other / per_turn - 1) <= MotionCheck::kWithin)
    return wrong(
        fmt::format("in the other word order it is one turn ({:.0f} counts): is low_word_first wrong?", other));
  wrong(fmt::format("that is {:.4g} turns: a turn has {} counts, the profile says {:.0f}", turns, std::abs(counts),
                    per_turn));
}

void TryPlan::write(const Write& write, const TryLook& look, Instant now) {
  Write out = write;
  if (out.command == Command::move_absolute)
    for (Setpoint& setpoint : out.setpoints)
      if (setpoint.quantity == Quantity::target_position) setpoint.value += look.image[Quantity::position_actual].value;
  keep_before(out, look.image);
  torque_ = torque_ || out.command == Command::enable;
  order({.kind = TryOrder::Kind::write, .write = std::move(out)}, now);
}

void TryPlan::keep_before(const Write& write, const AxisImage& image) {
  for (const Setpoint& setpoint : write.setpoints) {
    const Sample& sample = image[setpoint.quantity];
    const bool kept = std::ranges::any_of(before_, [&](const Setpoint& s) { return s.quantity == setpoint.quantity; });
    if (is_limit(setpoint.quantity) && sample.valid && !kept) before_.push_back({setpoint.quantity, sample.value});
  }
  std::ranges::sort(before_, {}, &Setpoint::quantity);
}

bool TryPlan::act(const Write& act, const TryLook& look, Instant now) {
  if (act.command == Command::none && act.setpoints.empty()) return true;
  if (!doing_.begun) {
    write(act, look, now);
    return false;
  }
  const auto result = answer(now);
  if (!result) return false;
  const bool ok = result->outcome.code == Errc::ok;
  if (!ok && !act.may_fail) wrong(fmt::format("{}: {}", name_of(act), outcome_text(*result)));
  if (ok && act.command == Command::disable) torque_ = false;
  return true;
}

bool TryPlan::act(const Hold& act, const TryLook& look, Instant now) {
  const Turned at{turns_of(look.image), {}};
  if (!doing_.begun) doing_.from = at;
  if (!look.image.reachable()) wrong("the drive fell silent");
  if (!look.image.has(AxisInput::enabled)) wrong("the axis lost its torque while it was held");
  if (doing_.from.turns && at.turns && std::abs(*at.turns - *doing_.from.turns) > kHeld)
    wrong(fmt::format("the shaft moved by {:.3g} turns while it was held", *at.turns - *doing_.from.turns));
  if (now - doing_.since < act.time || !report_.ended.empty()) return false;
  if (doing_.from.turns && at.turns)
    see(fmt::format("held for {:.3g} s, the shaft moved by {:.2g} turns", in_seconds(act.time),
                    std::abs(*at.turns - *doing_.from.turns)));
  return true;
}

bool TryPlan::act(const Motion& act, const TryLook& look, Instant now) {
  if (!doing_.begun) {
    write(act.start, look, now);
    MotionAsked asked = act.asked;
    asked.id = id_;
    doing_.motion.emplace(asked, now);
    static_cast<void>(doing_.motion->look(look.image, now));  // where it was before
    return false;
  }
  if (const auto result = waits_for_ ? answer(now) : std::nullopt; result && result->outcome.code != Errc::ok)
    wrong(fmt::format("{}: {}", name_of(act.start), outcome_text(*result)));
  const MotionCheck::Says says = doing_.motion->look(look.image, now);
  if (says == MotionCheck::Says::goes_on) return false;
  if (act.asked.judged || says == MotionCheck::Says::stop) see(doing_.motion->seen());
  if (!doing_.motion->why().empty()) wrong(doing_.motion->why());
  return true;
}

bool TryPlan::stood(std::string_view by, Duration limit, const TryLook& look, Instant now) {
  // A position that does not change is sampled once a second.
  constexpr Duration kTwoSamples = std::chrono::seconds(3);
  doing_.standstill->look(look.image);
  const Duration took = doing_.standstill->turned() - doing_.since;
  if (!look.image.supports(Quantity::position_actual)) return now - doing_.since >= limit;
  if (took > limit) {
    wrong(fmt::format("{}: the motor did not stand within {:.3g} s", by, in_seconds(limit)));
  } else if (doing_.standstill->stands()) {
    see(fmt::format("{}: it stood after {:.2g} s, {}", by, in_seconds(took), torque_text(look.image)));
    return true;
  } else if (now - doing_.since >= limit + kTwoSamples) {
    wrong(fmt::format("{}: the motor was not seen to stand", by));
  }
  return false;
}

bool TryPlan::act(const Stop& act, const TryLook& look, Instant now) {
  if (!doing_.begun) {
    write({.command = act.command}, look, now);
    doing_.standstill.emplace(now);
    return false;
  }
  if (const auto result = waits_for_ ? answer(now) : std::nullopt; result && result->outcome.code != Errc::ok)
    wrong(fmt::format("{}: {}", text(act.command), outcome_text(*result)));
  doing_.stood = doing_.stood || stood(text(act.command), act.limit, look, now);
  return doing_.stood && !waits_for_;
}

bool TryPlan::act(const Withhold& act, const TryLook& look, Instant now) {
  if (!doing_.begun) {
    see(fmt::format("heartbeats are withheld; the profile says {:.3g} s", in_seconds(act.after)));
    order({.kind = TryOrder::Kind::withhold}, now);
    doing_.standstill.emplace(now);
    return false;
  }
  if (!stood("without heartbeats", act.limit, look, now)) return false;
  order({.kind = TryOrder::Kind::resume}, now);
  return true;
}

}  // namespace axisgate::commands
