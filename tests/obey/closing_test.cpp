// SPDX-License-Identifier: Apache-2.0
// The end on purpose (SIGTERM): what clients are told, what the motor does, and whether an idle drive has an alarm
// then.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kEnable = 1, kDisable = 2, kQuickStop = 3, kNeverStarted = 6;

class Closing : public testing::TestWithParam<Subject> {
 protected:
  void start_endless() {
    plant_.ready();
    ASSERT_TRUE(plant_.start_endless(plant_.a));
  }
  void begin_closing() {
    closed_ = false;
    plant_.stage.gateway().close([this] { closed_ = true; });
  }
  [[nodiscard]] bool closes(Duration limit = 3s) {
    return plant_.stage.run_until([this] { return closed_; }, limit);
  }
  /// The process has ended, and nobody speaks to the drive.
  void end() {
    begin_closing();
    ASSERT_TRUE(closes());
    plant_.crash_gateway();
  }
  [[nodiscard]] bool faulted_within(Duration time) {
    return plant_.stage.run_until([this] { return plant_.motor().faulted; }, time);
  }
  Plant plant_{GetParam(), with_leases()};
  bool closed_ = false;
};

// A restart for a new version: each machine that stands idle would have to be reset by hand.
TEST_P(Closing, LeavesNoAlarmOnAnIdleDrive) {
  plant_.ready_but_disabled();
  end();
  EXPECT_FALSE(faulted_within(10s));
  plant_.start_gateway();
  plant_.a.connect();
  ASSERT_TRUE(plant_.stage.come_online());
  EXPECT_FALSE(plant_.motor().faulted);
}

// And the next gateway is missed again.
TEST_P(Closing, TheNextGatewayIsMissedAsBefore) {
  if (!minds_silence(GetParam())) return;
  plant_.ready_but_disabled();
  end();
  plant_.start_gateway();
  plant_.a.connect();
  ASSERT_TRUE(plant_.stage.come_online());
  ASSERT_EQ(plant_.set_endless(plant_.a), kOk);
  ASSERT_EQ(plant_.a.command(kEnable), kOk);
  ASSERT_EQ(plant_.a.command(plant_.endless_command()), kOk);
  ASSERT_TRUE(plant_.turns_within(1s));
  plant_.crash_gateway();
  EXPECT_TRUE(plant_.comes_to_stand(5s));
}

// "An enabled drive stops as if the gateway had died": it moves on, and whoever minds silence stops.
TEST_P(Closing, AMotorThatTurnsIsStoppedByItsDriveAlone) {
  ASSERT_NO_FATAL_FAILURE(start_endless());
  end();
  EXPECT_NE(plant_.velocity(), 0) << "nobody asked for a stop";
  if (minds_silence(GetParam())) {
    EXPECT_TRUE(plant_.comes_to_stand(5s));
  } else {
    EXPECT_TRUE(plant_.keeps_turning());
  }
}

TEST_P(Closing, OnlyStopsAreAccepted) {
  ASSERT_NO_FATAL_FAILURE(start_endless());
  begin_closing();
  EXPECT_EQ(plant_.a.command(0), kOk) << "it asks for nothing";
  EXPECT_EQ(plant_.a.command(plant_.endless_command()), kNotNow);
  EXPECT_EQ(plant_.a.result(), kNeverStarted);
  EXPECT_FALSE(plant_.a.mailbox_write(0x6060, 0, 1, 1)) << "nor by the mailbox";
  EXPECT_EQ(plant_.a.rows(row::command, row::command_id, {{row::command, kQuickStop}, {row::command_id, 7}}), kOk);
  EXPECT_TRUE(plant_.comes_to_stand());
  EXPECT_EQ(plant_.b.command(kDisable), kOk);
  EXPECT_TRUE(closes());
}

// A stop that came first is carried to its end, and then the drive is disabled: no alarm.
TEST_P(Closing, AStopIsAwaited) {
  ASSERT_NO_FATAL_FAILURE(start_endless());
  const auto stop = plant_.a.begin(one(row::command, kDisable));
  end();
  EXPECT_TRUE(plant_.a.answer_of(stop).has_value());
  EXPECT_TRUE(plant_.comes_to_stand());
  const bool armed = plant_.logged("it will stop as if the gateway had died");
  EXPECT_EQ(faulted_within(10s), armed);
}

// What waits for the wire is told so, and does not happen.
TEST_P(Closing, AnEnableThatWaitsNeverStarts) {
  if (!is_cia402(GetParam())) return;  // of the others some have torque at all times
  plant_.ready_but_disabled();
  plant_.run(50ms);
  std::vector<RequestNumber> asked;
  for (const std::int64_t homing_speed : {50'000, 60'000}) asked.push_back(plant_.b.begin(one(58, homing_speed)));
  asked.push_back(plant_.a.begin(one(row::command, kEnable)));
  begin_closing();
  ASSERT_TRUE(closes());
  for (const RequestNumber request : asked) EXPECT_TRUE(plant_.a.answer_of(request) || plant_.b.answer_of(request));
  EXPECT_FALSE(plant_.a.answer_of(asked.back())->ok());
  plant_.crash_gateway();
  EXPECT_FALSE(plant_.stage.run_until([this] { return plant_.motor().enabled.value_or(false); }, 2s));
  EXPECT_FALSE(faulted_within(10s));
}

