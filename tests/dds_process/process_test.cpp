// SPDX-License-Identifier: Apache-2.0
// How axisgate-dds begins and ends.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <ostream>

#include "gateway/upstream/link/exit_codes.hpp"
#include "tests/dds_process/child.hpp"
#include "tests/dds_process/peer.hpp"

namespace axisgate::dds::test {
namespace {

using testing::HasSubstr;

std::string last_line(Child& child) {
  std::string text;
  while (const std::optional<LogRecord> line = child.next<LogRecord>()) text = line->text;
  return text;
}

TEST(Process, EndsWithZeroWhenTheGatewayIsGone) {
  Child child({"--commands", "--ros2"});
  child.close_link();
  EXPECT_EQ(child.exit_code(), link::kExitGatewayGone);
}

TEST(Process, SaysOnceThatItIsReady) {
  Child child({}, false);
  const std::optional<Record> first = child.receive();
  ASSERT_TRUE(first);
  ASSERT_TRUE(std::holds_alternative<ReadyRecord>(*first));
  EXPECT_THAT(std::get<ReadyRecord>(*first).version, HasSubstr("."));
}

TEST(Process, LeavesCtrlCOfTheTerminalToTheGateway) {
  Child child;
  kill(child.pid(), SIGINT);
  Peer peer;
  auto states = peer.reader<AxisState>("axisgate/axis_state", {.transient_local = true});
  child.send(StateRecord{.axis = 1, .name = "lift"});
  EXPECT_TRUE(states->next());
}

TEST(Process, EndsAtAPacketThatIsNoRecord) {
  Child child;
  child.send_bytes({kLinkVersion, 0, 7});
  EXPECT_THAT(last_line(child), HasSubstr("another length"));
  EXPECT_EQ(child.exit_code(), link::kExitProtocol);
}

TEST(Process, EndsAtARecordOfAnotherVersion) {
  Child child;
  std::vector<Byte> packet = encode(StateRecord{});
  packet[0] = kLinkVersion + 1;
  child.send_bytes(packet);
  EXPECT_THAT(last_line(child), HasSubstr("not of one installation"));
  EXPECT_EQ(child.exit_code(), link::kExitProtocol);
}

TEST(Process, EndsAtARecordThatOnlyItselfSends) {
  Child child;
  child.send(BeatRecord{});
  EXPECT_THAT(last_line(child), HasSubstr("never sends"));
  EXPECT_EQ(child.exit_code(), link::kExitProtocol);
}

TEST(Process, NamesTheInterfaceThatIsNotThereAndThoseThatAre) {
  Child child({"--interface", "nosuch0"}, false);
  const std::string line = last_line(child);
  EXPECT_THAT(line, HasSubstr("--interface nosuch0"));
  EXPECT_THAT(line, HasSubstr("lo (127.0.0.1)"));
  EXPECT_EQ(child.exit_code(), link::kExitNoAddress);
}

TEST(Process, EndsAtItsMemoryLimit) {
  Child child({"--commands", "--memory-limit-mib", "32"});
  Peer peer;
  auto writer = peer.writer<ObjectRequest>("axisgate/object_request", {.exclusive = false, .heartbeats = false});
  ASSERT_TRUE(writer->wait_matched());
  // The gateway does not read: what it does not take stays with axisgate-dds, 64 samples an axis.
  // Some may be lost on their way, where the machine is busy: so it goes on until there were enough.
  const auto give_up = std::chrono::steady_clock::now() + 4 * kPatience;
  ObjectRequest sample;
  sample.data(std::vector<Byte>(kMaxObjectBytes));
  for (int i = 0; !child.hung_up() && std::chrono::steady_clock::now() < give_up; ++i) {
    sample.axis(static_cast<std::uint16_t>(i / 50 % 500));
    sample.request_id(static_cast<std::uint64_t>(i) + 1);
    writer->write(sample);
  }
  ASSERT_TRUE(child.hung_up());
  EXPECT_EQ(child.exit_code(), link::kExitMemory);
  EXPECT_THAT(child.error_output(), HasSubstr("--memory-limit-mib"));
}

TEST(Process, TakesQosFromAFile) {
  const std::string path = testing::TempDir() + "axisgate_dds_qos_" + std::to_string(getpid()) + ".xml";
  std::ofstream(path) << R"(<?xml version="1.0"?><profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
    <data_writer profile_name="axisgate_axis_state"><topic><historyQos><kind>KEEP_LAST</kind><depth>1</depth></historyQos></topic>
    <qos><durability><kind>VOLATILE</kind></durability><reliability><kind>RELIABLE</kind></reliability></qos></data_writer></profiles>)";
  Child child({"--qos-file", path});
  Peer peer;
  auto states = peer.reader<AxisState>("axisgate/axis_state", {.transient_local = true});
  auto gateway = peer.reader<GatewayState>("axisgate/gateway_state", {.transient_local = true});
  child.send(StateRecord{.axis = 1, .name = "lift"});
  child.send(GatewayRecord{});
  ASSERT_TRUE(gateway->next());
  // A writer that keeps nothing for late joiners is not matched by a reader that asks for that.
  EXPECT_FALSE(states->matched());
  std::remove(path.c_str());
}

TEST(Process, SaysWhatIsWrongWithAQosFile) {
  const std::string path = testing::TempDir() + "axisgate_dds_bad_" + std::to_string(getpid()) + ".xml";
  std::ofstream(path) << "<profiles><data_writer";
  Child child({"--qos-file", path}, false);
  EXPECT_THAT(last_line(child), HasSubstr("--qos-file " + path));
  EXPECT_EQ(child.exit_code(), link::kExitCannotServe);
  std::remove(path.c_str());
}

struct BadLine {
  std::vector<std::string> arguments;
  std::string says;
};

void PrintTo(const BadLine& line, std::ostream* to) { *to << line.says; }

class CommandLine : public testing::TestWithParam<BadLine> {};

TEST_P(CommandLine, ThatIsWrongIsToldByItsOption) {
  const auto [code, text] = Child::run(GetParam().arguments);
  EXPECT_EQ(code, link::kExitUsage);
  EXPECT_THAT(text, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(Each, CommandLine,
                         testing::Values(BadLine{{}, "subcommand"}, BadLine{{"serve"}, "--link-fd"},
                                         BadLine{{"serve", "--link-fd", "0"}, "axisgate-dds topics"},
                                         BadLine{{"topics", "--domain", "233"}, "--domain"},
                                         BadLine{{"topics", "--once", "--peer", "host"}, "--peer host"},
                                         BadLine{{"topics", "--once", "--discovery-server", "127.0.0.1"},
                                                 "127.0.0.1"}));

/// `topics --once` of an axis that is there. It waits for 5 s; a busy machine may take longer to find it.
std::pair<int, std::string> topics_once(std::vector<std::string> options = {}) {
  constexpr int kTries = 6;
  options.insert(options.begin(), {"topics", "--once", "--domain", std::to_string(test_domain())});
  std::pair<int, std::string> told;
  for (int i = 0; i < kTries; ++i)
    if (told = Child::run(options); told.first == 0) break;
  return told;
}

TEST(Topics, PrintsWhatIsThereOnce) {
  Child child;
  child.send(
      StateRecord{.axis = 12, .name = "turntable", .position = 1.5, .link_state = 2, .supported = 7, .valid = 3});
  const auto [code, text] = topics_once();
  EXPECT_EQ(code, 0);
  EXPECT_THAT(text, HasSubstr("turntable"));
  EXPECT_THAT(text, HasSubstr("online"));
  EXPECT_THAT(text, HasSubstr("1.500?"));
}

TEST(Topics, PrintsJsonForPrograms) {
  Child child;
  child.send(StateRecord{.axis = 12, .name = "turntable", .position = 1.5});
  const auto [code, text] = topics_once({"--json"});
  EXPECT_EQ(code, 0);
  EXPECT_THAT(text, HasSubstr(R"({"gateway_key":0,"gateway":"","axis":12,"name":"turntable",)"));
}

TEST(Topics, LetBytesPassThatAreNoState) {
  Child child;
  child.send(StateRecord{.axis = 12, .name = "turntable", .position = 1.5});
  Peer peer;
  const auto odd =
      peer.writer<dds_peers::RawSample>("axisgate/axis_state", {.exclusive = false, .transient_local = true});
  for (const std::vector<std::uint8_t>& bytes :
       {std::vector<std::uint8_t>(64, 0xFF), {0, 1, 0, 0, 1}, {0, 3, 0, 0, 1, 0, 0, 0}, {0}})
    ASSERT_TRUE(odd->write({bytes}));
  const auto [code, text] = topics_once();
  EXPECT_EQ(code, 0) << text;
  EXPECT_THAT(text, HasSubstr("turntable"));
}

TEST(Topics, SaysWhereToLookIfNoAxisIsThere) {
  const auto [code, text] = Child::run({"topics", "--once", "--domain", std::to_string(test_domain())});
  EXPECT_EQ(code, 1);
  EXPECT_THAT(text, HasSubstr("--domain"));
}

TEST(Namesake, IsToldOnceItsStatesAreHeardAndWhenItGivesUpAnAxisOrIsGone) {
  Child child({"--gateway-name", "cell_7"});
  Child other({"--gateway-name", "cell_8"});
  std::optional<Child> duplicate(std::in_place, std::vector<std::string>{"--gateway-name", "cell_7"});
  StateRecord state;
  state.axis = 3;
  state.name = "lift";
  other.send(state);
  // It may have been sent before anybody listened.
  std::optional<NamesakeRecord> told;
  const auto send_until_told = [&](std::uint16_t axis, const char* name) {
    state.axis = axis;
    state.name = name;
    told.reset();
    for (const auto until = std::chrono::steady_clock::now() + kPatience; !told;) {
      if (std::chrono::steady_clock::now() > until) return;
      duplicate->send(state);
      const std::optional<Record> record = child.receive(std::chrono::milliseconds(50));
      if (record && std::holds_alternative<NamesakeRecord>(*record)) told = std::get<NamesakeRecord>(*record);
    }
  };
  send_until_told(3, "lift");
  ASSERT_TRUE(told);
  EXPECT_EQ(told->axis, 3);
  EXPECT_EQ(told->where, "127.0.0.1");
  EXPECT_FALSE(told->gone);
  const Guid writer = told->writer;
  send_until_told(4, "turntable");
  EXPECT_EQ(told, (NamesakeRecord{writer, 4, "127.0.0.1", false}));
  send_until_told(3, "");  // the last state of an axis that a reload has taken away has no name
  EXPECT_EQ(told, (NamesakeRecord{writer, 3, "127.0.0.1", true}));
  // It is told once, and whoever stood still at that time hears it all the same.
  Peer peer;
  auto reader = peer.reader<AxisState>("axisgate/axis_state", {.transient_local = true, .depth = 0});
  ASSERT_TRUE(reader->next());
  kill(child.pid(), SIGSTOP);
  constexpr int kMoreThanItsSocketHolds = 2000;
  state.axis = 5;
  state.name = "feeder";
  for (int i = 0; i < kMoreThanItsSocketHolds; ++i) duplicate->send(state);
  state.axis = 4;
  state.name = "";
  duplicate->send(state);
  std::optional<AxisState> got;
  do {
    got = reader->next();
    ASSERT_TRUE(got);
  } while (got->axis() != 4 || got->name().size() != 0);
  kill(child.pid(), SIGCONT);
  do {
    told = child.next<NamesakeRecord>();
    ASSERT_TRUE(told);
  } while (told->axis == 5);
  EXPECT_EQ(told, (NamesakeRecord{writer, 4, "127.0.0.1", true}));
  duplicate->close_link();
  told = child.next<NamesakeRecord>();
  EXPECT_EQ(told, (NamesakeRecord{writer, 0, "127.0.0.1", true}));
}

}  // namespace
}  // namespace axisgate::dds::test
