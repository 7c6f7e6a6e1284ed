// SPDX-License-Identifier: Apache-2.0
// How the gateway runs axisgate-web: its ends are told apart, it comes back, and no drive and no loop waits for it.
#include "gateway/upstream/web_host/web_server.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "gateway/upstream/web_host/web_program.hpp"
#include "tests/unit/support/skipping_runtime.hpp"

namespace axisgate::web {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class HostedWeb : public ::testing::Test {
 protected:
  HostedWeb() { setenv("AXISGATE_WEB_PROGRAM", AXISGATE_FAKE_WEB, 1); }
  ~HostedWeb() override {
    server.reset();
    unsetenv("AXISGATE_WEB_PROGRAM");
  }
  void start(const std::string& behaviour) {
    behave(behaviour);
    AxisImage& axis = image.add_axis(1, "lift", 0);
    axis.supported = bit(Quantity::position_actual);
    runtime = std::make_unique<test::SkippingRuntime>(io);
    server = std::make_unique<WebServer>(
        io, *runtime, Boot{"0.3", 1, runtime->now()}, image, events, [] { return ProcessFigures{}; }, log,
        host::KeeperReports{[this](EventKind kind, std::string text) {
                              told.push_back({kind, std::move(text)});
                            },
                            {},
                            [this](bool is) { address_missing = is; }});
    server->run(WebSettings{}, facts);
  }
  static void behave(const std::string& behaviour) { setenv("FAKE_WEB", behaviour.c_str(), 1); }

  /// False: it never came true.
  template <typename Condition>
  [[nodiscard]] bool run_until(Condition&& condition) {
    const auto hanging = std::chrono::steady_clock::now() + std::chrono::seconds(100);
    while (!condition()) {
      io.restart();
      if (std::chrono::steady_clock::now() > hanging) return false;
      io.run_one_for(std::chrono::seconds(1));
    }
    return true;
  }
  [[nodiscard]] bool run_until_ready() {
    return run_until([&] { return server->keeper().ready(); });
  }
  [[nodiscard]] bool run_until_warned() {
    return run_until([&] { return !told.empty() && told.back().kind == EventKind::warning; });
  }
  [[nodiscard]] bool run_until_said(const std::string& line) {
    return run_until([&] { return std::find(lines.begin(), lines.end(), line) != lines.end(); });
  }
  void move(std::int64_t position) {
    image.find(1)->samples[static_cast<std::size_t>(Quantity::position_actual)] = {position, true, true,
                                                                                   runtime->now()};
    image.find(1)->link_state = LinkState::online;
    image.changes.mark(1);
  }

