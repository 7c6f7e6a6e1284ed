// SPDX-License-Identifier: Apache-2.0
// What DDS clients ask, and who they are, as the gateway is told of it.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>
#include <set>
#include <string>
#include <utility>

#include "tests/dds_process/child.hpp"
#include "tests/dds_process/peer.hpp"

namespace axisgate::dds::test {
namespace {

constexpr std::chrono::milliseconds kShortLease{5000};  // longer than a busy machine stands still

/// Sent again until it comes: the program may not know the reader yet, and these topics keep nothing for it.
template <typename Sample>
std::optional<Sample> until_heard(Child& child, const Record& record, Reader<Sample>& reader) {
  std::optional<Sample> got;
  for (int tries = 0; !got && tries < 300; ++tries) {
    child.send(record);
    got = reader.next_within(std::chrono::milliseconds(100));
  }
  return got;
}

/// The next WriterRecord of this writer.
std::optional<WriterRecord> next_of(Child& child, const Guid& writer) {
  while (const std::optional<WriterRecord> record = child.next<WriterRecord>()) {
    if (record->writer == writer) return record;
  }
  return std::nullopt;
}

TEST(Command, ReachesTheGatewayWithAllItsMembersAndItsWriter) {
  Child child({"--commands"});
  Peer peer;
  auto writer = peer.writer<AxisCommand>(kCommands);
  ASSERT_TRUE(writer->wait_matched());
  AxisCommand sent = command(499, 0xFEDCBA9876543210);
  sent.gateway_key(0xCAFEBABE);
  sent.gateway("cell_7");
  sent.command(6);
  sent.mode(-3);
  sent.mask(0x7FF);
  sent.target_position(1.5);
  sent.target_velocity(-2.5);
  sent.target_torque(3.5);
  sent.max_torque(4.5);
  sent.profile_velocity(5.5);
  sent.profile_acceleration(6.5);
  sent.profile_deceleration(7.5);
  sent.jog_velocity(8.5);
  sent.set_position_value(9.5);
  sent.homing_method(-17);
  ASSERT_TRUE(writer->write(sent));
  std::optional<CommandRecord> got = child.next<CommandRecord>();
  ASSERT_TRUE(got);
  EXPECT_NE(std::exchange(got->written, 0), 0);
  EXPECT_NE(std::exchange(got->received, 0), 0);
  EXPECT_EQ(got, (CommandRecord{.writer = writer->guid(),
                                .gateway = {0xCAFEBABE, "cell_7"},
                                .axis = 499,
                                .request_id = 0xFEDCBA9876543210,
                                .command = 6,
                                .mode = -3,
                                .mask = 0x7FF,
                                .target_position = 1.5,
                                .target_velocity = -2.5,
                                .target_torque = 3.5,
                                .max_torque = 4.5,
                                .profile_velocity = 5.5,
                                .profile_acceleration = 6.5,
                                .profile_deceleration = 7.5,
                                .jog_velocity = 8.5,
                                .set_position_value = 9.5,
                                .homing_method = -17}));
}

TEST(Command, ForAxesThatDoNotExistReachesTheGatewayAsWell) {
  constexpr int kCommandsSent = 2000;
  Child child({"--commands"});
  Peer peer;
  auto writer = peer.writer<AxisCommand>(kCommands);
  ASSERT_TRUE(writer->wait_matched());
  std::set<std::uint16_t> axes;
  for (int i = 0; i < kCommandsSent; ++i) {
    const auto axis = static_cast<std::uint16_t>(65535 - i);
    ASSERT_TRUE(writer->write(command(axis, 1)));
    if (i % 100 != 99) continue;
    while (axes.size() <= static_cast<std::size_t>(i)) {
      const std::optional<CommandRecord> got = child.next<CommandRecord>();
      ASSERT_TRUE(got) << i;
      axes.insert(got->axis);
    }
  }
  EXPECT_EQ(axes.size(), static_cast<std::size_t>(kCommandsSent));
}

TEST(Command, WaitsInItsOrderWhileTheGatewayDoesNotRead) {
  constexpr std::uint64_t kCommandsSent = 3000;
  Child child({"--commands"});
  Peer peer;
  auto writer = peer.writer<AxisCommand>(kCommands);
  ASSERT_TRUE(writer->wait_matched());
  // More than the socket and the queues on the way take.
  for (std::uint64_t id = 1; id <= kCommandsSent; ++id) ASSERT_TRUE(writer->write(command(7, id))) << id;
  for (std::uint64_t id = 1; id <= kCommandsSent; ++id) {
    const std::optional<CommandRecord> got = child.next<CommandRecord>();
    ASSERT_TRUE(got) << id;
    ASSERT_EQ(got->request_id, id);
  }
}

TEST(Command, IsNotReadWhereCommandsAreOff) {
  Child child;
  Peer peer;
  auto states = peer.reader<AxisState>("axisgate/axis_state", {.transient_local = true});
  auto writer = peer.writer<AxisCommand>(kCommands);
  child.send(StateRecord{.axis = 1, .name = "lift"});
  ASSERT_TRUE(states->next());  // the two programs have found each other
  EXPECT_FALSE(writer->matched());
}

TEST(ObjectRequests, AndTheirReplyTravelWithUpTo4096Bytes) {
  Child child({"--commands"});
  Peer peer;
  auto writer = peer.writer<ObjectRequest>(kObjects, {.exclusive = false});
  auto replies = peer.reader<ObjectReply>("axisgate/object_reply", {.depth = 10});
  ASSERT_TRUE(writer->wait_matched());
  std::vector<Byte> data(kMaxObjectBytes);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<Byte>(i * 7);
  ObjectRequest sent;
  sent.axis(4);
  sent.request_id(11);
  sent.write(true);
  sent.index(0x1008);
  sent.subindex(2);
  sent.size(0);
  sent.value(0xCAFEBABE);
  sent.data(data);
  ASSERT_TRUE(writer->write(sent));
  std::optional<ObjectRequestRecord> got = child.next<ObjectRequestRecord>();
  ASSERT_TRUE(got);
  EXPECT_NE(std::exchange(got->written, 0), 0);
  EXPECT_NE(std::exchange(got->received, 0), 0);
  EXPECT_EQ(got, (ObjectRequestRecord{.writer = writer->guid(),
                                      .axis = 4,
                                      .request_id = 11,
                                      .write = true,
                                      .index = 0x1008,
                                      .subindex = 2,
                                      .size = 0,
                                      .value = 0xCAFEBABE,
                                      .data = data}));

  const ObjectReplyRecord answer{.axis = 4,
                                 .request_id = 11,
                                 .writer = writer->guid(),
                                 .result = 3,
                                 .detail = 0x06020000,
                                 .value = 5,
                                 .data = data};
  const std::optional<ObjectReply> reply = until_heard(child, answer, *replies);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->axis(), 4);
  EXPECT_EQ(reply->request_id(), 11U);
  EXPECT_EQ(reply->writer(), writer->guid());
  EXPECT_EQ(reply->result(), 3);
  EXPECT_EQ(reply->detail(), 0x06020000U);
  EXPECT_EQ(reply->value(), 5U);
  EXPECT_EQ(reply->data(), data);
}

TEST(CommandReplies, NameTheWriterThatAsked) {
  Child child({"--commands"});
  Peer peer;
  auto writer = peer.writer<AxisCommand>(kCommands);
  auto replies = peer.reader<CommandReply>("axisgate/command_reply", {.depth = 10});
  ASSERT_TRUE(writer->wait_matched());
  ASSERT_TRUE(writer->write(command(2, 5)));
  const std::optional<CommandRecord> asked = child.next<CommandRecord>();
  ASSERT_TRUE(asked);
  const ReplyRecord answer{.axis = 2, .request_id = 5, .writer = asked->writer, .result = 7, .detail = 9};
  const std::optional<CommandReply> reply = until_heard(child, answer, *replies);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->axis(), 2);
  EXPECT_EQ(reply->request_id(), 5U);
  EXPECT_EQ(reply->writer(), writer->guid());
  EXPECT_EQ(reply->result(), 7);
  EXPECT_EQ(reply->detail(), 9U);
}

