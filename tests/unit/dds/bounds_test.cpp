// SPDX-License-Identifier: Apache-2.0
// One reply for each request, whatever comes between: repetitions, a full memory, a reader that does not read, an end
// of axisgate-dds, an end of the session.
#include <gmock/gmock.h>

#include "gateway/upstream/dds/request_memory.hpp"
#include "tests/unit/dds/plain_session.hpp"

namespace axisgate::dds {
namespace {

using namespace std::chrono_literals;
using test::command;
using test::guid;
using test::PlainSession;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::SizeIs;

constexpr int kDone = 2, kBusy = 19, kSeen = 21;

TEST(Requests, AreAnsweredWhenTheAxisHasAnswered) {
  PlainSession plain;
  static_cast<void>(plain.read());
  plain.session->on_record(command(guid(1), 1, 7), plain.now);
  EXPECT_THAT(plain.read<ReplyRecord>(), IsEmpty());
  ASSERT_THAT(plain.port.submitted, SizeIs(1));
  plain.port.submitted.front().on_result({{Errc::refused_by_drive, 0x06090030}});
  EXPECT_EQ(plain.woken, 1);
  EXPECT_EQ(plain.session->wake_at(), kLongAgo);
  EXPECT_THAT(plain.read<ReplyRecord>(), ElementsAre(ReplyRecord{1, 7, guid(1), 3, 0x06090030}));
  EXPECT_THAT(plain.read<ReplyRecord>(), IsEmpty());
}

TEST(Requests, AnUnsuitableStateCarriesItsDetail) {
  PlainSession plain;
  plain.port.at_once = BatchResult{refusal(Errc::state_unsuitable)};
  static_cast<void>(plain.read());
  plain.session->on_record(command(guid(1), 6, 7), plain.now);
  EXPECT_THAT(plain.read<ReplyRecord>(), ElementsAre(ReplyRecord{1, 7, guid(1), 9, 0x08000022}));
}

TEST(Requests, ThatComeAgainAreNotRunAgainForTenSeconds) {
  PlainSession plain;
  plain.port.at_once = BatchResult{};
  EXPECT_EQ(plain.ask(command(guid(1), 7, 1)), kDone);
  EXPECT_EQ(plain.ask(command(guid(1), 7, 1)), kSeen);
  EXPECT_THAT(plain.port.submitted, SizeIs(1));
  plain.now += 10s;
  EXPECT_EQ(plain.ask(command(guid(1), 7, 1)), kDone);
  EXPECT_THAT(plain.port.submitted, SizeIs(2));
}

TEST(Requests, AStopActsWhereItsCommandOrItsIdDiffersFromWhatWasAskedLast) {
  PlainSession plain;
  plain.port.at_once = BatchResult{};
  EXPECT_EQ(plain.ask(command(guid(1), 8, 1)), kDone);
  EXPECT_EQ(plain.ask(command(guid(1), 3, 1)), kDone) << "the id of the run";
  EXPECT_EQ(plain.port.submitted.back().batch.command, Command::quick_stop);
  EXPECT_EQ(plain.ask(command(guid(1), 3, 1)), kSeen) << "the same once more";
  EXPECT_EQ(plain.ask(command(guid(1), 8, 1)), kSeen) << "no command but a stop";
  EXPECT_EQ(plain.ask(command(guid(1), 4, 1)), kDone) << "another stop";
  EXPECT_THAT(plain.port.submitted, SizeIs(3));
  EXPECT_EQ(plain.ask(command(guid(1), 8, 2)), kDone);
  EXPECT_EQ(plain.ask(command(guid(1), 4, 1)), kDone) << "something else was asked since";
  EXPECT_EQ(plain.ask(command(guid(1), 4, 1)), kSeen);
  EXPECT_EQ(plain.ask(command(guid(2), 4, 1)), kDone) << "another writer's";
}

TEST(Requests, ThatWereSeenSayHowTheFirstEnded) {
  constexpr int kFirst = 1;
  PlainSession plain;
  static_cast<void>(plain.read());
  const auto again = [&](std::uint8_t number, std::uint64_t id) {
    plain.session->on_record(command(guid(1), number, id), plain.now);
    const auto replies = plain.read<ReplyRecord>();
    return replies.size() == 1 ? replies.front() : ReplyRecord{};
  };
  plain.session->on_record(command(guid(1), 7, kFirst), plain.now);
  EXPECT_EQ(again(7, kFirst), (ReplyRecord{1, kFirst, guid(1), kSeen, 1})) << "pending";
  plain.port.submitted.front().on_result({{Errc::refused_by_drive, 0x06090030}});
  EXPECT_THAT(plain.read<ReplyRecord>(), SizeIs(1));
  EXPECT_EQ(again(7, kFirst), (ReplyRecord{1, kFirst, guid(1), kSeen, 3}));
  EXPECT_EQ(again(99, 2).result, 17);
  EXPECT_EQ(again(99, 2), (ReplyRecord{1, 2, guid(1), kSeen, 17})) << "refused before it came to the axis";
  ObjectRequestRecord object{guid(1, 2), 0, {}, 1, 3, false, 0x1000, 0, 4, 0, {}};
  plain.port.at_once = BatchResult{};
  EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), kDone);
  plain.session->on_record(object, plain.now);
  const auto replies = plain.read<ObjectReplyRecord>();
  ASSERT_THAT(replies, SizeIs(1));
  EXPECT_EQ(replies.front().result, kSeen);
  EXPECT_EQ(replies.front().detail, std::uint32_t{kDone});
}

