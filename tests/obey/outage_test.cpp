// SPDX-License-Identifier: Apache-2.0
// That each outage does to the motor and to the wire what it says, and no more, on every drive and protocol.
#include <gtest/gtest.h>

#include <functional>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kLinkState = 18;
constexpr std::uint16_t kOnline = 2, kLinkDown = 5;
constexpr std::int64_t kErrorStop = 6;

/// Commands go as process data, which no strike hits.
bool commands_by_pdo(Subject s) { return s == Subject::jd_can || s == Subject::md_can || s == Subject::leadshine; }

/// Whatever silences the gateway, and its end.
struct Silence {
  const char* name;
  std::function<void(Plant&)> begins;
  std::function<void(Plant&)> ends;
};
const std::vector<Silence> kSilences{
    {"the wire is cut", [](Plant& p) { p.cut_wire(); }, [](Plant& p) { p.mend_wire(); }},
    {"the port is gone", [](Plant& p) { p.unplug(); }, [](Plant& p) { p.plug(); }},
    {"the gateway is dead", [](Plant& p) { p.crash_gateway(); }, [](Plant& p) { p.start_gateway(); }},
};

void turn(Plant& plant) {
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
}

bool comes_back(Plant& plant) {
  const auto reader = plant.connection_from(99);
  for (int i = 0; i < 100; ++i, plant.run(100ms))
    if (reader->word(kLinkState) == kOnline) return true;
  return false;
}

class Outage : public testing::TestWithParam<Subject> {};
/// Of drives whose commands are requests.
class LostExchange : public testing::TestWithParam<Subject> {};

TEST_P(Outage, LeavesTheMotorToTheDrive) {
  struct Row {
    Duration time;
    bool turns;
  };
  for (const Silence& silence : kSilences) {
    for (const Row& row : {Row{300ms, true}, Row{3s, !minds_silence(GetParam())}}) {
      SCOPED_TRACE(silence.name);
      Plant plant(GetParam());
      turn(plant);
      silence.begins(plant);
      plant.run(5ms);  // what was on its way
      const auto heard = plant.requests_heard();
      plant.run(row.time);
      EXPECT_EQ(plant.requests_heard(), heard);
      EXPECT_EQ(plant.velocity() != 0, row.turns);
      silence.ends(plant);
      EXPECT_TRUE(comes_back(plant));
      // What is found enabled is told nothing: a Keya that wants a command each second stops.
      const bool goes_on = row.turns && !(is_keya(GetParam()) && minds_silence(GetParam()));
      EXPECT_EQ(plant.keeps_turning(), goes_on);
    }
  }
}

TEST_P(Outage, IsNoticedAsTheSystemReportsIt) {
  Plant plant(GetParam());
  turn(plant);
  auto sent = plant.frames_sent();
  plant.cut_wire();
  plant.run(500ms);
  EXPECT_GT(plant.frames_sent(), sent) << "nobody has told the gateway";
  plant.mend_wire();
  ASSERT_TRUE(comes_back(plant));
  plant.unplug();
  sent = plant.frames_sent();
  plant.run(500ms);
  EXPECT_EQ(plant.frames_sent(), sent);
  EXPECT_EQ(plant.b.word(kLinkState), kLinkDown);
}

TEST_P(Outage, OfTheGatewayEndsItsConnections) {
  Plant plant(GetParam());
  plant.ready();
  plant.cut_wire();
  const RequestNumber asked = plant.a.begin(one(row::command, plant.endless_command()));
  plant.crash_gateway();
  const auto sent = plant.frames_sent();
  plant.mend_wire();
  plant.run(2s);
  EXPECT_EQ(plant.frames_sent(), sent);
  EXPECT_FALSE(plant.a.connected());
  EXPECT_THROW(plant.a.row(row::heartbeat, 1), std::runtime_error);
  plant.a.connect();
  EXPECT_FALSE(plant.a.connected()) << "nobody listens";
  plant.start_gateway();
  plant.a.connect();
  EXPECT_TRUE(comes_back(plant));
  EXPECT_FALSE(plant.a.answer_of(asked));
  EXPECT_TRUE(plant.stands());
}

TEST_P(Outage, OfTheGatewayComesAtAnyMoment) {
  Plant plant(GetParam(), with_leases());
  turn(plant);
  for (Duration moment{}; moment < 40ms; moment += 3ms) {
    plant.a.connect();
    plant.b.connect();
    for (const std::int64_t command : {kQuickStop, kRelease, kTakeOver, kEnable}) {
      plant.a.begin(one(row::command, command));
      plant.b.begin(one(row::command, command));
    }
    plant.b.vanish();
    plant.run(moment);
    plant.crash_gateway();
    const auto sent = plant.frames_sent();
    plant.run(50ms + 20 * moment);
    EXPECT_EQ(plant.frames_sent(), sent);
    plant.start_gateway();
    plant.run(20 * moment);
  }
  EXPECT_TRUE(comes_back(plant));
}