  struct Told {
    EventKind kind;
    std::string text;
  };
  boost::asio::io_context io{1};
  std::unique_ptr<test::SkippingRuntime> runtime;
  ProcessImage image;
  EventRing events;
  WebFacts facts{false, false, {{1, "Kinco JD", "kinco-jd", 1}}, {{0, "lift", "canopen", "can0", 0, 0}}, {}};
  std::vector<std::string> lines;
  Log log{[this](LogLevel, std::string_view source, std::string_view text) {
            lines.push_back(source == "web" ? std::string(text) : std::string(source) + "?" + std::string(text));
          },
          LogLevel::debug};
  std::vector<Told> told;
  bool address_missing = false;
  std::unique_ptr<WebServer> server;
};

TEST_F(HostedWeb, SendsItAllThatThereIsAndThenWhatChanges) {
  start("tells what comes");
  ASSERT_TRUE(run_until_ready());
  ASSERT_THAT(told, SizeIs(1));
  EXPECT_EQ(told[0].text, "axisgate-web 9.9 runs");
  for (const char* const kind : {"kind 0", "kind 1", "kind 2", "kind 4", "kind 6"}) EXPECT_TRUE(run_until_said(kind));
  move(41);
  EXPECT_TRUE(run_until_said("axis 1 is at 41"));
  move(42);
  EXPECT_TRUE(run_until_said("axis 1 is at 42"));
}

TEST_F(HostedWeb, StartsItAgainWhenItIsKilledAndSendsItAllOnceMore) {
  start("tells what comes");
  ASSERT_TRUE(run_until_said("kind 6"));
  lines.clear();
  ASSERT_EQ(kill(server->keeper().pid().value(), SIGKILL), 0);
  ASSERT_TRUE(run_until_warned());
  EXPECT_THAT(told.back().text, HasSubstr("axisgate-web was killed: signal 9 (KILL)"));
  ASSERT_TRUE(run_until_said("kind 6"));
  EXPECT_THAT(lines, Contains("kind 0"));
  EXPECT_EQ(server->keeper().restarts(), 1U);
}

TEST_F(HostedWeb, GoesOnBesideOneThatStandsStillAndEndsIt) {
  start("normal");
  ASSERT_TRUE(run_until_ready());
  const pid_t first = server->keeper().pid().value();
  ASSERT_EQ(kill(first, SIGSTOP), 0);
  // The socket fills; nobody waits for it.
  std::int64_t position = 0;
  ASSERT_TRUE(run_until([&] {
    move(++position);
    runtime->skip(std::chrono::seconds(1));
    return told.size() >= 2;
  }));
  EXPECT_THAT(told.back().text, HasSubstr("axisgate-web took nothing from the gateway for too long and was killed"));
  ASSERT_TRUE(run_until_ready());
  EXPECT_NE(server->keeper().pid().value(), first);
}

class WebEnds : public HostedWeb, public ::testing::WithParamInterface<std::pair<std::string, std::string>> {};

TEST_P(WebEnds, AreToldApartAndFollowedByAnotherStart) {
  start(GetParam().first);
  ASSERT_TRUE(run_until_warned());
  EXPECT_THAT(told.back().text, HasSubstr(GetParam().second));
  behave("normal");
  EXPECT_TRUE(run_until_ready());
}

INSTANTIATE_TEST_SUITE_P(
    All, WebEnds,
    ::testing::Values(std::pair{"ends with 0", "lost its connection to the gateway"},
                      std::pair{"ends with 71", "axisgate-web cannot listen on the address of `web`"},
                      std::pair{"ends with 73", "reached its memory limit (memory_limit_mb)"},
                      std::pair{"sends garbage",
                                "sent another version: axisgate and axisgate-web are not of one installation"},
                      std::pair{"asks for something", "sent a record out of its turn and was killed"},
                      std::pair{"is ready twice", "sent a record out of its turn and was killed"},
                      std::pair{"closes and goes on", "closed its connection, did not end and was killed"}),
    [](const auto& end) {
      std::string name = end.param.first;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

TEST_F(HostedWeb, SaysThatItsAddressIsMissingUntilItIsThere) {
  start("ends with 74");
  ASSERT_TRUE(run_until([&] { return address_missing; }));
  behave("normal");
  ASSERT_TRUE(run_until_ready());
  EXPECT_FALSE(address_missing);
}

TEST_F(HostedWeb, GoesOnWhereItIsNotInstalled) {
  setenv("AXISGATE_WEB_PROGRAM", "/nowhere/axisgate-web", 1);
  start("normal");
  ASSERT_THAT(told, SizeIs(1));
  EXPECT_EQ(told[0].kind, EventKind::warning);
  EXPECT_THAT(told[0].text, HasSubstr("axisgate-web is not installed: AXISGATE_WEB_PROGRAM names /nowhere/"));
  setenv("AXISGATE_WEB_PROGRAM", AXISGATE_FAKE_WEB, 1);
  EXPECT_TRUE(run_until_ready());
}

TEST_F(HostedWeb, LetsTheCoreGoFirst) {
  const int nice = getpriority(PRIO_PROCESS, 0);
  start("says how nice it is");
  EXPECT_TRUE(run_until_said("nice: " + std::to_string(std::min(19, nice + 10))));
}

TEST_F(HostedWeb, StartsItAgainWithAnotherConfigurationAndSaysSoByNoWarning) {
  start("says its command line");
  ASSERT_TRUE(run_until_said("serve"));
  lines.clear();
  WebSettings settings;
  settings.listen = "127.0.0.1:8081";
  server->run(settings, facts);
  ASSERT_TRUE(run_until([&] {
    return std::ranges::any_of(lines, [](const std::string& line) { return line.find("127.0.0.1:8081") != line.npos; });
  }));
  for (const Told& each : told) EXPECT_EQ(each.kind, EventKind::boot);
}

TEST_F(HostedWeb, KeepsItWhereNothingOfItsOwnHasChanged) {
  start("tells what comes");
  ASSERT_TRUE(run_until_said("kind 6"));
  const pid_t pid = server->keeper().pid().value();
  facts.axes.clear();
  server->run(WebSettings{}, facts);
  move(7);
  io.restart();
  io.run_for(std::chrono::milliseconds(50));
  EXPECT_EQ(server->keeper().pid(), pid);
  EXPECT_THAT(told, SizeIs(1));
}

TEST_F(HostedWeb, EndsItWhereThereIsToBeNoPage) {
  start("normal");
  ASSERT_TRUE(run_until_ready());
  server->run(std::nullopt, facts);
  ASSERT_TRUE(run_until([&] { return !server->keeper().pid(); }));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
  runtime->skip(std::chrono::seconds(60));
  io.restart();
  io.run_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(server->keeper().pid());
  server->run(WebSettings{}, facts);
  EXPECT_TRUE(run_until_ready());
}

}  // namespace
}  // namespace axisgate::web
