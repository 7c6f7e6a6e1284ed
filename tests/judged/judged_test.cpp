// SPDX-License-Identifier: Apache-2.0
// Any sequence, every drive: programs drawn from a seed, judged by the reference model; a failing one is shrunk to its
// shortest form. AXISGATE_JUDGED_SEEDS: how many for each drive; AXISGATE_JUDGED_SEED: this one alone;
// AXISGATE_JUDGED_SHRUNK: what it was shrunk to, to repeat that; AXISGATE_JUDGED_TRIES: so often at most a failing one
// is tried shorter.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/judged/drawing.hpp"
#include "tests/judged/play.hpp"

namespace axisgate::test::judged {
namespace {

constexpr std::uint64_t kSeeds = 12;
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
  return name(tested.subject) + (tested.weather == Weather::calm ? "Calm" : "Rough") + (tested.leases ? "Leases" : "");
}
void PrintTo(const Case& tested, std::ostream* out) { *out << name(tested); }

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const Subject subject : kSubjects)
    for (const Weather weather : {Weather::calm, Weather::rough})
      for (const bool leases : {false, true}) out.push_back({subject, weather, leases});
  return out;
}

struct Told {
  std::uint64_t runs = 0, lost = 0, writes = 0, requests = 0, frames = 0;
  std::int64_t virtual_ms = 0;
  Injected injected{};
};

/// How a failing program was made shorter, as numbers that repeat it: which kinds of its nemesis were left out, then
/// which of its ways to be shorter was taken each time. "0.2/3.0.5"
struct Shrunk {
  std::vector<std::size_t> left_out{}, ways{};
};

std::string text(const Shrunk& shrunk) {
  std::ostringstream out;
  const auto list = [&](const std::vector<std::size_t>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) out << (i == 0 ? "" : ".") << numbers[i];
  };
  list(shrunk.left_out);
  out << "/";
  list(shrunk.ways);
  return out.str();
}

Shrunk shrunk_from(const std::string& text) {
  Shrunk out;
  std::vector<std::size_t>* list = &out.left_out;
  std::istringstream in(text);
  for (std::size_t number = 0; in.peek() != std::istringstream::traits_type::eof();) {
    if (in.peek() == '/') list = &out.ways;
    if (in.peek() == '/' || in.peek() == '.')
      in.get();
    else if (in >> number)
      list->push_back(number);
    else
      throw std::invalid_argument("AXISGATE_JUDGED_SHRUNK is two lists of numbers: 0.2/3.0.5");
  }
  return out;
}

Program drawn(const Case& of, std::uint64_t seed, const Shrunk& shrunk) {
  Program program = draw(of.subject, of.weather, of.leases, seed);
  const std::vector<Nemesis> fewer = program.nemesis.with_one_kind_less();
  for (const std::size_t kind : shrunk.left_out) program.nemesis = program.nemesis.common(fewer.at(kind));
  const auto steps = rc::shrinkable::walkPath(steps_of(of.subject, of.weather, seed), shrunk.ways);
  if (!steps) throw std::invalid_argument("AXISGATE_JUDGED_SHRUNK is not of this seed");
  program.steps = steps->value();
  return program;
}

/// The shortest that fails.
Shrunk shortest(const Case& of, std::uint64_t seed) {
  const std::size_t most = number_from("AXISGATE_JUDGED_TRIES", kMostTries);
  std::size_t tries = 0;
  Program program = draw(of.subject, of.weather, of.leases, seed);
  const auto fails = [&] { return ++tries <= most && play(program, seed).violation.has_value(); };
  Shrunk out;
  // What befalls the plant all the time is left out first, kind by kind: steps are read more easily.
  const std::vector<Nemesis> fewer = program.nemesis.with_one_kind_less();
  for (std::size_t kind = 0; kind < fewer.size(); ++kind) {
    const Nemesis before = std::exchange(program.nemesis, program.nemesis.common(fewer[kind]));
    if (fails())
      out.left_out.push_back(kind);
    else
      program.nemesis = before;
  }
  std::size_t way = 0;
  static_cast<void>(
      rc::shrinkable::findLocalMin(steps_of(of.subject, of.weather, seed), [&](const std::vector<Step>& steps) {
        program.steps = steps;
        const bool taken = fails();
        if (taken) out.ways.push_back(std::exchange(way, 0));
        way += taken ? 0 : 1;
        return taken;
      }));
  return out;
}

std::string told(const Program& program, const Outcome& outcome) {
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
  const char* shorter = std::getenv("AXISGATE_JUDGED_SHRUNK");
  Told all;
  for (std::uint64_t seed = from; seed < (only != 0 ? only + 1 : from + seeds); ++seed) {
    const Case& of = GetParam();
    Shrunk shrunk = shrunk_from(shorter == nullptr ? "" : shorter);
    Outcome outcome = play(drawn(of, seed, shrunk), seed);
    all.runs += 1;
    all.lost += outcome.lost_count ? 1 : 0;
    all.writes += outcome.writes;
    all.requests += outcome.traffic.requests;
    all.frames += outcome.traffic.frames;
    all.virtual_ms += outcome.virtual_ms;
    all.injected.add(outcome.injected);
    if (!outcome.violation) continue;
    const std::string violation = *outcome.violation;
    if (shorter == nullptr) {
      shrunk = shortest(of, seed);
      outcome = play(drawn(of, seed, shrunk), seed);
    }
    ADD_FAILURE() << "seed " << seed << ": " << violation << "\n"
                  << told(drawn(of, seed, shrunk), outcome) << "again: AXISGATE_JUDGED_SEED=" << seed
                  << " AXISGATE_JUDGED_SHRUNK=" << text(shrunk)
                  << " build/dev/tests/judged/judged_tests --gtest_filter='*/" << name(of) << "'";
    return;
  }
  std::cout << all.runs << " programs, " << all.writes << " writes, " << all.requests << " requests, " << all.frames
            << " frames, " << all.virtual_ms / 1000 << " virtual s; in " << all.lost
            << " the readings became too many\n"
            << "faults:" << text(all.injected) << "\n";
  // A run in which nothing was judged proves nothing; of a few programs chance decides.
  if (all.runs < kEnough) return;
  EXPECT_LE(2 * all.lost, all.runs);
}

TEST(JudgedRuns, GiveTheSameFramesForTheSameSeedAndOthersForAnother) {
  const auto hash = [](std::uint64_t seed) {
    return play(draw(Subject::jd_rtu, Weather::rough, true, seed), seed).traffic.hash;
  };
  EXPECT_EQ(hash(7), hash(7));
  EXPECT_NE(hash(7), hash(8));
}

TEST(JudgedRuns, AreRepeatedFromTheNumbersOfWhatTheyWereShrunkTo) {
  const Case of{Subject::jd_rtu, Weather::rough, true};
  const Program whole = drawn(of, 7, {});
  const Shrunk shorter{{}, {1, 0}};
  const Shrunk read = shrunk_from(text(shorter));
  EXPECT_EQ(read.left_out, shorter.left_out);
  EXPECT_EQ(read.ways, shorter.ways);
  EXPECT_LT(drawn(of, 7, read).steps.size(), whole.steps.size());
  EXPECT_EQ(text(shrunk_from("0.2/3.0.12")), "0.2/3.0.12");
  EXPECT_THROW(drawn(of, 7, {{}, {1'000'000}}), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Every, Judged, testing::ValuesIn(cases()),
                         [](const auto& tested) { return name(tested.param); });

}  // namespace
}  // namespace axisgate::test::judged
