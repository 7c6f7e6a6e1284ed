// SPDX-License-Identifier: Apache-2.0
// A client that was not there a moment ago: its first command, and the reply to it.
#include <gmock/gmock.h>

#include <limits>
#include <string>

#include "gateway/upstream/dds_process/publish/held_replies.hpp"
#include "tests/dds_process/child.hpp"
#include "tests/dds_process/peer.hpp"

namespace axisgate::dds::test {
namespace {

constexpr std::chrono::milliseconds kLongLease{20000};

TEST(FirstCommand, IsHeardAsSoonAsItsWriterMeetsAReader) {
  constexpr int kPrograms = 20;
  Child child({"--commands"});
  for (int turn = 0; turn < kPrograms; ++turn) {
    Peer peer;
    // Whoever states a lease meets two readers, and may write when it has met the first of them.
    auto writer = peer.writer<AxisCommand>(
        kCommands, {.exclusive = turn % 3 != 0, .liveliness = Liveliness::manual_by_topic, .lease = kLongLease});
    ASSERT_TRUE(writer->wait_matched());
    AxisCommand sample;
    sample.request_id(7);
    ASSERT_TRUE(writer->write(sample));
    ASSERT_TRUE(command_of(child, writer->guid())) << "program " << turn;
  }
}

TEST(Reply, WaitsForTheReaderOfANewClient) {
  constexpr int kMostTries = 10;  // a machine that stands still for kReplyPatience loses one
  Child child({"--commands"});
  bool heard = false;
  for (int tries = 0; tries < kMostTries && !heard; ++tries) {
    Peer peer;
    auto writer = peer.writer<AxisCommand>(kCommands);
    ASSERT_TRUE(writer->wait_matched());
    AxisCommand sample;
    sample.request_id(7);
    ASSERT_TRUE(writer->write(sample));
    ASSERT_TRUE(command_of(child, writer->guid()));
    child.send(ReplyRecord{.axis = 3, .request_id = 7, .writer = writer->guid(), .result = 2});
    auto replies = peer.reader<CommandReply>("axisgate/command_reply", {.depth = 10});
    const std::optional<CommandReply> reply = replies->next_within(std::chrono::seconds(4));
    heard = reply && reply->request_id() == 7;
  }
  EXPECT_TRUE(heard);
}

// --- Which replies wait, and how long --------------------------------------------------------------------------------

Guid guid(std::uint8_t participant, std::uint8_t entity) {
  Guid out{};
  out[0] = participant;
  out[kGuidPrefix] = entity;
  return out;
}

class Held : public testing::Test {
 protected:
  bool hold(std::uint8_t participant, std::uint64_t request, SteadyNs now) {
    return held.hold(ReplyRecord{.request_id = request}, guid(participant, 1), now);
  }
  std::string taken(SteadyNs now) {
    std::string out;
    for (const Record& record : held.take(now)) out += std::to_string(std::get<ReplyRecord>(record).request_id) + " ";
    return out;
  }
  HeldReplies held;
};

TEST_F(Held, AClientWhoseReaderIsKnownForLongWaitsForNothing) {
  held.on_reader(guid(5, 9), 0);
  EXPECT_TRUE(hold(4, 1, kReaderSettled));
  EXPECT_FALSE(hold(5, 1, kReaderSettled));
  EXPECT_TRUE(hold(6, 1, kReaderSettled));
}

TEST_F(Held, AClientWhoseReaderWasFoundAMomentAgoIsWaitedForOnce) {
  held.on_reader(guid(5, 9), 0);
  EXPECT_TRUE(hold(5, 1, kSecond)) << "it may not know us yet";
  EXPECT_EQ(held.due(), kSecond + kReaderGrace);
  EXPECT_EQ(taken(kSecond + kReaderGrace - 1), "");
  EXPECT_EQ(taken(kSecond + kReaderGrace), "1 ");
  EXPECT_FALSE(hold(5, 2, kSecond + kReaderGrace));
}

TEST_F(Held, RepliesOfANewClientComeInTheirOrderWhenItsReaderIsFound) {
  EXPECT_TRUE(hold(5, 1, 0));
  EXPECT_TRUE(hold(5, 2, kSecond));
  EXPECT_EQ(taken(kSecond), "");
  held.on_reader(guid(5, 9), kSecond);
  EXPECT_EQ(held.due(), kSecond + kReaderGrace);
  EXPECT_EQ(taken(kSecond + kReaderGrace - 1), "");
  EXPECT_TRUE(hold(5, 3, kSecond + kReaderGrace)) << "it would pass those before it";
  EXPECT_EQ(taken(kSecond + kReaderGrace), "1 2 3 ");
  EXPECT_FALSE(hold(5, 4, kSecond + kReaderGrace));
}

TEST_F(Held, AClientWithoutAReaderIsWaitedForOnce) {
  EXPECT_EQ(held.due(), std::numeric_limits<SteadyNs>::max());
  EXPECT_TRUE(hold(5, 1, kSecond));
  EXPECT_EQ(held.due(), kSecond + kReplyPatience);
  EXPECT_EQ(taken(kSecond + kReplyPatience - 1), "");
  EXPECT_EQ(taken(kSecond + kReplyPatience), "1 ");
  EXPECT_FALSE(hold(5, 2, kSecond + kReplyPatience));
  EXPECT_EQ(held.due(), std::numeric_limits<SteadyNs>::max());
}

TEST_F(Held, BeyondItsBoundNoneWaits) {
  for (std::uint64_t id = 1; id < kMaxRepliesHeld; ++id) ASSERT_TRUE(hold(1, id, 0)) << id;
  EXPECT_EQ(taken(0), "");
  EXPECT_TRUE(hold(2, 7777, 0));
  EXPECT_EQ(held.due(), 0);
  EXPECT_THAT(taken(0), testing::EndsWith(" 1022 1023 7777 "));
  EXPECT_FALSE(hold(1, 1024, 0));
}

TEST_F(Held, ClientsThatAreWaitedForNoLongerMakeWay) {
  for (unsigned client = 0; client < kMaxReplyClients; ++client)
    ASSERT_TRUE(hold(static_cast<std::uint8_t>(client), client, 0)) << client;
  Guid another{};
  another[1] = 1;
  EXPECT_FALSE(held.hold(ReplyRecord{}, another, 0));
  EXPECT_NE(taken(kReplyPatience), "");
  EXPECT_TRUE(held.hold(ReplyRecord{}, another, kReplyPatience));
}

TEST_F(Held, AReaderThatIsGoneIsNoneAnyMore) {
  held.on_reader(guid(5, 9), 0);
  held.on_reader_gone(guid(5, 9));
  EXPECT_TRUE(hold(5, 1, kReaderSettled));
}

TEST_F(Held, AClientThatIsFoundAgainIsNewOnceMore) {
  held.on_reader(guid(5, 9), 0);
  EXPECT_TRUE(hold(5, 1, 0));
  EXPECT_EQ(taken(kReaderGrace), "1 ");
  EXPECT_FALSE(hold(5, 2, kReaderGrace));
  held.on_reader_gone(guid(5, 9));
  held.on_reader(guid(5, 9), kSecond);
  EXPECT_TRUE(hold(5, 3, kSecond)) << "it may not know us yet";
}

}  // namespace
}  // namespace axisgate::dds::test
