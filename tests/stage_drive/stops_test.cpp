// SPDX-License-Identifier: Apache-2.0
// Stops and the stop latch (design 3.4 Stops): next on the wire, idempotent, repeated until they show, and never an
// enable.
#include <gmock/gmock.h>

#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using enum Situation;

WriteBatch of(ClientId client, WriteBatch batch) {
  batch.client = client;
  return batch;
}

TEST(Stops, GoesNextOnTheWireBehindFullQueues) {
  GatewayStage stage({line_of_mds(8, 3ms)});
  ASSERT_TRUE(stage.come_online());
  ASSERT_EQ(stage.command(8, Command::enable).outcome.code, Errc::ok);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::shared_ptr<std::optional<BatchResult>>> places;
    for (ClientId client = 1; client <= 32; ++client) {
      const Quantity quantity = client % 2 == 0 ? Quantity::profile_velocity : Quantity::profile_acceleration;
      const std::int64_t value = 100'000 + 17 * static_cast<std::int64_t>(client) + round;
      for (AxisNumber axis = 1; axis <= 8; ++axis)
        places.push_back(stage.begin(axis, of(client, setpoints({{quantity, value}}))));
    }
    stage.run(std::chrono::milliseconds(7 + round));
    const std::size_t before = stage.link(0).sent.size();
    const auto stop = stage.begin(8, of(99, with_command(Command::quick_stop)));
    ASSERT_TRUE(stage.run_until([&] { return stop->has_value(); }));
    EXPECT_EQ((*stop)->outcome.code, Errc::ok);
    const WireRequest next = decoded(kLongAgo, stage.link(0).sent[before].bytes);
    EXPECT_EQ(stage.link(0).sent[before].bytes[0], 8) << "behind the one exchange on the wire, nothing else";
    EXPECT_EQ(next.index, kControlword);
    EXPECT_EQ(next.data, 0x000BU);
    stage.run(2s);
    for (const auto& place : places) EXPECT_TRUE(place->has_value()) << "each write batch gets its result";
    ASSERT_EQ(stage.command(8, Command::enable).outcome.code, Errc::ok);
  }
}

