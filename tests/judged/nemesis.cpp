// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/nemesis.hpp"

#include <algorithm>

#include "tests/judged/cable_words.hpp"

namespace axisgate::test::judged {
namespace {

using obey::Strike;

constexpr std::array<const char*, obey::kStrikes.size()> kNamesOfStrikes{
    "request lost", "reply lost",  "late",   "doubled",      "noise before", "noise after",   "bit flipped",
    "split",        "emergencies", "babble", "half a reply", "wrong length", "wrong station", "glued"};

/// Strikes at each exchange: those that come unasked are none.
constexpr std::array kRated{Strike::lose_request, Strike::lose_reply,   Strike::late_reply,    Strike::double_reply,
                            Strike::noise_before, Strike::noise_after,  Strike::flip_bit,      Strike::split_reply,
                            Strike::half_reply,   Strike::wrong_length, Strike::wrong_station, Strike::glued_reply};
constexpr std::array kSaysMore{Strike::double_reply, Strike::noise_before, Strike::noise_after, Strike::split_reply,
                               Strike::glued_reply};

}  // namespace

bool Nemesis::says_twice() const {
  return std::ranges::any_of(kSaysMore, [this](Strike how) { return strike(how) > 0; });
}

std::vector<Nemesis> Nemesis::with_one_kind_less() const {
  std::vector<Nemesis> out;
  const auto without = [&](auto&& change) {
    Nemesis fewer = *this;
    change(fewer);
    out.push_back(fewer);
  };
  for (std::size_t i = 0; i < strikes.size(); ++i)
    if (strikes[i] > 0) without([i](Nemesis& fewer) { fewer.strikes[i] = 0; });
  if (soup > 0) without([](Nemesis& fewer) { fewer.soup = 0; });
  if (storm > 0) without([](Nemesis& fewer) { fewer.storm = 0; });
  if (stall > 0) without([](Nemesis& fewer) { fewer.stall = 0; });
  return out;
}

Nemesis Nemesis::common(const Nemesis& other) const {
  Nemesis out = *this;
  for (std::size_t i = 0; i < strikes.size(); ++i) out.strikes[i] = std::min(strikes[i], other.strikes[i]);
  out.soup = std::min(soup, other.soup);
  out.storm = std::min(storm, other.storm);
  out.stall = std::min(stall, other.stall);
  return out;
}

Nemesis draw_nemesis(Subject subject, std::uint64_t seed) {
  constexpr std::array kRates{0.02, 0.1, 0.3, 1.0};  // the last one: a drive that always does it
  constexpr std::array<std::int64_t, 5> kLateMs{20, 60, 150, 400, 900};
  constexpr std::uint64_t kApart = 64, kKinds = 5;
  simulated::Random random(~(seed * kApart + static_cast<std::uint64_t>(subject)));
  Nemesis out;
  if (random.chance(0.25)) return out;
  out.from_ms = static_cast<std::int64_t>(random.below(15'000));
  out.until_ms = out.from_ms + 1'000 + static_cast<std::int64_t>(random.below(5'000));
  const bool has_sum = tongue_of(subject) != Tongue::keya_rs232;
  for (std::uint64_t kinds = random.below(3); kinds > 0; --kinds) {
    const Strike how = kRated.at(random.below(kRated.size()));
    if (has_sum || how == Strike::lose_request || how == Strike::lose_reply || how == Strike::late_reply)
      out.strikes.at(static_cast<std::size_t>(how)) = kRates.at(random.below(kRates.size()));
  }
  out.late_by = std::chrono::milliseconds(kLateMs.at(random.below(kLateMs.size())));
  // Late and twice: a reply to a read says nothing of where it was read. Drawn by itself, so that the rest is as
  // before.
  simulated::Random pair(seed * kApart + static_cast<std::uint64_t>(subject));
  if (tongue_of(subject) == Tongue::rtu && pair.chance(0.3)) {
    for (const Strike how : {Strike::late_reply, Strike::double_reply})
      out.strikes.at(static_cast<std::size_t>(how)) = kRates.at(pair.below(kRates.size()));
  }
  switch (random.below(kKinds)) {
    case 0:
      out.soup = 0.05;
      break;
    case 1:
      out.storm = 0.005;
      break;
    case 2:
      out.stall = 0.003;
      out.longest_stall_ms = 500 + static_cast<std::int64_t>(random.below(2'500));
      break;
    default:
      break;
  }
  return out;
}

std::string text(const Nemesis& nemesis) {
  if (nemesis.until_ms == 0) return "no nemesis";
  std::string out =
      "nemesis from " + std::to_string(nemesis.from_ms) + " to " + std::to_string(nemesis.until_ms) + " ms:";
  const auto kind = [&out](const char* name, double rate) {
    if (rate > 0) out += std::string(" ") + name + " " + std::to_string(rate).substr(0, 5);
  };
  for (std::size_t i = 0; i < nemesis.strikes.size(); ++i) kind(kNamesOfStrikes.at(i), nemesis.strikes[i]);
  if (nemesis.strike(Strike::late_reply) > 0)
    out +=
        " by " + std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(nemesis.late_by).count()) + " ms";
  kind("soup", nemesis.soup);
  kind("storm", nemesis.storm);
  kind("stall", nemesis.stall);
  return out;
}

void Injected::add(const Injected& more) {
  for (std::size_t i = 0; i < strikes.size(); ++i) strikes[i] += more.strikes[i];
  soup += more.soup;
  storm += more.storm;
  stall += more.stall;
}

std::string text(const Injected& injected) {
  std::string out;
  const auto kind = [&out](const char* name, std::uint64_t count) {
    if (count > 0) out += std::string(out.empty() ? " " : ", ") + name + " " + std::to_string(count);
  };
  for (std::size_t i = 0; i < injected.strikes.size(); ++i) kind(kNamesOfStrikes.at(i), injected.strikes[i]);
  kind("soup", injected.soup);
  kind("storms", injected.storm);
  kind("stalls", injected.stall);
  return out.empty() ? " none" : out;
}

}  // namespace axisgate::test::judged
