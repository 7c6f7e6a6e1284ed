// SPDX-License-Identifier: Apache-2.0
// How the gateway runs axisgate-dds: it is started, its ends are told apart, it comes back, and nothing of it stays.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "tests/unit/dds_host/hosted.hpp"

namespace axisgate::dds {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::SizeIs;

TEST_F(Hosted, RaisesTheAlarmUntilTopicsAreThere) {
  start("normal");
  EXPECT_TRUE(down);
  ASSERT_TRUE(run_until_ready());
  ASSERT_THAT(told, SizeIs(1));
  EXPECT_EQ(told[0].kind, EventKind::boot);
  EXPECT_EQ(told[0].text, "axisgate-dds 9.9 runs");
}

TEST_F(Hosted, StartsItAgainWhenItIsKilled) {
  start("normal");
  ASSERT_TRUE(run_until_ready());
  const pid_t first = server->keeper().pid().value();
  ASSERT_EQ(kill(first, SIGKILL), 0);
  ASSERT_TRUE(run_until([&] { return down; })) << "nobody noticed";
  ASSERT_TRUE(run_until_ready());
  EXPECT_NE(server->keeper().pid().value(), first);
  ASSERT_THAT(told, SizeIs(3));
  EXPECT_EQ(told[1].kind, EventKind::warning);
  EXPECT_EQ(told[1].text,
            "axisgate-dds was killed: signal 9 (KILL), by somebody or by the system for want of memory; started again "
            "in 0.2 s");
  EXPECT_EQ(told[2].kind, EventKind::boot);
}

TEST_F(Hosted, SaysThatAnAddressIsMissingUntilItIsThere) {
  start("ends with 74");
  ASSERT_TRUE(run_until([&] { return address_missing; }));
  EXPECT_TRUE(down);
  behave("normal");
  ASSERT_TRUE(run_until_ready());
  EXPECT_FALSE(address_missing);
}

class Ends : public Hosted, public ::testing::WithParamInterface<std::pair<std::string, std::string>> {};

TEST_P(Ends, AreToldApartAndFollowedByAnotherStart) {
  for (AxisNumber number = 1; number <= 499; ++number) image.add_axis(number, "axis", 0);  // more than the socket holds
  start(GetParam().first);
  const bool reads_nothing = GetParam().first == "reads nothing";
  ASSERT_TRUE(!reads_nothing || run_until_ready());
  ASSERT_TRUE(!(reads_nothing || GetParam().first == "is never ready") || skip_until_told(reads_nothing ? 2 : 1));
  ASSERT_TRUE(run_until([&] { return !told.empty() && told.back().kind == EventKind::warning; }));
  EXPECT_TRUE(down);
  EXPECT_THAT(told.back().text, HasSubstr(GetParam().second));
  behave("normal");
  EXPECT_TRUE(run_until_ready());
}

INSTANTIATE_TEST_SUITE_P(
    All, Ends,
    ::testing::Values(
        std::pair{"crashes at once", "axisgate-dds crashed: signal 11 (SEGV)"},
        std::pair{"crashes when ready", "axisgate-dds crashed: signal 11 (SEGV)"},
        std::pair{"dies of 7", "a /dev/shm that is too small"},
        std::pair{"dies of 15", "axisgate-dds was ended: signal 15 (TERM)"},
        std::pair{"ends with 0", "lost its connection to the gateway"},
        std::pair{"ends with 5", "ended with exit code 5"}, std::pair{"ends with 64", "does not know its command line"},
        std::pair{"ends with 70", "met a state that it cannot go on from"},
        std::pair{"ends with 71", "could not create its participant: look at `domain` and `qos_file`"},
        std::pair{"ends with 72", "was sent what is no record"},
        std::pair{"ends with 73", "reached its memory limit (memory_limit_mb)"},
        std::pair{"ends with 74", "has no address yet on one of its `interfaces`"},
        std::pair{"is never ready", "was not ready in time and was killed"},
        std::pair{"reads nothing", "took nothing from the gateway for too long and was killed"},
        std::pair{"sends garbage", "sent another version: axisgate and axisgate-dds are not of one installation"},
        std::pair{"sends a longer packet than there is", "sent a packet longer than any record and was killed"},
        std::pair{"sends what only the gateway sends", "sent a record out of its turn and was killed"},
        std::pair{"asks before it is ready", "sent a record out of its turn and was killed"},
        std::pair{"closes and goes on", "closed its connection, did not end and was killed"}),
    [](const auto& end) {
      std::string name = end.param.first;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

TEST_F(Hosted, TellsWhatItSaidBeforeItEnded) {
  start("says why and ends");
  ASSERT_TRUE(run_until_told(1));
  EXPECT_THAT(lines, ElementsAre("no interface eth7"));
}

TEST_F(Hosted, TellsAnEndThatRepeatsItselfOnce) {
  start("ends with 71");
  for (int starts = 1; starts <= 6; ++starts) {
    ASSERT_TRUE(run_until([&] { return server->keeper().pid().has_value(); })) << starts;
    ASSERT_TRUE(run_until([&] { return !server->keeper().pid(); })) << starts;
    runtime->skip(std::chrono::seconds(30));  // the longest pause
  }
  EXPECT_THAT(told, SizeIs(1));
  behave("normal");
  ASSERT_TRUE(run_until_ready());
  EXPECT_THAT(told.back().text, ::testing::MatchesRegex("axisgate-dds 9.9 runs, after [0-9]+ ends"));
}

TEST_F(Hosted, RunsOnWithoutTheProgramAndFindsItWhenItIsInstalled) {
  setenv("AXISGATE_DDS_PROGRAM", "/nowhere/axisgate-dds", 1);
  start("normal");
  EXPECT_TRUE(down);
  ASSERT_THAT(told, SizeIs(1));
  EXPECT_EQ(told[0].kind, EventKind::warning);
  EXPECT_THAT(told[0].text, HasSubstr("not installed: AXISGATE_DDS_PROGRAM names /nowhere/axisgate-dds"));
  setenv("AXISGATE_DDS_PROGRAM", AXISGATE_FAKE_DDS, 1);
  EXPECT_TRUE(run_until_ready());
}

TEST_F(Hosted, GivesItNothingButItsSocketAndTheStandardStreams) {
  const int ours = open("/dev/null", O_RDONLY);  // as somebody's library opens it, without CLOEXEC
  std::signal(SIGPIPE, SIG_IGN);
  sigset_t blocked;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  const int nice = getpriority(PRIO_PROCESS, 0);
  start("tells what it inherited");
  const bool said = run_until_said("last");
  sigprocmask(SIG_UNBLOCK, &blocked, nullptr);
  close(ours);
  ASSERT_TRUE(said);
  EXPECT_THAT(lines, IsSupersetOf({"open: 0 1 2 3", "input: /dev/null", "blocked: 0", "SIGPIPE: default",
                                   "group of its own: 1"}));
  EXPECT_THAT(lines, Contains("nice: " + std::to_string(std::min(19, nice + kProgram.nicer))));
}

TEST_F(Hosted, EndsItOnStop) {
  start("normal");
  ASSERT_TRUE(run_until_ready());
  const pid_t pid = server->keeper().pid().value();
  server->stop();
  EXPECT_FALSE(server->keeper().pid());
  EXPECT_EQ(kill(pid, 0), -1) << "it still runs";
  EXPECT_TRUE(no_child_is_left());
  EXPECT_THAT(told, SizeIs(1)) << "an end that was wanted is no event";
}

TEST_F(Hosted, KillsItOnStopWhereItDoesNotEndByItself) {
  start("does not end");
  ASSERT_TRUE(run_until_ready());
  const pid_t pid = server->keeper().pid().value();
  server->stop();
  EXPECT_EQ(kill(pid, 0), -1) << "it still runs";
  EXPECT_TRUE(no_child_is_left());
}

TEST_F(Hosted, LeavesNoProcessAndNoDescriptorBehind) {
  start("normal");
  ASSERT_TRUE(run_until_ready());
  server.reset();
  const auto before = open_descriptors();
  for (const std::string how : {"crashes when ready", "sends garbage", "closes and goes on", "ends with 71"}) {
    told.clear();
    start(how);
    ASSERT_TRUE(run_until([&] { return !told.empty() && told.back().kind == EventKind::warning; })) << how;
    EXPECT_TRUE(no_child_is_left()) << how;
    behave("normal");
    ASSERT_TRUE(run_until_ready());
    server.reset();
    io.restart();
    io.poll();
    EXPECT_EQ(open_descriptors(), before) << how;
    EXPECT_TRUE(no_child_is_left()) << how;
  }
}

}  // namespace
}  // namespace axisgate::dds
