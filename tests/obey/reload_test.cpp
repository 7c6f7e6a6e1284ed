// SPDX-License-Identifier: Apache-2.0
// A reload: what becomes of a bus that changes, of its motor and of its clients; and that a refused one changes
// nothing.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kEnable = 1, kDisable = 2, kNeverStarted = 6;
constexpr Duration kBoth = 2 * compose::kBusReleaseStep;

void change_timeout(config::Config& config) { config.buses.at(0).timeout += 1ms; }
void take_out(config::Config& config) { config.buses.clear(); }

using ReloadEnd = std::shared_ptr<std::optional<GatewayStage::Reasons>>;

/// The reasons, where it was refused.
GatewayStage::Reasons ended(Plant& plant, const ReloadEnd& told) {
  EXPECT_TRUE(plant.stage.run_until([&] { return told->has_value(); }, kBoth + 10ms));
  return told->value_or(GatewayStage::Reasons{"it never ended"});
}
GatewayStage::Reasons reload(Plant& plant, const std::function<void(config::Config&)>& change = change_timeout) {
  return ended(plant, plant.stage.begin_reload(change));
}

void make_it_turn(Plant& plant) {
  ASSERT_TRUE(plant.stage.come_online());
  ASSERT_EQ(plant.a.command(0), kOk);  // the same number again would be no new command
  ASSERT_EQ(plant.set_endless(plant.a), kOk);
  ASSERT_EQ(plant.a.command(kEnable), kOk);
  ASSERT_EQ(plant.a.command(plant.endless_command()), kOk);
  ASSERT_TRUE(plant.turns_within(1s));
}

/// A client can have it turn, and then disable it.
void expect_in_command(Plant& plant) {
  ASSERT_NO_FATAL_FAILURE(make_it_turn(plant));
  EXPECT_EQ(plant.a.command(kDisable), kOk);
  EXPECT_TRUE(plant.comes_to_stand());
}
/// Whoever minds silence stops when the gateway dies.
void expect_watched(Plant& plant) {
  ASSERT_NO_FATAL_FAILURE(make_it_turn(plant));
  plant.crash_gateway();
  if (minds_silence(plant.subject)) {
    EXPECT_TRUE(plant.comes_to_stand(5s));
  }
}

class Reload : public testing::TestWithParam<Subject> {
 protected:
  void start_endless() {
    plant_.ready();
    ASSERT_TRUE(plant_.start_endless(plant_.a));
  }
  /// Some have torque at all times: nobody can tell that they are disabled.
  [[nodiscard]] bool can_be_disabled() {
    plant_.ready_but_disabled();
    plant_.run(100ms);
    return plant_.a.word(shown::axis_state) == 0;
  }
  Plant plant_{GetParam(), with_leases()};
};

TEST_P(Reload, ABusOfDisabledAxesIsRestarted) {
  if (!can_be_disabled()) return;
  EXPECT_EQ(reload(plant_), GatewayStage::Reasons{});
  EXPECT_FALSE(plant_.motor().enabled.value_or(false));
  ASSERT_TRUE(plant_.stage.come_online());
  EXPECT_FALSE(plant_.motor().faulted) << "it has not missed the gateway";
  expect_in_command(plant_);
  expect_watched(plant_);
}

TEST_P(Reload, ATurningMotorRefusesItAndTurnsOn) {
  ASSERT_NO_FATAL_FAILURE(start_endless());
  EXPECT_NE(reload(plant_), GatewayStage::Reasons{});
  EXPECT_TRUE(plant_.keeps_turning());
  EXPECT_EQ(plant_.a.command(kDisable), kOk);
  EXPECT_TRUE(plant_.comes_to_stand());
  expect_in_command(plant_);
  expect_watched(plant_);
}

TEST_P(Reload, AnEnabledMotorThatStandsRefusesIt) {
  plant_.ready();
  EXPECT_NE(reload(plant_), GatewayStage::Reasons{});
  expect_in_command(plant_);
}

// What its motor does nobody knows.
TEST_P(Reload, ADriveOutOfReachRefusesIt) {
  plant_.ready_but_disabled();
  plant_.cut_wire();
  EXPECT_NE(reload(plant_), GatewayStage::Reasons{}) << "it has only just gone";
  plant_.run(10s);
  EXPECT_NE(reload(plant_), GatewayStage::Reasons{});
  EXPECT_NE(reload(plant_, take_out), GatewayStage::Reasons{});
  plant_.mend_wire();
  EXPECT_TRUE(plant_.stage.come_online());
}

