// SPDX-License-Identifier: Apache-2.0
// Any sequence, every drive: programs drawn from a seed, judged by the reference model; a failing one is shrunk to its
// shortest form. AXISGATE_JUDGED_SEEDS: how many for each drive; AXISGATE_JUDGED_SEED: this one alone, to repeat it;
// AXISGATE_JUDGED_TRIES: so often at most a failing one is tried shorter.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>
#include <iostream>
#include <utility>

#include "tests/judged/drawing.hpp"
#include "tests/judged/play.hpp"

namespace axisgate::test::judged {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr std::uint64_t kSeeds = 2;  // they take six times as long
#else
constexpr std::uint64_t kSeeds = 12;
#endif
constexpr std::size_t kMostTries = 400;  // of shrinking
constexpr std::uint64_t kEnough = 10;

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* value = std::getenv(variable);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

struct Case {
  Subject subject;
  Weather weather;
  bool leases;
};

std::string name(const Case& tested) {
  return obey::name(tested.subject) + (tested.weather == Weather::calm ? "Calm" : "Rough") +
         (tested.leases ? "Leases" : "");
}
void PrintTo(const Case& tested, std::ostream* out) { *out << name(tested); }

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const Subject subject : obey::kSubjects)
    for (const Weather weather : {Weather::calm, Weather::rough})
      for (const bool leases : {false, true}) out.push_back({subject, weather, leases});
  return out;
}

struct Told {
  std::uint64_t runs = 0, lost = 0, writes = 0, requests = 0, frames = 0;
  std::int64_t virtual_ms = 0;
  Injected injected{};
};

/// The shortest that fails, and what it does.
std::string shortest(const Case& of, std::uint64_t seed) {
  const std::size_t most = number_from("AXISGATE_JUDGED_TRIES", kMostTries);
  std::size_t tries = 0;
  Program program = draw(of.subject, of.weather, of.leases, seed);
  const auto fails = [&](const std::vector<Step>& steps) {
    if (++tries > most) return false;
    program.steps = steps;
    return play(program, seed).violation.has_value();
  };
  // What befalls the plant all the time is left out first, kind by kind: steps are read more easily.
  for (const Nemesis& fewer : program.nemesis.with_one_kind_less()) {
    const Nemesis before = std::exchange(program.nemesis, program.nemesis.common(fewer));
    if (!fails(program.steps)) program.nemesis = before;
  }
  const auto [steps, ways] = rc::shrinkable::findLocalMin(steps_of(of.subject, of.weather, seed), fails);
  program.steps = steps;
  const Outcome outcome = play(program, seed);
  std::string out = text(program.nemesis) + "\n";
  for (const std::string& line : outcome.story) out += line + "\n";
  out += "# the last second\n";
  for (const std::string& line : outcome.last_second) out += line + "\n";
  return out;
}

class Judged : public testing::TestWithParam<Case> {};

TEST_P(Judged, DoesWhatTheContractAllows) {
  const std::uint64_t only = number_from("AXISGATE_JUDGED_SEED", 0);
  const std::uint64_t seeds = number_from("AXISGATE_JUDGED_SEEDS", kSeeds);
  const std::uint64_t from = only != 0 ? only : number_from("AXISGATE_JUDGED_FROM", 1);
  Told told;
  for (std::uint64_t seed = from; seed < (only != 0 ? only + 1 : from + seeds); ++seed) {
    const Case& of = GetParam();
    const Outcome outcome = play(draw(of.subject, of.weather, of.leases, seed), seed);
    told.runs += 1;
    told.lost += outcome.lost_count ? 1 : 0;
    told.writes += outcome.writes;
    told.requests += outcome.traffic.requests;
    told.frames += outcome.traffic.frames;
    told.virtual_ms += outcome.virtual_ms;
    told.injected.add(outcome.injected);
    if (!outcome.violation) continue;
    ADD_FAILURE() << "seed " << seed << ": " << *outcome.violation << "\n"
                  << shortest(of, seed) << "again: AXISGATE_JUDGED_SEED=" << seed
                  << " build/dev/tests/judged/judged_tests --gtest_filter='*/" << name(of) << "'";
    return;
  }
  std::cout << told.runs << " programs, " << told.writes << " writes, " << told.requests << " requests, " << told.frames
            << " frames, " << told.virtual_ms / 1000 << " virtual s; in " << told.lost
            << " the readings became too many\n"
            << "faults:" << text(told.injected) << "\n";
  // A run in which nothing was judged proves nothing; of a few programs chance decides.
  if (told.runs < kEnough) return;
  EXPECT_LE(2 * told.lost, told.runs);
}

TEST(JudgedRuns, GiveTheSameFramesForTheSameSeedAndOthersForAnother) {
  const auto hash = [](std::uint64_t seed) {
    return play(draw(Subject::jd_rtu, Weather::rough, true, seed), seed).traffic.hash;
  };
  EXPECT_EQ(hash(7), hash(7));
  EXPECT_NE(hash(7), hash(8));
}

INSTANTIATE_TEST_SUITE_P(Every, Judged, testing::ValuesIn(cases()),
                         [](const auto& tested) { return name(tested.param); });

}  // namespace
}  // namespace axisgate::test::judged
