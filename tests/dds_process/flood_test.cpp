// SPDX-License-Identifier: Apache-2.0
// A client that sends more commands than anybody takes: what all others send comes through beside it.
#include <gmock/gmock.h>

#include <memory>
#include <optional>

#include "tests/dds_process/child.hpp"
#include "tests/dds_process/peer.hpp"

namespace axisgate::dds::test {
namespace {

TEST(EverySample, SaysWhenItWasReceived) {
  Child child({"--commands"});
  Peer peer;
  auto commands = peer.writer<AxisCommand>(kCommands);
  auto objects = peer.writer<ObjectRequest>(kObjects, {.exclusive = false});
  ASSERT_TRUE(commands->wait_matched() && objects->wait_matched());
  ASSERT_TRUE(commands->write(command(1, 1)));
  const std::optional<CommandRecord> first = child.next<CommandRecord>();
  ASSERT_TRUE(first);
  ASSERT_TRUE(objects->write({}));
  const std::optional<ObjectRequestRecord> second = child.next<ObjectRequestRecord>();
  ASSERT_TRUE(second);
  ASSERT_TRUE(commands->write(command(1, 2)));
  const std::optional<CommandRecord> third = child.next<CommandRecord>();
  ASSERT_TRUE(third);
  EXPECT_GT(first->received, 0);
  EXPECT_LT(first->received, third->received);
  EXPECT_LE(second->received, third->received);
}

/// Commands that the socket does not take, so that they wait in the program.
constexpr std::uint64_t kFlood = 2000;

std::unique_ptr<Writer<AxisCommand>> flood(Peer& peer) {
  auto writer = peer.writer<AxisCommand>(kCommands);
  if (!writer->wait_matched()) return nullptr;
  for (std::uint64_t id = 1; id <= kFlood; ++id)
    if (!writer->write(command(1, id))) return nullptr;
  return writer;
}

/// How many commands come before the first record of this kind.
template <typename Kind>
std::optional<std::uint64_t> commands_before(Child& child) {
  std::uint64_t before = 0;
  while (const std::optional<Record> record = child.receive()) {
    if (std::holds_alternative<Kind>(*record)) return before;
    if (std::holds_alternative<CommandRecord>(*record)) ++before;
    if (before == kFlood) break;
  }
  return std::nullopt;
}

TEST(AFlood, KeepsNoRequestForAnObjectWaiting) {
  Child child({"--commands"});
  Peer peer;
  auto other = peer.writer<ObjectRequest>(kObjects, {.exclusive = false});
  ASSERT_TRUE(other->wait_matched());
  auto busy = flood(peer);
  ASSERT_TRUE(busy);
  ObjectRequest request;
  request.axis(1);
  request.request_id(1);
  ASSERT_TRUE(other->write(request));
  other.reset();  // it waits until the request is acknowledged: only then is anything read
  EXPECT_TRUE(commands_before<ObjectRequestRecord>(child)) << "all commands came first";
}

TEST(AFlood, KeepsNoStopOfARosTopicWaiting) {
  Child child({"--commands", "--ros2"});
  child.send(StateRecord{.axis = 1, .name = "lift"});
  Peer peer;
  auto stop = peer.writer<std_msgs::msg::dds_::Empty_>("rt/lift/quick_stop", {.exclusive = false});
  ASSERT_TRUE(stop->wait_matched());
  auto busy = flood(peer);
  ASSERT_TRUE(busy);
  ASSERT_TRUE(stop->write({}));
  stop.reset();
  EXPECT_TRUE(commands_before<RosActionRecord>(child)) << "all commands came first";
}

TEST(AFlood, KeepsNoHeartbeatWaiting) {
  Child child({"--commands"});
  Peer peer;
  auto commands = peer.writer<AxisCommand>(kCommands);
  auto writer = peer.writer<Heartbeat>("axisgate/heartbeat", {.exclusive = false});
  ASSERT_TRUE(commands->wait_matched() && writer->wait_matched());
  Heartbeat beat;
  beat.client(commands->guid());
  // Best effort: each turn one more, and more commands than are read.
  std::uint64_t id = 0;
  bool heard = false;
  for (const auto until = std::chrono::steady_clock::now() + kPatience; !heard;) {
    ASSERT_LT(std::chrono::steady_clock::now(), until);
    for (int i = 0; id < kFlood || i < 2; ++i) ASSERT_TRUE(commands->write(command(1, ++id)));
    ASSERT_TRUE(writer->write(beat));
    std::optional<Record> record = child.receive();
    ASSERT_TRUE(record);
    heard = std::holds_alternative<HeartbeatRecord>(*record);
  }
}

TEST(Heartbeats, OfEveryClientThatADomainMayHaveAreHeard) {
  constexpr std::uint16_t kClients = kMaxWritersKnown;
  Child child({"--commands"});
  Peer peer;
  auto writer = peer.writer<Heartbeat>("axisgate/heartbeat", {.exclusive = false});
  ASSERT_TRUE(writer->wait_matched());
  for (std::uint16_t client = 1; client <= kClients; ++client) {
    Heartbeat beat;
    Guid guid = writer->guid();
    guid[12] = static_cast<std::uint8_t>(client >> 8U);
    guid[13] = static_cast<std::uint8_t>(client);
    beat.client(guid);
    // Best effort: again until it is heard.
    bool heard = false;
    for (const auto until = std::chrono::steady_clock::now() + kPatience; !heard;) {
      ASSERT_LT(std::chrono::steady_clock::now(), until) << client;
      ASSERT_TRUE(writer->write(beat));
      const auto record = child.receive(std::chrono::milliseconds(200));
      const auto* const got = record ? std::get_if<HeartbeatRecord>(&*record) : nullptr;
      heard = got != nullptr && got->client == guid;
    }
  }
}

}  // namespace
}  // namespace axisgate::dds::test