TEST(CommandWriter, AppearsWithItsStrengthAndAddressAndIsGoneWhenItIsDeleted) {
  Child child({"--commands"});
  Peer peer;
  auto writer = peer.writer<AxisCommand>(kCommands, {.strength = 42});
  const Guid guid = writer->guid();
  EXPECT_EQ(next_of(child, guid), (WriterRecord{guid, 42, false, "127.0.0.1"}));
  writer.reset();
  EXPECT_EQ(next_of(child, guid), (WriterRecord{guid, 42, true, "127.0.0.1"}));
}

TEST(CommandWriter, IsInTheBeatsOnlyWhereItsLivelinessIsASignOfLife) {
  Child child({"--commands"});
  Peer peer;
  const std::chrono::seconds lease(20);
  auto endless = peer.writer<AxisCommand>(kCommands);
  auto automatic = peer.writer<AxisCommand>(kCommands, {.lease = lease});
  auto participant =
      peer.writer<AxisCommand>(kCommands, {.liveliness = Liveliness::manual_by_participant, .lease = lease});
  std::map<Guid, LivelinessKind> told;
  while (told.size() < 3) {
    const std::optional<WriterRecord> record = child.next<WriterRecord>();
    ASSERT_TRUE(record);
    told[record->writer] = record->liveliness;
  }
  EXPECT_EQ(told[endless->guid()], LivelinessKind::endless);
  EXPECT_EQ(told[automatic->guid()], LivelinessKind::automatic);
  EXPECT_EQ(told[participant->guid()], LivelinessKind::manual_by_participant);
  auto counts = peer.writer<AxisCommand>(kCommands, {.liveliness = Liveliness::manual_by_topic, .lease = lease});
  ASSERT_TRUE(counts->wait_matched());
  std::optional<BeatRecord> beat;
  std::uint64_t id = 0;
  do {
    ASSERT_TRUE(counts->write(command(1, ++id)));
    beat = child.next<BeatRecord>();
    ASSERT_TRUE(beat);
  } while (beat->writers.empty());
  EXPECT_THAT(beat->writers, testing::ElementsAre(counts->guid()));
}

