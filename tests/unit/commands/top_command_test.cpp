// SPDX-License-Identifier: Apache-2.0
// `axisgate top` against a real server on loopback, in a thread of its own.
#include "gateway/commands/top/top_command.hpp"

#include <gmock/gmock.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <fstream>
#include <thread>

#include "tests/places.hpp"
#include "tests/unit/commands/running_server.hpp"

namespace axisgate::commands {
namespace {

using test_server::RunningServer;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Shown {
  int status = 0;
  std::string out;
  std::string err;
};

Shown shown_by(const TopOptions& options) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Shown shown;
  shown.status = run(options);
  shown.out = ::testing::internal::GetCapturedStdout();
  shown.err = ::testing::internal::GetCapturedStderr();
  return shown;
}

TopOptions once(const std::string& endpoint) {
  TopOptions options;
  options.endpoint = endpoint;
  options.count = 1;
  return options;
}

std::size_t times(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(TopCommand, ShowsTheFloatsOfAListenerThatHasThem) {
  modbus_tcp::ListenerSettings settings;
  settings.float_numbers = settings.low_word_first = true;
  const RunningServer server(settings);
  const Shown shown = shown_by(once(server.endpoint()));
  EXPECT_EQ(shown.status, 0);
  EXPECT_THAT(shown.out, AllOf(HasSubstr("  10.0000  "), HasSubstr("  20.0000  "), HasSubstr("  30.0000  ")));
}

TEST(TopCommand, ShowsOneTableOfAllAxes) {
  const RunningServer server;
  const Shown shown = shown_by(once(server.endpoint()));
  EXPECT_EQ(shown.status, 0);
  EXPECT_THAT(shown.out, HasSubstr("axisgate " + server.endpoint() + "  running  axes online 3 of 3"));
  EXPECT_THAT(shown.out, AllOf(HasSubstr("  100000  "), HasSubstr("  200000  "), HasSubstr("  300000  ")));
  EXPECT_THAT(shown.out, AllOf(HasSubstr("standstill"), HasSubstr("not_homed"), Not(HasSubstr("\x1b"))));
}

TEST(TopCommand, SeesAllAxesWhereAListenerShowsOnePerUnitId) {
  modbus_tcp::ListenerSettings settings;
  settings.per_axis_units = true;
  const RunningServer server(settings);
  EXPECT_THAT(shown_by(once(server.endpoint())).out, AllOf(HasSubstr("  100000  "), HasSubstr("  300000  ")));
}

TEST(TopCommand, FindsTheGatewayByItsConfigurationAndAsksItForTheNamesThatThisHasNot) {
  const RunningServer server({}, 2, {{1, "lift"}, {2, "table"}});
  const std::string file = testing::TempDir() + "top_gateway.json";
  std::ofstream(file) << R"({"modbus_tcp": [{"listen": ")" << server.endpoint()
                      << R"("}], "buses": [{"name": "s", "adapter": "kinco-serial", "device": "/dev/ttyUSB0",
    "rs485": "off", "drives": [{"profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 1, "name": "lift"}]}]}]})";
  TopOptions options;
  options.count = 1;
  options.config = file;
  options.profile_folders = {test::source_path("schemas/drives")};
  const Shown shown = shown_by(options);
  EXPECT_EQ(shown.status, 0);
  EXPECT_THAT(shown.out,
              AllOf(HasSubstr("axisgate " + server.endpoint()), HasSubstr("  lift "), HasSubstr("  table ")));
}

TEST(TopCommand, SaysWhyWhenNobodyListens) {
  std::uint16_t port = 0;
  {
    const RunningServer server;
    port = server.port();
  }
  const Shown shown = shown_by(once("127.0.0.1:" + std::to_string(port)));
  EXPECT_EQ(shown.status, 1);
  EXPECT_THAT(shown.err, HasSubstr("Connection refused"));
}

TEST(TopCommand, SaysWhatAClosedConnectionMayMean) {
  modbus_tcp::ListenerSettings settings;
  settings.has_allow = true;
  const RunningServer server(settings);
  const Shown shown = shown_by(once(server.endpoint()));
  EXPECT_EQ(shown.status, 1);
  EXPECT_THAT(shown.err, HasSubstr("allow-list"));
}

TEST(TopCommand, SaysThatTheGatewayIsGoneAndComesBackWhenItDoes) {
  boost::asio::io_context io(1);
  // A gateway that stops as soon as it has a client, and one that starts in its place.
  using boost::asio::ip::tcp;
  auto stopping = std::make_unique<tcp::acceptor>(io, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
  modbus_tcp::ListenerSettings settings;
  settings.port = stopping->local_endpoint().port();
  std::unique_ptr<RunningServer> started;
  std::thread restart([&] {
    stopping->accept().close();
    stopping.reset();
    started = std::make_unique<RunningServer>(settings);
  });
  TopOptions options = once("127.0.0.1:" + std::to_string(settings.port));
  options.count = 2;
  options.interval_ms = 1;
  const Shown shown = shown_by(options);
  restart.join();
  EXPECT_EQ(shown.status, 0);
  EXPECT_EQ(times(shown.out, "running"), 2U);
  EXPECT_LT(shown.out.find("trying again each second"), shown.out.find("running"));
}

TEST(TopCommand, AnEndpointThatIsNoneIsAWrongCommandLine) {
  for (const char* endpoint : {"localhost", ":1502", "localhost:", "localhost:x", "localhost:70000", "::1:1502"}) {
    const Shown shown = shown_by(once(endpoint));
    EXPECT_EQ(shown.status, 2) << endpoint;
    EXPECT_THAT(shown.err, HasSubstr("is no HOST:PORT")) << endpoint;
  }
}

}  // namespace
}  // namespace axisgate::commands
