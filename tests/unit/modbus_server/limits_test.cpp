// SPDX-License-Identifier: Apache-2.0
// What happens to clients that are too many, not allowed, too slow, gone or not speaking Modbus.
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "tests/unit/modbus_server/served.hpp"

namespace axisgate::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Reads through `client`, whatever the others do.
void expect_served(TestClient& client) {
  client.send(read_request(1, kPositionOfAxis1, 2));
  EXPECT_EQ(client.receive(13).size(), 13U);
}

std::vector<std::string> lines_with(const Served& served, const std::string& words) {
  std::vector<std::string> found;
  for (const std::string& line : served.lines) {
    if (line.find(words) != std::string::npos) found.push_back(line);
  }
  return found;
}

TEST(ModbusServerLimits, ASlowRequestIsCutAtItsDeadlineWhileOthersAreServed) {
  Served served;
  served.listeners[0].request_deadline = std::chrono::seconds(5);
  served.start();
  TestClient slow(served);
  TestClient good(served);
  const std::vector<Byte> request = read_request(1, kPositionOfAxis1, 2);
  for (std::size_t i = 0; i < 5; ++i) {
    slow.send({request[i]});
    served.pass(std::chrono::milliseconds(980));
    expect_served(good);
  }
  EXPECT_EQ(served.server->counters().open, 2U) << "4.9 s after its first byte it still has time";
  served.pass(std::chrono::milliseconds(100));
  EXPECT_TRUE(slow.closed_by_server());
  expect_served(good);
  EXPECT_EQ(served.server->counters().closed_late, 1U);
}

TEST(ModbusServerLimits, AClientThatDoesNotTakeItsRepliesIsCutAtItsDeadlineWhileOthersAreServed) {
  Served served;
  served.start();
  const auto deaf = TestClient::with_small_buffer(served);
  TestClient good(served);
  // Until the server can send no more and takes no more: the queue in between is bounded.
  std::size_t taken = 0;
  for (;;) {
    const std::size_t now = deaf->send_what_fits(read_request(1, 100, 125));
    served.settle();
    taken += now;
    if (now == 0) break;
    ASSERT_LT(taken, 64U << 20) << "a client that never reads must not be read for ever";
  }
  expect_served(good);
  served.pass(served.listeners[0].request_deadline + std::chrono::milliseconds(1));
  ASSERT_TRUE(served.await([&] { return served.server->counters().closed_late == 1; }));
  expect_served(good);
  EXPECT_EQ(served.server->counters().open, 1U);
}

TEST(ModbusServerLimits, AClientThatTakesItsRepliesLateButInTimeGetsThemAll) {
  Served served;
  served.start();
  const auto late = TestClient::with_small_buffer(served);
  const std::vector<Byte> request = read_request(1, 100, 125);
  std::vector<Byte> requests;
  for (int i = 0; i < 20'000; ++i) requests.insert(requests.end(), request.begin(), request.end());
  // More than the system keeps between the two: the server has to stop in the middle of a reply and go on later.
  const std::size_t asked = late->send_what_fits(requests) / request.size();
  served.settle();
  served.pass(std::chrono::seconds(4));
  const std::size_t all = asked * read_reply_size(125);
  EXPECT_LT(late->received_so_far(), all);
  EXPECT_EQ(late->receive(all).size(), all);
}

TEST(ModbusServerLimits, AnIdleClientIsClosedAndABusyOneIsNot) {
  Served served;
  served.start();
  TestClient idle(served);
  TestClient busy(served);
  expect_served(idle);
  for (int i = 0; i < 7; ++i) {
    expect_served(busy);
    served.pass(std::chrono::seconds(10));
  }
  EXPECT_TRUE(idle.closed_by_server());
  expect_served(busy);
  served.pass(std::chrono::seconds(61));
  EXPECT_TRUE(busy.closed_by_server()) << "once it is idle as well";
}

TEST(ModbusServerLimits, AClientThatVanishesLeavesRoom) {
  Served served;
  served.listeners[0].max_clients = 1;
  served.start();
  for (const bool reset : {false, true}) {
    TestClient client(served);
    expect_served(client);
    client.leave(reset);
    ASSERT_TRUE(served.await([&] { return served.server->counters().open == 0; }));
  }
  EXPECT_EQ(served.server->counters().closed_by_peer, 2U);
  EXPECT_EQ(served.server->counters().refused_full, 0U);
}

/// The descriptor of the one connection whose near end is at that port.
int connection_at(std::uint16_t port) {
  for (int descriptor = 0; descriptor < 4096; ++descriptor) {
    sockaddr_storage near{}, far{};
    socklen_t near_size = sizeof near, far_size = sizeof far;
    if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&near), &near_size) != 0 ||
        ::getpeername(descriptor, reinterpret_cast<sockaddr*>(&far), &far_size) != 0)
      continue;
    const auto at = near.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(near).sin6_port
                                               : reinterpret_cast<const sockaddr_in&>(near).sin_port;
    if (ntohs(at) == port) return descriptor;
  }
  return -1;
}