TEST(CommandWriter, ThatAssertsByTopicIsGoneWhenItStopsAndBackWhenItWritesAgain) {
  Child child({"--commands"});
  Peer peer;
  auto writer = peer.writer<AxisCommand>(
      kCommands, {.strength = 3, .liveliness = Liveliness::manual_by_topic, .lease = kShortLease});
  const Guid guid = writer->guid();
  EXPECT_EQ(next_of(child, guid), (WriterRecord{guid, 3, false, "127.0.0.1", LivelinessKind::manual_by_topic}));
  ASSERT_TRUE(writer->wait_matched());
  ASSERT_TRUE(writer->write(command(1, 1)));
  ASSERT_TRUE(child.next<CommandRecord>());
  const std::optional<BeatRecord> beat = child.next<BeatRecord>();
  ASSERT_TRUE(beat);
  EXPECT_THAT(beat->writers, testing::ElementsAre(guid));

  EXPECT_EQ(next_of(child, guid), (WriterRecord{guid, 3, true, "127.0.0.1", LivelinessKind::manual_by_topic}));
  const std::optional<BeatRecord> silent = child.next<BeatRecord>();
  ASSERT_TRUE(silent);
  EXPECT_THAT(silent->writers, testing::IsEmpty());

  ASSERT_TRUE(writer->write(command(1, 2)));
  EXPECT_EQ(next_of(child, guid), (WriterRecord{guid, 3, false, "127.0.0.1", LivelinessKind::manual_by_topic}));
}

/// Another process with a writer, which a test can end as a crash would.
class Client {
 public:
  Client(int strength, std::chrono::milliseconds lease) {
    // Before the fork: the domain comes from the number of this process.
    const std::string domain = std::to_string(test_domain());
    const std::string arguments[] = {std::to_string(strength), std::to_string(lease.count())};
    pid_ = fork();
    if (pid_ != 0) return;
    execl(AXISGATE_DDS_CLIENT, AXISGATE_DDS_CLIENT, domain.c_str(), arguments[0].c_str(), arguments[1].c_str(),
          nullptr);
    _exit(127);
  }
  ~Client() { end(); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  void end() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    pid_ = -1;
  }

 private:
  pid_t pid_ = -1;
};

TEST(CommandWriter, WhoseProcessIsKilledIsGoneWhenItsLeaseIsOver) {
  Child child({"--commands"});
  Client client(8, kShortLease);
  const std::optional<WriterRecord> there = child.next<WriterRecord>();
  ASSERT_TRUE(there);
  EXPECT_FALSE(there->gone);
  EXPECT_EQ(there->strength, 8);
  ASSERT_TRUE(child.next<CommandRecord>());
  client.end();
  EXPECT_EQ(next_of(child, there->writer),
            (WriterRecord{there->writer, 8, true, "127.0.0.1", LivelinessKind::manual_by_topic}));
}