// Whatever is under way when the gate closes: no motor is enabled on a bus that was let go, and none is lost.
TEST_P(Reload, AnEnableAtTheSameTimeIsSeenOrNeverStarts) {
  if (!can_be_disabled()) return;
  for (std::uint64_t heard = 0; heard < 12; ++heard) {
    for (const bool enable_first : {false, true}) {
      Plant plant(GetParam(), with_leases());
      plant.ready_but_disabled();
      plant.run(100ms);
      ReloadEnd told;
      const auto wait_for = [&](std::uint64_t more) {
        static_cast<void>(plant.stage.run_until(
            [&, until = plant.requests_heard() + more] { return plant.requests_heard() >= until; }, 100ms));
      };
      if (!enable_first) told = plant.stage.begin_reload(change_timeout);
      if (!enable_first) wait_for(heard);
      const bool ended_before = told && told->has_value();
      const auto enable = plant.a.begin(one(row::command, kEnable));
      if (enable_first) wait_for(heard);
      if (enable_first) told = plant.stage.begin_reload(change_timeout);
      const bool let_go = ended(plant, told).empty();
      plant.run(1s);
      ASSERT_TRUE(plant.a.answer_of(enable)) << heard;
      // One that the restarted bus is asked for is another matter.
      if (let_go && !ended_before) {
        EXPECT_FALSE(plant.motor().enabled.value_or(false)) << heard << enable_first;
        EXPECT_FALSE(plant.a.answer_of(enable)->ok()) << heard << enable_first;
      }
      ASSERT_NO_FATAL_FAILURE(expect_in_command(plant)) << heard;
    }
  }
}

TEST_P(Reload, OnlyStopsAreAcceptedMeanwhile) {
  if (!can_be_disabled()) return;
  const ReloadEnd told = plant_.stage.begin_reload(change_timeout);
  ASSERT_TRUE(plant_.stage.run_until(
      [&, until = plant_.requests_heard() + 1] { return plant_.requests_heard() >= until; }, 100ms));
  if (!told->has_value()) {
    EXPECT_EQ(plant_.a.command(kEnable), kNotNow);
    EXPECT_EQ(plant_.a.result(), kNeverStarted);
  }
  EXPECT_EQ(ended(plant_, told), GatewayStage::Reasons{});
  expect_in_command(plant_);
}

// Its keypad enables it between the two steps: the reload is refused, and the drive still misses a dead gateway.
TEST_P(Reload, WhatIsEnabledMeanwhileStillMissesTheGateway) {
  if (!is_cia402(GetParam()) || !minds_silence(GetParam())) return;
  plant_.ready_but_disabled();
  const ReloadEnd told = plant_.stage.begin_reload(change_timeout);
  ASSERT_TRUE(plant_.is_enabled_by_hand_once_disarmed());
  EXPECT_NE(ended(plant_, told), GatewayStage::Reasons{});
  plant_.run(1s);
  EXPECT_TRUE(plant_.motor().enabled.value_or(false));
  plant_.crash_gateway();
  EXPECT_TRUE(plant_.stage.run_until([this] { return !plant_.motor().enabled.value_or(true); }, 5s));
}

// Each exchange of it lost, one after the other: done or refused, the drive is commanded and watched as before.
TEST_P(Reload, NoLostExchangeLeavesTheDriveUnwatched) {
  if (!can_be_disabled()) return;
  for (const Strike how : {Strike::lose_request, Strike::lose_reply, Strike::late_reply}) {
    constexpr std::uint64_t kExchanges = 8;
    for (std::uint64_t which = 0; which < kExchanges; ++which) {
      Plant plant(GetParam(), with_leases());
      plant.ready_but_disabled();
      plant.run(100ms);
      const std::uint64_t heard = plant.requests_heard();
      const ReloadEnd told = plant.stage.begin_reload(change_timeout);
      static_cast<void>(
          plant.stage.run_until([&] { return told->has_value() || plant.requests_heard() >= heard + which; }, kBoth));
      if (!plant.strike(how)) return;
      static_cast<void>(ended(plant, told));
      plant.run(5s);
      EXPECT_FALSE(plant.motor().enabled.value_or(false)) << which;
      ASSERT_NO_FATAL_FAILURE(expect_watched(plant)) << which;
    }
  }
}

// The process is asked to end while it reloads.
TEST_P(Reload, AnEndMeanwhileEndsInTime) {
  for (int ms = 0; ms < 40; ms += 2) {
    Plant plant(GetParam(), with_leases());
    plant.ready_but_disabled();
    const ReloadEnd told = plant.stage.begin_reload(change_timeout);
    plant.run(std::chrono::milliseconds(ms));
    bool closed = false;
    plant.stage.gateway().close([&] { closed = true; });
    EXPECT_TRUE(plant.stage.run_until([&] { return closed; }, compose::kClosing + 1ms)) << ms;
    plant.crash_gateway();
    plant.run(5s);
    EXPECT_FALSE(plant.motor().enabled.value_or(false) && minds_silence(GetParam()) && is_cia402(GetParam())) << ms;
  }
}

