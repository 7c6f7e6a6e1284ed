// SPDX-License-Identifier: Apache-2.0
// Who owns an axis among DDS writers (design 3.5 and 4), and what its motor does when they go.
#include <gmock/gmock.h>

#include "gateway/upstream/dds/command_batches.hpp"
#include "gateway/upstream/dds/dds_clients.hpp"
#include "tests/unit/dds/dds_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

struct Owners : testing::Test {
  DdsRig rig;
  void run_by(const dds::Guid& writer) {
    ASSERT_EQ(rig.ask(writer, 1).result, kDone);
    ASSERT_EQ(rig.run_at(writer, 5).result, kDone);
    ASSERT_TRUE(rig.turns());
  }
  bool latched() { return (rig.state().alarms & bit(AxisAlarm::stop_latched)) != 0; }
};

// 3.5: owned from the first accepted write.
TEST_F(Owners, AJogThatIsRefusedTakesNothing) {
  const auto weak = rig.writer(1, 1, 5), strong = rig.writer(3, 1, 6);
  run_by(weak);
  for (const std::uint8_t direction : {std::uint8_t{31}, std::uint8_t{32}})
    for (const double velocity : {0.0, 1e-5}) {
      dds::CommandRecord jog = command(strong, direction, 0);
      jog.mask = dds::kHasJogVelocity;
      jog.jog_velocity = velocity;
      EXPECT_EQ(rig.ask(jog).result, kBadValue);
      EXPECT_EQ(rig.run_at(weak, 2).result, kDone);
    }
}

// It was accepted when the axis was its writer's, and waits for the wire.
TEST_F(Owners, WhatAWeakerWriterHasAskedDoesNotBeginUnderTheStrongerOne) {
  const auto weak = rig.writer(1, 1, 5), strong = rig.writer(3, 1, 6);
  ASSERT_EQ(rig.ask(weak, 1).result, kDone);
  dds::CommandRecord first = command(weak, 0, 0), run = command(weak, 8, 0);
  first.mask = dds::kHasProfileAcceleration;
  first.profile_acceleration = 50 * kTurn;
  run.mask = dds::kHasTargetVelocity;
  run.target_velocity = 5 * kTurn;
  const auto ids = {rig.send(first), rig.send(run), rig.send(command(strong, 1, 0))};
  ASSERT_TRUE(
      rig.run_until([&] { return std::ranges::all_of(ids, [&](std::uint64_t id) { return rig.replies(id) == 1; }); }));
  rig.run(1s);
  EXPECT_FALSE(rig.turns());
  EXPECT_TRUE(rig.axis().has(AxisInput::enabled));
  EXPECT_EQ(rig.run_at(strong, -5).result, kDone);
  EXPECT_TRUE(rig.turns());
}

struct Orphans : Owners {
  const dds::Guid writer = rig.writer(1);
  void SetUp() override { run_by(writer); }
  void leave() {
    rig.die(writer);
    rig.run(1s);
  }
  [[nodiscard]] bool is_owner(const dds::Guid& who) {
    const auto& owner = rig.axis().lease.owner;
    return owner && owner->connected && owner->name.ends_with(dds::client_name(who, "192.168.1.7"));
  }
  /// Each half second, for longer than the lease and all its graces last.
  void beat_for(const dds::Guid& client) {
    dds::Guid beats = client;
    beats[14] = 77;
    for (std::uint32_t counter = 1; counter <= 12; ++counter) {
      rig.give(dds::HeartbeatRecord{beats, client, counter, 0, 1});
      rig.run(500ms);
    }
  }
};

TEST_F(Orphans, AreTakenOverByWhateverTheirParticipantAsks) {
  leave();
  const auto next = rig.writer(1, 2);
  EXPECT_EQ(rig.ask(next, 4).result, kDone) << "a stop claims nothing by itself";
  EXPECT_TRUE(is_owner(next));
  rig.die(next);
  const auto last = rig.writer(1, 3);
  EXPECT_EQ(rig.ask(last, 13).result, kDone) << "what its program has left is its own to give back";
  EXPECT_EQ(rig.axis().lease.owner, nullptr);
}

// The hand comes before strength: a program that is back is not its own rival.
TEST_F(Orphans, AreTakenOverByAStrongerWriterOfTheirParticipantAsByAnyOther) {
  leave();
  const auto next = rig.writer(1, 2, 9);
  rig.fall_silent(next);
  beat_for(next);
  EXPECT_TRUE(rig.turns());
  EXPECT_FALSE(latched());
  EXPECT_TRUE(is_owner(next));
  EXPECT_TRUE(rig.has_event("goes on as the owner, for another writer"));
  rig.die(next);
  const auto last = rig.writer(1, 3, 10);
  EXPECT_EQ(rig.ask(last, 13).result, kDone) << "what its program has left is its own to give back";
  EXPECT_EQ(rig.axis().lease.owner, nullptr);
}