TEST(Stops, ThatRampForLongLeaveTheWireToOtherDrives) {
  GatewayStage stage({line_of_mds(2, 10ms)});  // longer than any pause between two looks at the start
  ASSERT_TRUE(stage.come_online());
  stage.drive(0, 0).poke({0x605B, 0}, 1);
  stage.drive(0, 0).poke({0x6084, 0}, 2'000);
  ASSERT_EQ(stage.command(1, Command::enable).outcome.code, Errc::ok);
  ASSERT_EQ(stage.ask(1, with_command(Command::run_velocity, {{Quantity::target_velocity, 500'000}})).outcome.code,
            Errc::ok);
  stage.run(2s);
  const auto stop = stage.begin(1, with_command(Command::disable));
  for (int i = 0; i < 10; ++i) {
    const Instant asked = stage.runtime().now();
    ASSERT_EQ(stage.ask(2, setpoints({{Quantity::profile_velocity, 100'000 + i * 1'000}})).outcome.code, Errc::ok);
    EXPECT_LE(stage.runtime().now() - asked, 80ms) << "its own two exchanges, a look, a poll and what was on the wire";
  }
  EXPECT_TRUE(stage.drive(0, 0).state() == simulated::Cia402State::operation_enabled) << "it still ramps";
}

TEST(Stops, TwoWaitingIdenticalOnesAreOneOnTheWire) {
  Rig rig(KincoType::md);
  rig.bring_to(running);
  const auto first = rig.stage.begin(1, of(1, with_command(Command::disable)));
  const auto second = rig.stage.begin(1, of(2, with_command(Command::disable)));
  rig.stage.run(500ms);
  EXPECT_EQ((*first)->outcome.code, Errc::ok);
  EXPECT_EQ((*second)->outcome.code, Errc::ok);
  EXPECT_EQ(rig.count(kControlword, 0x06), 1U);
}

TEST(Stops, OneThatComesWhileAnotherRampsIsSentAndWhatEnablesComesWhenBothAreOver) {
  Rig rig(KincoType::md);
  rig.bring_to(running);
  rig.motor().poke({0x605B, 0}, 1);
  rig.motor().poke({0x6084, 0}, 20'000);
  const auto first = rig.stage.begin(1, of(1, with_command(Command::disable)));
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.count(kControlword, 0x06) == 1; }));
  const auto second = rig.stage.begin(1, of(2, with_command(Command::disable)));
  rig.stage.run(50ms);
  EXPECT_EQ(rig.count(kControlword, 0x06), 2U);
  const auto enable = rig.stage.begin(1, of(1, with_command(Command::enable)));
  rig.stage.run(50ms);
  ASSERT_TRUE(rig.motor_enabled()) << "it still ramps";
  EXPECT_FALSE(enable->has_value()) << "an answer would tell of before the stop";
  ASSERT_TRUE(rig.stage.run_until([&] { return enable->has_value(); }));
  EXPECT_EQ((*first)->outcome.code, Errc::ok);
  EXPECT_EQ((*second)->outcome.code, Errc::ok);
  EXPECT_EQ((*enable)->outcome.code, Errc::ok);
  EXPECT_TRUE(rig.motor_enabled());
  EXPECT_FALSE(rig.turns());
}

TEST(Stops, AreSentThreeTimesAtMostUntilTheStateShows) {
  // A drive that acknowledges but never leaves the state: the DIN that holds the enable outranks the bus.
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  rig.motor().poke({0x2010, 0x03}, 0x0001);
  rig.motor().poke({0x2020, 0x0F}, 0x000F);
  rig.motor().set_input(1, true);
  rig.mark();
  const auto place = rig.stage.begin(1, with_command(Command::disable));
  rig.stage.run(5s);
  EXPECT_EQ(rig.count(kControlword, 0x06), 3U);
  rig.stage.run(1s);
  EXPECT_GT(rig.count(kControlword, 0x06), 3U) << "it is still enabled, so the stop is owed on";
  ASSERT_TRUE(place->has_value());
  EXPECT_EQ((*place)->outcome.code, Errc::not_reached) << "at the client's deadline: all was acknowledged";
}

TEST(Stops, KeepTheirThreeTriesAtADriveThatWasSilentBefore) {
  Rig rig(KincoType::jd);
  rig.bring_to(running);
  rig.faults().next(DriveFault::unresponsive, 5);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::suspect; }));
  rig.stage.run(150ms);  // the first resynchronisation read is out
  rig.mark();
  const BatchResult result = rig.command(Command::quick_stop);
  EXPECT_EQ(result.outcome.code, Errc::ok) << text(result.outcome.code);
  EXPECT_LE(rig.count(kControlword, 0x0B), 3U);
  EXPECT_TRUE(rig.stage.run_until([&] { return !rig.motor_enabled(); }, 2s));
}

