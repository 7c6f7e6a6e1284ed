// SPDX-License-Identifier: Apache-2.0
// `axisgate top` against a real server on loopback, in a thread of its own.
#include "gateway/commands/top/top_command.hpp"

#include <gmock/gmock.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <thread>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"
#include "gateway/upstream/modbus_tcp/server/server.hpp"
#include "tests/unit/modbus_server/filled_image.hpp"

namespace axisgate::commands {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class RunningServer {
 public:
  explicit RunningServer(modbus_tcp::ListenerSettings settings = {}, AxisNumber axes = 3) {
    test::fill_image(image_, axes, runtime_.now());
    settings.port = settings.port == 1502 ? 0 : settings.port;
    server_ =
        std::make_unique<modbus_tcp::Server>(io_, runtime_, std::span(&settings, 1), image_, port_, clients_, log_);
    server_->start(modbus_tcp::take_descriptors({.clients = settings.max_clients}));
    listening_on_ = server_->ports()[0];
    thread_ = std::thread([this] { io_.run(); });
  }
  ~RunningServer() {
    boost::asio::post(io_, [this] { server_->stop(); });
    thread_.join();
  }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;
  [[nodiscard]] std::uint16_t port() const { return listening_on_; }
  [[nodiscard]] std::string endpoint() const { return "127.0.0.1:" + std::to_string(listening_on_); }

 private:
  boost::asio::io_context io_{1};
  AsioRuntime runtime_{io_};
  ProcessImage image_;
  test::RememberingPort port_;
  modbus_tcp::ClientRegistry clients_;
  Log log_;
  std::unique_ptr<modbus_tcp::Server> server_;
  std::uint16_t listening_on_ = 0;
  std::thread thread_;
};

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
  for (const char* endpoint : {"", "localhost", ":1502", "localhost:", "localhost:x", "localhost:70000", "::1:1502"}) {
    const Shown shown = shown_by(once(endpoint));
    EXPECT_EQ(shown.status, 2) << endpoint;
    EXPECT_THAT(shown.err, HasSubstr("is no HOST:PORT")) << endpoint;
  }
}

}  // namespace
}  // namespace axisgate::commands