TEST_F(Orphans, AreNotTakenOverByWhatIsNotSurelyMeant) {
  leave();
  const auto next = rig.writer(1, 2);
  rig.run(500ms);
  dds::CommandRecord stop = command(next, 4, 0);
  stop.gateway.name = "cell_7";  // it is meant for us by half: the stop alone is carried out
  static_cast<void>(rig.ask(stop));
  EXPECT_FALSE(is_owner(next));
}

TEST_F(Orphans, AreThoseOfAClientThatDisposesItsHeartbeatUntilItWritesAgain) {
  dds::HeartbeatRecord end{guid(2, 77), writer, 0, 0, 0, true};
  rig.give(end);
  EXPECT_TRUE(is_owner(writer)) << "nobody speaks for another participant's";
  end.writer = guid(1, 77);
  rig.give(end);
  EXPECT_FALSE(is_owner(writer));
  EXPECT_EQ(rig.run_at(writer, 5).result, kDone);
  EXPECT_TRUE(is_owner(writer));
  rig.run(10s);
  EXPECT_TRUE(rig.turns()) << "its writer was there all the time";
  rig.give(end);
  beat_for(writer);
  EXPECT_TRUE(latched()) << "neither its liveliness nor a heartbeat keeps its motor running";
}

// A writer that is made as another is deleted may be told of first.
TEST_F(Orphans, AreTakenOverByTheHeartbeatOfAWriterThatHasSaidNothingBefore) {
  const auto next = rig.writer(1, 2);
  rig.fall_silent(next);
  rig.die(writer);
  beat_for(next);
  EXPECT_TRUE(rig.turns());
  EXPECT_TRUE(is_owner(next));
}

TEST_F(Orphans, AreTakenOverByTheLivelinessOfTheirWriterThatIsBack) {
  leave();
  static_cast<void>(rig.writer(1));
  rig.run(6s);
  EXPECT_TRUE(rig.turns());
  EXPECT_TRUE(is_owner(writer));
  EXPECT_EQ(rig.run_at(writer, 4).result, kDone);
}

TEST_F(Orphans, AreStoppedThoughOthersOfTheirProgramGoOn) {
  const auto beside = rig.writer(1, 2);
  const auto stranger = rig.writer(2);
  rig.run(1s);
  rig.die(writer);
  beat_for(beside);
  beat_for(stranger);
  EXPECT_TRUE(latched()) << "who was heard before has not come back";
  EXPECT_TRUE(rig.has_event("has run out after it had gone"));
  EXPECT_EQ(rig.axis().lease.owner, nullptr);
}

// Design 4, signs of life: that a writer is found again is none; "prolonged once by 3 s".
TEST_F(Owners, AProgramThatHangsIsStoppedHoweverOftenTheProcessDiesAndFindsItsWriter) {
  const auto writer = rig.writer(1);
  run_by(writer);
  rig.fall_silent(writer);
  const Instant died = rig.now();
  for (int i = 0; i < 12 && !rig.axis().has(AxisInput::stop_latched); ++i) {
    rig.link_down();
    rig.run(250ms);
    rig.link_up();
    rig.give(writer_there(writer));
    rig.run(250ms);
  }
  EXPECT_TRUE(rig.axis().has(AxisInput::stop_latched));
  EXPECT_LE(rig.now() - died, 5500ms) << "2 s of its lease, and 3 s";
}

TEST_F(Owners, OfHeartbeatLeasesProveThemselvesBySamplesAndByTheirOwnAssertions) {
  DdsRigOptions options;
  options.lease.renew = LeaseRenewal::heartbeat;
  DdsRig strict(options);
  const auto writer = strict.writer(1);
  ASSERT_EQ(strict.ask(writer, 1).result, kDone);
  ASSERT_EQ(strict.run_at(writer, 5).result, kDone);
  strict.run(4s);
  EXPECT_TRUE(strict.turns()) << "MANUAL_BY_TOPIC: the program itself says that it lives";
  strict.fall_silent(writer);
  for (int i = 0; i < 4; ++i) {
    strict.run(1s);
    EXPECT_EQ(strict.run_at(writer, 5).result, kDone);
  }
  EXPECT_TRUE(strict.turns());
  EXPECT_TRUE(strict.run_until([&] { return strict.axis().has(AxisInput::stop_latched); }, 3s));
}

}  // namespace
}  // namespace axisgate::test