// No packet says that a host has lost its power: the system asks, and gives the connection up.
TEST(ModbusServerLimits, AHostThatVanishesIsAskedForByTheSystemAndGivenUp) {
  Served served;
  served.start();
  TestClient client(served);
  expect_served(client);
  const int accepted = connection_at(served.server->ports().front());
  ASSERT_GE(accepted, 0);
  const auto option = [&](int level, int name) {
    int value = 0;
    socklen_t size = sizeof value;
    EXPECT_EQ(::getsockopt(accepted, level, name, &value, &size), 0);
    return value;
  };
  EXPECT_NE(option(SOL_SOCKET, SO_KEEPALIVE), 0);
  const int seconds =
      option(IPPROTO_TCP, TCP_KEEPIDLE) + option(IPPROTO_TCP, TCP_KEEPINTVL) * option(IPPROTO_TCP, TCP_KEEPCNT);
  EXPECT_LE(seconds, 30) << "an idle one";
  EXPECT_GT(option(IPPROTO_TCP, TCP_USER_TIMEOUT), 0);
  EXPECT_LE(option(IPPROTO_TCP, TCP_USER_TIMEOUT), 30'000) << "one that owes an acknowledgement";
}

TEST(ModbusServerLimits, OverMaxClientsNewOnesAreClosedAtOnceAndTheOthersStay) {
  Served served;
  served.listeners[0].max_clients = 2;
  served.start();
  TestClient first(served);
  TestClient second(served);
  expect_served(first);
  expect_served(second);
  TestClient third(served);
  EXPECT_TRUE(third.closed_by_server());
  expect_served(first);
  expect_served(second);
  EXPECT_EQ(served.server->counters().refused_full, 1U);
  EXPECT_THAT(lines_with(served, "refused"), ElementsAre(HasSubstr("refused 127.0.0.1: max_clients (2) is reached")));
}

TEST(ModbusServerLimits, RefusalsAreLoggedOnceAMinute) {
  Served served;
  served.listeners[0].max_clients_per_address = 1;
  served.start();
  TestClient first(served);
  for (int i = 0; i < 10; ++i) {
    expect_served(first);
    EXPECT_TRUE(TestClient(served).closed_by_server());
    served.pass(std::chrono::seconds(1));
  }
  EXPECT_EQ(lines_with(served, "refused").size(), 1U);
  served.pass(std::chrono::seconds(50));
  EXPECT_TRUE(TestClient(served).closed_by_server());
  ASSERT_EQ(lines_with(served, "refused").size(), 2U);
  EXPECT_THAT(lines_with(served, "refused")[1], HasSubstr("(and 9 more since the last such line)"));
  EXPECT_EQ(served.server->counters().refused_full, 11U);
}

TEST(ModbusServerLimits, AnAddressThatAllowDoesNotNameIsClosedAtAccept) {
  Served served;
  served.listeners[0].has_allow = true;
  served.listeners[0].allow = {{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 168, 1, 0}, 120, Role::operator_, 0}};
  served.start();
  TestClient stranger(served);
  EXPECT_TRUE(stranger.closed_by_server());
  EXPECT_EQ(served.server->counters().refused_not_allowed, 1U);
  EXPECT_EQ(served.server->counters().accepted, 0U);
  EXPECT_EQ(lines_with(served, "`allow` does not name").size(), 1U);
}

class NoFrame : public ::testing::TestWithParam<std::vector<Byte>> {};

TEST_P(NoFrame, ClosesTheConnectionAndNoOther) {
  Served served;
  served.start();
  TestClient bad(served);
  TestClient good(served);
  bad.send(GetParam());
  EXPECT_TRUE(bad.closed_by_server());
  expect_served(good);
  EXPECT_EQ(served.server->counters().closed_malformed, 1U);
  EXPECT_EQ(served.server->counters().open, 1U);
}

INSTANTIATE_TEST_SUITE_P(Mbap, NoFrame,
                         ::testing::Values(std::vector<Byte>{0, 1, 0, 1, 0, 6, 0xFF, 3, 0, 100, 0, 2},  // protocol 1
                                           std::vector<Byte>{0, 1, 0, 0, 0, 0, 0xFF, 3, 0, 100, 0, 2},  // length 0
                                           std::vector<Byte>{0, 1, 0, 0, 0, 1, 0xFF, 3, 0, 100, 0, 2},  // no function
                                           std::vector<Byte>{0, 1, 0, 0, 0x01, 0, 0xFF, 3, 0, 100, 0, 2},  // over 254
                                           std::vector<Byte>{'G', 'E', 'T', ' ', '/', ' ', 'H', 'T', 'T', 'P', '/',
                                                             '1'}));

}  // namespace
}  // namespace axisgate::test