TEST(Requests, OfAStopWithAnothersIdAreToldTheirOwnResult) {
  PlainSession plain;
  static_cast<void>(plain.read());
  plain.session->on_record(command(guid(1), 8, 1), plain.now);
  plain.session->on_record(command(guid(1), 4, 1), plain.now);
  ASSERT_THAT(plain.port.submitted, SizeIs(2));
  plain.port.submitted[1].on_result({});
  plain.port.submitted[0].on_result({{Errc::dropped_by_stop, 0}});
  EXPECT_THAT(plain.read<ReplyRecord>(), SizeIs(2));
  plain.session->on_record(command(guid(1), 4, 1), plain.now);
  EXPECT_THAT(plain.read<ReplyRecord>(), ElementsAre(ReplyRecord{1, 1, guid(1), kSeen, kDone}));
}

TEST(Requests, ThatAreUnderWayAreNotRunAgainEither) {
  PlainSession plain;
  static_cast<void>(plain.read());
  plain.session->on_record(command(guid(1), 7, 1), plain.now);
  EXPECT_EQ(plain.ask(command(guid(1), 7, 1)), kSeen);
  plain.port.submitted.front().on_result({});
  EXPECT_THAT(plain.read<ReplyRecord>(), SizeIs(1));
}

TEST(Requests, BeyondTheMemoryAreRefusedAndNotRunButStopsAreCarriedOut) {
  PlainSession plain;
  plain.port.at_once = BatchResult{};
  static_cast<void>(plain.read());
  for (std::uint64_t id = 1; id <= RequestBounds{}.of_a_writer; ++id) {
    plain.session->on_record(command(guid(1), 1, id), plain.now);
    ASSERT_EQ(plain.read().size(), 1U);
    plain.port.submitted.clear();
  }
  const std::size_t run = plain.port.submitted.size();
  EXPECT_EQ(plain.ask(command(guid(1), 1, 100'000)), kBusy);
  EXPECT_EQ(plain.ask(command(guid(1), 1, 5)), kSeen) << "what it holds it holds";
  EXPECT_THAT(plain.port.submitted, SizeIs(run));
  EXPECT_EQ(plain.ask(command(guid(1), 3, 100'001)), kDone);
  EXPECT_EQ(plain.ask(command(guid(2), 1, 1)), kDone) << "another writer has its own room";
  plain.now += 10s;
  EXPECT_EQ(plain.ask(command(guid(1), 1, 100'000)), kDone);
}

TEST(Requests, BesideMoreBystandersThanThereIsRoomForAreAnsweredAndTheirWriterLives) {
  PlainSession plain;
  plain.port.at_once = BatchResult{};
  for (std::uint8_t i = 1; i <= kMaxWriters + 6; ++i) plain.session->on_record(test::writer_there(guid(i)), plain.now);
  EXPECT_EQ(plain.ask(command(guid(kMaxWriters + 6), 3, 1)), kDone) << "a stop of the last one";
  EXPECT_EQ(plain.port.submitted.back().batch.command, Command::quick_stop);
  plain.session->on_record(test::writer_there(guid(200), 5), plain.now);
  EXPECT_EQ(plain.ask(command(guid(200), 1, 1)), kDone);
  const auto life = plain.port.submitted.back().batch.life;
  plain.now += 1s;
  plain.session->on_record(test::beat(guid(200)), plain.now);
  EXPECT_EQ(life->heartbeat, plain.now);
}

TEST(Requests, OfMoreWritersThanThereIsRoomForAreRefusedButTheirStops) {
  PlainSession plain;
  plain.port.at_once = BatchResult{};
  plain.image.find(1)->lease.rules.on = false;  // so that each of them might have a motor running
  for (std::uint8_t i = 1; i <= kMaxWriters; ++i) EXPECT_EQ(plain.ask(command(guid(i), 1, 1)), kDone);
  EXPECT_EQ(plain.ask(command(guid(200), 1, 1)), kBusy);
  EXPECT_EQ(plain.ask(command(guid(200), 2, 2)), kDone);
  EXPECT_EQ(plain.port.submitted.back().batch.life->origin[2], 200) << "with a name for the event of it";
}

TEST(Replies, OfAProcessThatDoesNotReadAreBoundedAndNothingIsRunWithoutAReply) {
  PlainSession plain;
  static_cast<void>(plain.read());
  std::uint64_t id = 0;
  for (; plain.session->has_room(); ++id) {
    ASSERT_LE(id, 4 * kMaxRepliesWaiting) << "it must end";
    plain.session->on_record(command(guid(1), 1, id + 1), plain.now);
  }
  EXPECT_THAT(plain.port.submitted, SizeIs(kMaxRepliesWaiting)) << "accepted while a reply has its place";
  plain.session->on_record(command(guid(1), 3, id + 1), plain.now);
  ASSERT_THAT(plain.port.submitted, SizeIs(kMaxRepliesWaiting + 1)) << "a stop is carried out all the same";
  EXPECT_EQ(plain.port.submitted.back().batch.command, Command::quick_stop);
  plain.port.submitted.pop_back();
  const std::uint64_t refused = id - kMaxRepliesWaiting;
  auto replies = plain.read<ReplyRecord>();
  EXPECT_THAT(replies, SizeIs(refused));
  EXPECT_THAT(replies, Each(Field(&ReplyRecord::result, kBusy)));
  for (const auto& each : plain.port.submitted) each.on_result({});
  replies = plain.read<ReplyRecord>();
  EXPECT_THAT(replies, SizeIs(kMaxRepliesWaiting)) << "each that was accepted has its reply";
  EXPECT_THAT(replies, Each(Field(&ReplyRecord::result, kDone)));
  plain.port.at_once = BatchResult{};
  EXPECT_EQ(plain.ask(command(guid(1), 1, id)), kDone) << "one that was refused may be asked again at once";
}

TEST(Replies, ThatCouldNotBeReadAreKnownAsAlreadySeenToWhoeverAsksAgain) {
  PlainSession plain;
  static_cast<void>(plain.read());
  plain.session->on_record(command(guid(1), 7, 1), plain.now);
  plain.session->on_record(command(guid(1), 7, 2), plain.now);
  plain.session->on_record(command(guid(1), 99, 3), plain.now);  // its refusal waits for the socket
  plain.session->on_link_down(plain.now);
  plain.port.submitted[0].on_result({});
  EXPECT_EQ(plain.woken, 0) << "nobody reads";
  EXPECT_EQ(plain.session->wake_at(), kNever);
  EXPECT_THAT(plain.read(), IsEmpty());
  plain.now += 1s;
  plain.session->on_link_up(plain.now);
  EXPECT_THAT(plain.read<ReplyRecord>(), IsEmpty());
  EXPECT_EQ(plain.ask(command(guid(1), 7, 1)), kSeen);
  plain.port.submitted[1].on_result({});
  EXPECT_THAT(plain.read<ReplyRecord>(), ElementsAre(Field(&ReplyRecord::request_id, 2))) << "it came in time";
  EXPECT_THAT(plain.port.submitted, SizeIs(2));
}

// --- A jog whose start is still under way
// ------------------------------------------------------------------------------

struct Pressed : testing::Test {
  PlainSession plain;
  void jog(std::uint64_t id, double velocity = 10) {
    CommandRecord record = command(guid(1), 31, id);
    record.mask = 256;
    record.jog_velocity = velocity;
    plain.session->on_record(record, plain.now);
  }
};

TEST_F(Pressed, IsHeldByItsRepetitionsWhileItsStartIsUnderWay) {
  static_cast<void>(plain.read());
  jog(1);
  ASSERT_THAT(plain.port.submitted, SizeIs(1)) << "its velocity first";
  EXPECT_TRUE(plain.port.submitted[0].batch.jog_velocity);
  plain.port.at_once = BatchResult{};
  jog(2);
  ASSERT_THAT(plain.port.submitted, SizeIs(2));
  EXPECT_EQ(plain.port.submitted[1].batch.jog_again, Command::jog_forward);
  EXPECT_TRUE(plain.port.submitted[1].batch.claims);
  EXPECT_THAT(plain.read<ReplyRecord>(), ElementsAre(ReplyRecord{1, 2, guid(1), kDone, 0}));
  plain.port.submitted[0].on_result({});
  ASSERT_THAT(plain.port.submitted, SizeIs(3));
  EXPECT_EQ(plain.port.submitted[2].batch.command, Command::jog_forward);
  EXPECT_THAT(plain.read<ReplyRecord>(), ElementsAre(ReplyRecord{1, 1, guid(1), kDone, 0}));
}

TEST_F(Pressed, DoesNotBeginWhereItsVelocityIsRefused) {
  static_cast<void>(plain.read());
  jog(1);
  plain.port.submitted[0].on_result({{Errc::bad_value, 0}});
  EXPECT_THAT(plain.port.submitted, SizeIs(1));
  EXPECT_THAT(plain.read<ReplyRecord>(), ElementsAre(ReplyRecord{1, 1, guid(1), 17, 0}));
}

TEST_F(Pressed, IsNotLetGoByTheLateResultOfThePressBeforeIt) {
  jog(1);
  plain.session->on_record(command(guid(1), 33, 2), plain.now);
  jog(3);
  plain.port.submitted[0].on_result({{Errc::timed_out, 0}});
  plain.port.submitted.clear();
  jog(4);
  ASSERT_THAT(plain.port.submitted, SizeIs(1));
  EXPECT_EQ(plain.port.submitted[0].batch.jog_again, Command::jog_forward);
}

TEST(Replies, ThatComeWhenTheSessionIsGoneHarmNobody) {
  PlainSession plain;
  plain.session->on_record(command(guid(1), 1, 1), plain.now);
  CommandRecord jog = command(guid(1), 31, 2);
  jog.mask = 256;
  jog.jog_velocity = 1;
  plain.session->on_record(jog, plain.now);
  ObjectRequestRecord object{guid(1, 2), 0, {}, 1, 3, false, 0x1000, 0, 4, 0, {}};
  plain.session->on_record(object, plain.now);
  auto submitted = plain.port.submitted;
  ASSERT_THAT(submitted, SizeIs(3));
  plain.session.reset();
  plain.woken = 0;
  plain.image.changes.mark(1);
  EXPECT_EQ(plain.woken, 0);
  for (const auto& each : submitted) each.on_result({});
  EXPECT_THAT(plain.port.submitted, SizeIs(3)) << "a jog does not begin when nobody is there";
}

}  // namespace
}  // namespace axisgate::dds