TEST_P(Outage, OfTheGatewayLeavesADriveThatCanBeUsedAgain) {
  Plant plant(GetParam());
  plant.ready_but_disabled();
  for (int i = 0; i < 3; ++i) {
    plant.crash_gateway();
    plant.run(200ms);
    plant.start_gateway();
  }
  plant.a.connect();
  turn(plant);
  EXPECT_TRUE(plant.keeps_turning());
}

TEST_P(Outage, OfTheDrivesPowerDisablesTheMotor) {
  for (const Duration off : {Duration{}, Duration{2s}}) {
    Plant plant(GetParam());
    turn(plant);
    plant.restart_drive(off);
    plant.run(5ms);
    const auto heard = plant.requests_heard();
    EXPECT_TRUE(plant.comes_to_stand(1s));
    if (off > Duration{}) {
      plant.run(800ms);
      EXPECT_EQ(plant.requests_heard(), heard);
    }
    plant.run(4s);
    EXPECT_FALSE(plant.motor().enabled.value_or(false));
    EXPECT_TRUE(plant.stands());
    EXPECT_TRUE(comes_back(plant));
  }
}

TEST_P(Outage, ThatIsAFaultStaysUntilItIsReset) {
  constexpr std::int64_t kFaultReset = 5;
  Plant plant(GetParam());
  turn(plant);
  plant.trip_drive();
  EXPECT_TRUE(plant.comes_to_stand(1s));
  plant.run(2s);
  EXPECT_TRUE(plant.motor().faulted);
  EXPECT_FALSE(plant.motor().enabled.value_or(false));
  EXPECT_EQ(plant.b.word(shown::axis_state), kErrorStop);
  EXPECT_EQ(plant.a.command(kFaultReset), kOk);
  plant.run(500ms);
  EXPECT_FALSE(plant.motor().faulted);
}

TEST_P(Outage, OfSingleExchangesIsOver) {
  for (const Strike how : {Strike::lose_request, Strike::lose_reply, Strike::late_reply, Strike::double_reply}) {
    Plant plant(GetParam());
    turn(plant);
    plant.strike(how, 2, 50ms);
    EXPECT_TRUE(plant.still_strikes(how));
    plant.run(3s);
    EXPECT_FALSE(plant.still_strikes(how));
    EXPECT_TRUE(plant.keeps_turning());
    EXPECT_TRUE(comes_back(plant));
  }
}

TEST_P(LostExchange, KeepsTheDriveFromActingIfItIsTheRequest) {
  constexpr std::uint64_t kAll = 10'000;
  for (const Strike how : {Strike::lose_request, Strike::lose_reply}) {
    Plant plant(GetParam());
    turn(plant);
    plant.strike(how, kAll);
    const RequestNumber asked = plant.a.begin(one(row::command, kQuickStop));
    EXPECT_FALSE(plant.a.answer_of(asked)) << "it waits for the drive";
    plant.run(700ms);
    EXPECT_EQ(plant.velocity() != 0, how == Strike::lose_request);
  }
}

TEST_P(Outage, OfAClientEndsItsMotionWithItsLease) {
  for (const bool silent : {false, true}) {
    Plant plant(GetParam(), with_leases());
    turn(plant);
    silent ? plant.a.vanish() : plant.a.disconnect();
    EXPECT_FALSE(plant.a.connected());
    plant.run(1500ms);
    EXPECT_NE(plant.velocity(), 0);
    EXPECT_TRUE(plant.comes_to_stand(1500ms));
  }
}

TEST_P(Outage, OfASilentClientIsNotNoticedBeforeTheSystemGivesItUp) {
  // Without a lease only a motor that neither its drive nor anybody else would ever stop.
  const bool ends_with_its_client =
      GetParam() == Subject::id286pro || (is_keya(GetParam()) && !minds_silence(GetParam()));
  Plant plant(GetParam());
  turn(plant);
  plant.a.vanish();
  plant.run(3s);
  EXPECT_NE(plant.velocity(), 0);
  plant.a.give_up_vanished();
  plant.run(1s);
  EXPECT_EQ(plant.velocity() != 0, !ends_with_its_client);
}

TEST_P(Outage, OfAClientDoesNotTakeBackWhatItSent) {
  Plant plant(GetParam());
  plant.ready();
  ASSERT_EQ(plant.set_endless(plant.a), kOk);
  const RequestNumber asked = plant.a.begin(one(row::command, plant.endless_command()));
  plant.a.vanish();
  EXPECT_TRUE(plant.turns_within(1s));
  EXPECT_FALSE(plant.a.answer_of(asked));
  plant.a.connect();
  EXPECT_EQ(plant.a.command(kHalt), kOk);
  EXPECT_TRUE(plant.comes_to_stand());
}

INSTANTIATE_TEST_SUITE_P(Every, Outage, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, LostExchange,
                         testing::ValuesIn(subjects([](Subject s) { return !commands_by_pdo(s); })), named);

}  // namespace
}  // namespace axisgate::test::obey