// One that is under way, whatever of it was sent: told that it was not reached, it leaves no torque behind.
TEST_P(Closing, AnEnableUnderWayIsReachedOrWithdrawn) {
  if (!is_cia402(GetParam())) return;
  constexpr std::uint64_t kExchanges = 40;
  for (std::uint64_t which = 0; which < kExchanges; ++which) {
    SCOPED_TRACE(which);
    Plant plant(GetParam(), with_leases());
    plant.ready_but_disabled();
    const std::uint64_t heard = plant.requests_heard();
    const auto asked = plant.a.begin(one(row::command, kEnable));
    ASSERT_TRUE(plant.stage.run_until([&] { return plant.requests_heard() >= heard + which; }, 3s));
    bool closed = false;
    plant.stage.gateway().close([&] { closed = true; });
    ASSERT_TRUE(plant.stage.run_until([&] { return closed; }, 3s + 1ms));
    const auto answer = plant.a.answer_of(asked);
    ASSERT_TRUE(answer);
    const bool enabled = plant.motor().enabled.value_or(false);
    EXPECT_EQ(enabled, answer->ok());
    plant.crash_gateway();
    if (!enabled) {
      EXPECT_FALSE(plant.stage.run_until([&] { return plant.motor().enabled.value_or(false); }, 2s));
    }
  }
}

// Ended while it brings its drives up, at each exchange of that: none of them misses a gateway that is gone.
TEST_P(Closing, LeavesNoAlarmOnAnIdleDriveThatIsBroughtUp) {
  constexpr std::uint64_t kExchanges = 60;
  for (std::uint64_t which = 1; which < kExchanges; ++which) {
    SCOPED_TRACE(which);
    Plant plant(GetParam(), with_leases());
    const std::uint64_t heard = plant.requests_heard();
    const auto online = [&] { return plant.stage.axis(1).link_state == LinkState::online; };
    if (!plant.stage.run_until([&] { return plant.requests_heard() >= heard + which || online(); }, 10s)) break;
    if (online()) break;
    bool closed = false;
    plant.stage.gateway().close([&] { closed = true; });
    ASSERT_TRUE(plant.stage.run_until([&] { return closed; }, 3s + 1ms));
    plant.crash_gateway();
    EXPECT_FALSE(plant.stage.run_until([&] { return plant.motor().faulted; }, 10s));
  }
}

// The cable is out, the drive unresponsive, a reply lost: it ends in time all the same, and the drive still misses the
// gateway or is disabled.
TEST_P(Closing, EndsInTimeWhateverTheWireDoes) {
  for (const int fault : {0, 1, 2}) {
    Plant plant(GetParam(), with_leases());
    plant.ready();
    bool closed = false;
    if (fault == 0) plant.unplug();
    if (fault == 1) plant.cut_wire();
    plant.run(1ms);
    plant.stage.gateway().close([&] { closed = true; });
    if (fault == 2) static_cast<void>(plant.strike(Strike::lose_reply, 3));
    EXPECT_TRUE(plant.stage.run_until([&] { return closed; }, 3s + 1ms)) << fault;
    plant.crash_gateway();
    if (minds_silence(GetParam()) && is_cia402(GetParam())) {
      plant.run(3s);
      EXPECT_FALSE(plant.motor().enabled.value_or(true)) << "it has missed the gateway " << fault;
    }
  }
}

// Its keypad, or another master, enables it between the two looks.
TEST_P(Closing, WhatIsEnabledMeanwhileStillMissesTheGateway) {
  if (!is_cia402(GetParam()) || !minds_silence(GetParam())) return;
  plant_.ready_but_disabled();
  begin_closing();
  ASSERT_TRUE(plant_.is_enabled_by_hand_once_disarmed());
  ASSERT_TRUE(closes());
  EXPECT_TRUE(plant_.logged("it will stop as if the gateway had died"));
  plant_.crash_gateway();
  EXPECT_TRUE(plant_.motor().enabled.value_or(false));
  EXPECT_TRUE(plant_.stage.run_until([this] { return !plant_.motor().enabled.value_or(true); }, 5s));
}

// Each exchange of the end lost, one after the other.
TEST_P(Closing, NoLostExchangeLeavesAnIdleDriveUncertainOrAnEnabledOneUnwatched) {
  if (!is_cia402(GetParam()) || !minds_silence(GetParam())) return;
  for (const bool enabled : {false, true}) {
    for (const Strike how : {Strike::lose_request, Strike::lose_reply, Strike::late_reply}) {
      constexpr std::uint64_t kExchanges = 8;
      for (std::uint64_t which = 0; which < kExchanges; ++which) {
        Plant plant(GetParam(), with_leases());
        enabled ? plant.ready() : plant.ready_but_disabled();
        bool closed = false;
        const std::uint64_t heard = plant.requests_heard();
        plant.stage.gateway().close([&] { closed = true; });
        EXPECT_TRUE(plant.stage.run_until([&] { return closed || plant.requests_heard() >= heard + which; }, 3s));
        ASSERT_TRUE(plant.strike(how));
        ASSERT_TRUE(plant.stage.run_until([&] { return closed; }, 3s + 1ms));
        plant.crash_gateway();
        plant.run(5s);
        EXPECT_FALSE(plant.motor().enabled.value_or(true)) << which;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Every, Closing, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test::obey