TEST_P(Reload, AnAxisThatIsTakenOutIsGoneAndComesBackAnew) {
  if (!can_be_disabled()) return;
  ASSERT_EQ(plant_.a.command(kEnable, 7), kOk);
  ASSERT_EQ(plant_.a.command(kDisable, 8), kOk);
  plant_.run(1s);
  const std::vector<std::uint16_t> before = plant_.a.read(shown::axis_state, 1);
  ASSERT_EQ(before.size(), 1U);
  config::Config with;
  EXPECT_EQ(reload(plant_,
                   [&](config::Config& config) {
                     with = config;
                     take_out(config);
                   }),
            GatewayStage::Reasons{});
  EXPECT_EQ(plant_.a.row(row::command, kEnable), kNoSuchRow);
  plant_.run(5s);
  EXPECT_FALSE(plant_.motor().faulted) << "it was told not to miss the gateway";
  EXPECT_EQ(reload(plant_, [&](config::Config& config) { config = with; }), GatewayStage::Reasons{});
  ASSERT_TRUE(plant_.stage.come_online());
  EXPECT_FALSE(plant_.motor().enabled.value_or(false));
  expect_in_command(plant_);
}

// A PLC that scans its block all the time: nothing in it is a new command, before, during or after.
TEST_P(Reload, ACyclicScannerEnablesNothingByIt) {
  if (!can_be_disabled()) return;
  const Write scanned = block(row::command, row::command_id, {{row::command, kEnable}, {row::command_id, 7}});
  ASSERT_EQ(plant_.a.write(scanned), kOk);
  ASSERT_EQ(plant_.b.command(kDisable), kOk);
  ASSERT_TRUE(plant_.stage.run_until([this] { return !plant_.motor().enabled.value_or(false); }, 2s));
  plant_.scan(plant_.a, scanned, 500ms);
  ASSERT_FALSE(plant_.motor().enabled.value_or(false));
  const ReloadEnd told = plant_.stage.begin_reload(change_timeout);
  plant_.scan(plant_.a, scanned, 3s);
  EXPECT_EQ(ended(plant_, told), GatewayStage::Reasons{});
  EXPECT_FALSE(plant_.motor().enabled.value_or(false));
}

// Reasons that come last, of a listener say, leave all as it was.
TEST_P(Reload, ALastWordRefusesIt) {
  if (!can_be_disabled()) return;
  const ReloadEnd told = plant_.stage.begin_reload(change_timeout, [] { return GatewayStage::Reasons{"no"}; });
  EXPECT_EQ(ended(plant_, told), GatewayStage::Reasons{"no"});
  expect_in_command(plant_);
  expect_watched(plant_);
}

// "A bus whose section did not change is not touched, not one request": the frames of the other bus, and when they were
// asked, are those of a gateway that nobody has reload; its clients command it on meanwhile.
TEST(ReloadOfTwoBuses, TheOtherBusSeesNotOneRequestMoreOrLess) {
  struct Seen {
    std::vector<std::string> frames;
    std::vector<std::uint64_t> requests;  ///< after each millisecond
    std::vector<Errc> results;
  };
  enum class What { nothing, changed, removed, refused };
  const auto see = [](std::vector<GatewayStage::Line> lines, What what) {
    const std::string other = lines.at(1).name;
    GatewayStage stage(std::move(lines));
    EXPECT_TRUE(stage.come_online());
    EXPECT_EQ(stage.command(1, what == What::refused ? Command::enable : Command::disable).outcome.code, Errc::ok);
    stage.run(1s);
    stage.gateway().bus(1).set_decode(true);
    stage.log().clear();
    Seen seen;
    std::shared_ptr<std::optional<GatewayStage::Reasons>> told;
    for (int ms = 0; ms < 3000; ++ms) {
      if (ms == 500 && what == What::removed)
        told = stage.begin_reload([](config::Config& config) { config.buses.erase(config.buses.begin()); });
      if (ms == 500 && (what == What::changed || what == What::refused)) told = stage.begin_reload(change_timeout);
      if (ms == 400 || ms == 600)
        seen.results.push_back(stage.command(2, ms == 400 ? Command::enable : Command::disable).outcome.code);
      stage.run(1ms);
      const std::size_t place = what == What::removed && ms >= 1500 ? 0 : 1;
      if (ms < 500 || ms >= 1500) seen.requests.push_back(stage.gateway().bus(place).statistics().requests);
    }
    EXPECT_TRUE(!told || told->value().empty() == (what != What::refused));
    for (const std::string& line : stage.log())
      if (line.find(" bus " + other + ": ") != std::string::npos) seen.frames.push_back(line);
    return seen;
  };
  const auto kinds = [] {
    std::vector<GatewayStage::Line> lines{line_of(simulated::KincoType::jd, 1), line_of(simulated::KincoType::md, 2),
                                          can_line_of({{}}, 2)};
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i].name = "line-" + std::to_string(i);
    return lines;
  }();
  for (const std::size_t other : {1U, 2U}) {
    const Seen alone = see({kinds[0], kinds[other]}, What::nothing);
    ASSERT_GT(alone.frames.size(), 100U);
    for (const What what : {What::changed, What::removed, What::refused}) {
      const Seen with = see({kinds[0], kinds[other]}, what);
      EXPECT_EQ(with.results, alone.results) << other;
      EXPECT_EQ(with.requests, alone.requests) << other;
      EXPECT_EQ(with.frames, alone.frames) << other;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Every, Reload, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test::obey
