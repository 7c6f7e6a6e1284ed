// SPDX-License-Identifier: Apache-2.0
// What waits in axisgate-dds for its turn: commands, what is known of writers, and other gateways of our name.
#include <gmock/gmock.h>

#include "gateway/upstream/dds_process/commands/command_intake.hpp"
#include "gateway/upstream/dds_process/discovery/namesake_watch.hpp"
#include "gateway/upstream/dds_process/discovery/writer_watch.hpp"

namespace axisgate::dds::test {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

constexpr std::uint8_t kDisable = 2, kHalt = 4, kRun = 8, kJogEnd = 33;
constexpr SteadyNs kNow = 1'000'000'000'000;

Guid writer_of(std::uint64_t number) {
  Guid out{};
  for (std::size_t i = 0; i < sizeof(number); ++i) out[i] = static_cast<std::uint8_t>(number >> 8 * i);
  return out;
}

struct Intake : testing::Test {
  CommandIntake intake;
  void add(std::uint8_t command, SteadyNs now = kNow) {
    CommandRecord record;
    record.command = command;
    intake.add(record, now);
  }
  std::vector<CommandRecord> take(std::size_t stops, std::size_t others) {
    std::vector<Record> taken;
    all = intake.take(stops, others, taken);
    std::vector<CommandRecord> out;
    for (const Record& record : taken) out.push_back(std::get<CommandRecord>(record));
    return out;
  }
  std::vector<int> numbers(std::size_t stops, std::size_t others) {
    std::vector<int> out;
    for (const CommandRecord& each : take(stops, others)) out.push_back(each.command);
    return out;
  }
  bool all = false;
};

TEST_F(Intake, StopsGoFirstInTheirOrderAndAllElseInItsOwn) {
  for (const std::uint8_t command : {kRun, kJogEnd, std::uint8_t{1}, kHalt, kDisable}) add(command);
  EXPECT_THAT(numbers(9, 9), ElementsAre(kJogEnd, kHalt, kDisable, kRun, 1));
  EXPECT_TRUE(all);
}

TEST_F(Intake, WhatCameLaterHasTheLaterTimeWhateverTheClockSays) {
  add(kRun);
  add(kHalt);
  add(kRun, kNow - 5);
  const auto taken = take(9, 9);
  ASSERT_THAT(taken, SizeIs(3));
  EXPECT_EQ(taken[1].received, kNow);
  EXPECT_LT(taken[1].received, taken[0].received);
  EXPECT_LT(taken[0].received, taken[2].received);
}

TEST_F(Intake, NothingPassesAStopThatIsLeft) {
  add(kHalt);
  add(kHalt);
  add(kRun);
  EXPECT_THAT(numbers(1, 9), ElementsAre(kHalt));
  EXPECT_FALSE(all);
  EXPECT_THAT(numbers(1, 9), ElementsAre(kHalt, kRun));
}

TEST_F(Intake, ThatIsFullTakesStopsAllTheSame) {
  for (std::size_t i = 0; i < kMaxCommandsWaiting; ++i) add(kRun);
  EXPECT_FALSE(intake.has_room(false));
  for (std::size_t i = 0; i < kMaxStopsWaiting; ++i) {
    ASSERT_TRUE(intake.has_room(true));
    add(kHalt);
  }
  EXPECT_FALSE(intake.has_room(true)) << "it is bounded as well";
}

TEST(Writers, OfAWholeDomainAreInTheBeats) {
  WriterWatch watch;
  WriterStatement statement;
  statement.kind = LivelinessKind::manual_by_topic;
  statement.lease.length = 1'000'000'000;
  for (std::size_t i = 0; i <= kMaxWritersKnown; ++i) {
    watch.on_discovered(writer_of(i), statement);
    watch.on_matched(writer_of(i), kNow);
    watch.on_sample(writer_of(i), kNow);
  }
  EXPECT_EQ(watch.take_changes(kNow).refused, 2U) << "when it was found, and when it was matched";
  std::size_t told = 0;
  const auto beats = watch.beats(kNow);
  EXPECT_THAT(beats, SizeIs(kMostBeatRecords));
  for (const BeatRecord& record : beats) {
    EXPECT_LE(record.writers.size(), kMaxBeats);
    told += record.writers.size();
  }
  EXPECT_EQ(told, kMaxWritersKnown);
}

// Of a program that hangs the library goes on to be found, by a new axisgate-dds as well.
TEST(Writers, ThatAreFoundHaveGivenNoSignOfLifeUntilTheyAssert) {
  WriterWatch watch;
  WriterStatement statement;
  statement.kind = LivelinessKind::manual_by_topic;
  statement.lease.length = 1'000'000'000;
  const Guid writer = writer_of(1);
  const auto beats = [&] {
    static_cast<void>(watch.take_changes(kNow));
    return watch.beats(kNow).front().writers.size();
  };
  watch.on_discovered(writer, statement);
  watch.on_matched(writer, kNow);
  EXPECT_EQ(beats(), 0U);
  watch.on_liveliness(writer, statement.lease, true);
  EXPECT_EQ(beats(), 1U);
  watch.on_unmatched(writer);
  watch.on_matched(writer, kNow);
  EXPECT_EQ(beats(), 0U) << "found again";
  watch.on_sample(writer, kNow);
  EXPECT_EQ(beats(), 1U);
}

TEST(Namesake, WithManyAxesIsToldTurnByTurnAndOfNoneThatNoGatewayHas) {
  NamesakeWatch watch(7);
  watch.on_discovered(writer_of(1), gateway_user_data(7), "192.168.1.8");
  for (std::uint16_t axis = 1; axis <= kMaxAxisNumber + 10; ++axis) watch.on_state(writer_of(1), 7, axis, true);
  std::size_t told = 0;
  for (auto some = watch.take(kNamesakesPerTurn); !some.empty(); some = watch.take(kNamesakesPerTurn)) {
    EXPECT_LE(some.size(), kNamesakesPerTurn);
    told += some.size();
  }
  EXPECT_EQ(told, kMaxAxisNumber);
}

TEST(Namesake, ThatGivesUpAnAxisIsToldForThatAxisAndNothingThatHasChangedBack) {
  NamesakeWatch watch(7);
  const Guid other = writer_of(1);
  watch.on_discovered(other, gateway_user_data(7), "192.168.1.8");
  const auto told = [&] { return watch.take(kNamesakesPerTurn); };
  watch.on_state(other, 7, 3, false);
  EXPECT_THAT(told(), SizeIs(0)) << "it was never there";
  watch.on_state(other, 7, 3, true);
  watch.on_state(other, 7, 4, true);
  EXPECT_THAT(told(), SizeIs(2));
  watch.on_state(other, 7, 3, false);
  EXPECT_THAT(told(), ElementsAre(NamesakeRecord{other, 3, "192.168.1.8", true}));
  for (int i = 0; i < 1000; ++i) watch.on_state(other, 7, 3, i % 2 == 0);
  EXPECT_THAT(told(), SizeIs(0)) << "nobody has asked meanwhile, and it is as it was";
  watch.on_removed(other);
  EXPECT_FALSE(watch.any());
  EXPECT_THAT(told(), ElementsAre(NamesakeRecord{other, 0, "192.168.1.8", true})) << "all its axes";
  EXPECT_THAT(told(), SizeIs(0));
}

}  // namespace
}  // namespace axisgate::dds::test