TEST(EverySample, IsHeardOfEveryWriterWithItsStrength) {
  Child child({"--commands"});
  Peer peer;
  auto weak = peer.writer<AxisCommand>(kCommands, {.strength = 1});
  auto strong = peer.writer<AxisCommand>(kCommands, {.strength = 9});
  auto equal = peer.writer<AxisCommand>(kCommands, {.strength = 9});
  auto shared = peer.writer<AxisCommand>(kCommands, {.exclusive = false});
  ASSERT_TRUE(weak->wait_matched() && strong->wait_matched() && equal->wait_matched() && shared->wait_matched());
  for (std::uint64_t id = 1; id <= 3; ++id) {
    for (const auto& [writer, strength] : {std::pair{&strong, 9}, {&weak, 1}, {&equal, 9}, {&shared, 0}}) {
      ASSERT_TRUE((*writer)->write(command(1, id)));
      const std::optional<CommandRecord> got = child.next<CommandRecord>();
      ASSERT_TRUE(got);
      EXPECT_EQ(got->writer, (*writer)->guid());
      EXPECT_EQ(got->request_id, id);
      EXPECT_EQ(got->strength, strength);
      EXPECT_NE(got->written, 0);
    }
  }
}

TEST(EverySample, IsHeardBesideAStrongerWriterThatWasKilled) {
  Child child({"--commands"});
  Client client(9, kShortLease);
  ASSERT_TRUE(child.next<CommandRecord>());
  client.end();
  Peer peer;
  auto weak = peer.writer<AxisCommand>(kCommands, {.strength = 1});
  ASSERT_TRUE(weak->wait_matched());
  ASSERT_TRUE(weak->write(command(1, 5)));
  const std::optional<CommandRecord> got = command_of(child, weak->guid());
  ASSERT_TRUE(got);
  EXPECT_EQ(got->request_id, 5U);
}

TEST(EverySample, ThatIsAStopPassesThoseThatWait) {
  Child child({"--commands"});
  Peer peer;
  auto busy = peer.writer<AxisCommand>(kCommands);
  auto other = peer.writer<AxisCommand>(kCommands);
  ASSERT_TRUE(busy->wait_matched() && other->wait_matched());
  // More than the socket takes while nobody reads it.
  constexpr std::uint64_t kMany = 2000;
  for (std::uint64_t id = 1; id <= kMany; ++id) ASSERT_TRUE(busy->write(command(1, id)));
  AxisCommand stop = command(1, 1);
  stop.command(3);
  const Guid stranger = other->guid();
  ASSERT_TRUE(other->write(stop));
  other.reset();  // it waits until its stop is acknowledged: only then is anything read
  std::uint64_t before = 0;
  for (std::optional<CommandRecord> got; !got || got->writer != stranger; ++before) {
    got = child.next<CommandRecord>();
    ASSERT_TRUE(got);
  }
  EXPECT_LT(before, kMany);
  for (; before <= kMany; ++before) ASSERT_TRUE(child.next<CommandRecord>()) << "none is lost";
}

TEST(Heartbeat, ReachesTheGatewayWithItsWriterAndItsTime) {
  Child child({"--commands"});
  Peer peer;
  auto commands = peer.writer<AxisCommand>(kCommands);
  auto writer = peer.writer<Heartbeat>("axisgate/heartbeat", {.exclusive = false});
  ASSERT_TRUE(commands->wait_matched() && writer->wait_matched());
  Heartbeat sent;
  sent.client(commands->guid());
  sent.counter(0xFFFFFFFE);
  sent.lease_ms(300);
  // Best effort: what is written before the reader knows the writer is lost.
  std::optional<HeartbeatRecord> got;
  for (int tries = 0; !got && tries < 1000; ++tries) {
    ASSERT_TRUE(writer->write(sent));
    const std::optional<Record> record = child.receive(std::chrono::milliseconds(20));
    if (record && std::holds_alternative<HeartbeatRecord>(*record)) got = std::get<HeartbeatRecord>(*record);
  }
  ASSERT_TRUE(got);
  EXPECT_EQ(got->writer, writer->guid());
  EXPECT_EQ(got->client, commands->guid());
  EXPECT_EQ(got->counter, 0xFFFFFFFE);
  EXPECT_EQ(got->lease_ms, 300U);
  EXPECT_NE(got->written, 0);
}

}  // namespace
}  // namespace axisgate::dds::test