TEST(Stops, DropWhatWaitsAndAbortWhatHasStarted) {
  Rig rig(KincoType::jd);
  rig.bring_to(disabled);
  const auto started = rig.stage.begin(1, of(1, with_command(Command::enable)));
  ASSERT_TRUE(rig.stage.run_until([&] { return !rig.writes().empty(); }));
  const auto waiting = rig.stage.begin(1, of(1, setpoints({{Quantity::target_position, 77}})));
  const auto parameter = rig.stage.begin(1, of(1, setpoints({{Quantity::profile_velocity, 123'000}})));
  const auto own = rig.stage.begin(1, of(2, with_command(Command::move_absolute)));
  const auto stop = rig.stage.begin(1, of(2, with_command(Command::disable)));
  rig.stage.run(600ms);
  EXPECT_EQ((*stop)->outcome.code, Errc::ok);
  EXPECT_EQ((*started)->outcome.code, Errc::stopped_by_other);
  EXPECT_EQ((*waiting)->outcome.code, Errc::dropped_by_stop);
  EXPECT_EQ((*own)->outcome.code, Errc::dropped_by_stop);
  EXPECT_EQ((*parameter)->outcome.code, Errc::ok) << "parameters alone survive";
  EXPECT_FALSE(rig.motor_enabled());
  EXPECT_TRUE(rig.has_event(EventKind::command, "stopped by another client"));
}

TEST(Stops, OfTheSameClientAbortItsOwnBatchAsDropped) {
  Rig rig(KincoType::jd);
  rig.bring_to(disabled);
  const auto started = rig.stage.begin(1, of(1, with_command(Command::enable)));
  ASSERT_TRUE(rig.stage.run_until([&] { return !rig.writes().empty(); }));
  const auto stop = rig.stage.begin(1, of(1, with_command(Command::disable)));
  rig.stage.run(600ms);
  EXPECT_EQ((*started)->outcome.code, Errc::dropped_by_stop);
  EXPECT_EQ((*stop)->outcome.code, Errc::ok);
}

TEST(Stops, AControlwordBesideAStopCommandCannotUndoIt) {
  for (const Command stop : {Command::disable, Command::quick_stop, Command::halt}) {
    Rig rig(KincoType::md);
    rig.bring_to(moving);
    WriteBatch batch = with_command(stop);
    batch.controlword = 0x003F;
    EXPECT_EQ(rig.ask(batch).outcome.code, Errc::ok);
    EXPECT_EQ(rig.count(kControlword, 0x3F), 0U);
    rig.stage.run(2s);
    EXPECT_FALSE(rig.turns());
  }
}

TEST(Stops, BesideAnImpossibleValueIsCarriedOutAndTheAnswerTellsOfTheValue) {
  Rig rig(KincoType::jd);
  rig.bring_to(running);
  const BatchResult result = rig.ask(with_command(Command::quick_stop, {{Quantity::homing_method, 99}}));
  EXPECT_EQ(result.outcome.code, Errc::bad_value);
  EXPECT_EQ(rig.count(kControlword, 0x0B), 1U);
  EXPECT_FALSE(rig.motor_enabled() && rig.turns());
}

TEST(Stops, ToASuspectDriveGoesOutAtOnceAndAnAcknowledgementProvesNothing) {
  for (const KincoType type : {KincoType::jd, KincoType::md}) {
    Rig rig(type);
    rig.bring_to(suspect);
    const auto place = rig.stage.begin(1, with_command(Command::quick_stop));
    const Instant asked = rig.stage.runtime().now();
    rig.stage.run(150ms);
    const auto writes = rig.writes();
    ASSERT_FALSE(writes.empty());
    EXPECT_EQ(writes.front().data, 0x000BU);
    EXPECT_LE(writes.front().at - asked, 100ms) << "behind the exchange on the wire";
    ASSERT_TRUE(rig.stage.run_until([&] { return place->has_value(); }));
    EXPECT_EQ((*place)->outcome.code, Errc::ok);
    bool read_back = false;
    for (const WireRequest& r : rig.requests()) read_back = read_back || (!r.write && r.index == kControlword);
    EXPECT_TRUE(read_back);
  }
}

TEST(Stops, RightAfterTheLinksReturnIsWorthItsTry) {
  Rig rig(KincoType::jd);
  rig.bring_to(running);
  rig.stage.link(0).unplug();
  rig.stage.run(300ms);
  rig.stage.link(0).plug();
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state != LinkState::link_down; }));
  ASSERT_NE(rig.axis().link_state, LinkState::online);
  EXPECT_EQ(rig.command(Command::quick_stop).outcome.code, Errc::ok);
  EXPECT_TRUE(rig.stage.run_until([&] { return !rig.motor_enabled(); }, 2s));
  rig.online();
}

TEST(Stops, GoOnAfterTheirClientHasItsAnswer) {
  Rig rig(KincoType::jd);
  rig.bring_to(running);
  rig.faults().next(DriveFault::unresponsive, 1);
  WriteBatch batch = with_command(Command::quick_stop);
  batch.answer_by = rig.stage.runtime().now() + 20ms;
  EXPECT_EQ(rig.ask(batch).outcome.code, Errc::timed_out);
  EXPECT_TRUE(rig.stage.run_until([&] { return !rig.motor_enabled(); }, 2s));
}

TEST(Stops, AHaltOfASuspectDriveThatCouldHaveRestartedIsAQuickStop) {
  Rig rig(KincoType::md);
  rig.bring_to(suspect);
  EXPECT_EQ(rig.command(Command::halt).outcome.code, Errc::ok);
  EXPECT_EQ(rig.count(kControlword, 0x010F), 0U);
  EXPECT_EQ(rig.count(kControlword, 0x0B), 1U);
  EXPECT_TRUE(rig.axis().has(AxisInput::stop_latched));
}

}  // namespace
}  // namespace axisgate::test
