// SPDX-License-Identifier: Apache-2.0
// The numbers that accepted sockets get, and what happens when there is none.
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "gateway/upstream/modbus_tcp/server/listener.hpp"
#include "tests/unit/modbus_server/few_descriptors.hpp"
#include "tests/unit/modbus_server/served.hpp"

namespace axisgate::test {
namespace {

using modbus_tcp::DescriptorPlan;
using modbus_tcp::kSelectLimit;
using ::testing::Each;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;
using ::testing::SizeIs;

rlim_t hard_limit() { return modbus_tcp::descriptor_limits().hard; }

/// More than one turn accepts, as far as this system has numbers for them above 1023.
std::uint32_t crowd() {
  constexpr rlim_t kCrowd = 300;
  return static_cast<std::uint32_t>(std::min(kCrowd, std::max<rlim_t>(hard_limit(), kSelectLimit) - kSelectLimit));
}

/// Both ends of all connections are in this process.
class Descriptors : public ::testing::Test {
 protected:
  FewDescriptors enough_{std::min<rlim_t>(hard_limit(), kSelectLimit + crowd())};
};

/// The server's ends of its connections: sockets on its port that have a peer.
std::vector<int> accepted_sockets(const Served& served) {
  std::vector<int> numbers;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int descriptor = std::stoi(entry.path().filename());
    sockaddr_in own{};
    sockaddr_in peer{};
    socklen_t own_size = sizeof own;
    socklen_t peer_size = sizeof peer;
    if (getsockname(descriptor, reinterpret_cast<sockaddr*>(&own), &own_size) != 0) continue;
    if (getpeername(descriptor, reinterpret_cast<sockaddr*>(&peer), &peer_size) != 0) continue;
    if (own.sin_family == AF_INET && ntohs(own.sin_port) == served.server->ports()[0]) numbers.push_back(descriptor);
  }
  return numbers;
}

using Clients = std::vector<std::unique_ptr<TestClient>>;

void connect(Served& served, Clients& clients, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    clients.push_back(std::make_unique<TestClient>(served));
    served.settle();
  }
}

bool is_served(TestClient& client) {
  client.send(read_request(1, 102, 2));
  return client.receive(13).size() == 13;
}

TEST_F(Descriptors, TheSoftLimitIsRaisedToWhatClientsNeedAndNotFurther) {
  const FewDescriptors low(256);
  const DescriptorPlan plan = modbus_tcp::take_descriptors({.clients = 10});
  EXPECT_EQ(modbus_tcp::descriptor_limits().soft, plan.soft_limit);
  EXPECT_EQ(plan.soft_limit, std::min<rlim_t>(hard_limit(), plan.needs.limit()));
  EXPECT_EQ(plan.max_clients, 10U);
}

TEST_F(Descriptors, AMovedOneIsThere1024AndAboveAndItsOldNumberIsFree) {
  ASSERT_EQ(modbus_tcp::take_descriptors({.clients = 1}).move_up, hard_limit() > kSelectLimit);
  if (hard_limit() <= kSelectLimit) return;  // this system forbids it
  const int low = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(low, 0);
  const int high = modbus_tcp::moved_up(low);
  EXPECT_GE(high, static_cast<int>(kSelectLimit));
  EXPECT_EQ(::fcntl(low, F_GETFD), -1);
  EXPECT_EQ(::fcntl(high, F_GETFD), FD_CLOEXEC);
  ::close(high);
}

TEST_F(Descriptors, ClientsTakeNoneBelow1024HoweverManyTheyAre) {
  const std::uint32_t all = crowd();
  const DescriptorPlan plan = modbus_tcp::take_descriptors({.clients = all});
  ASSERT_EQ(plan.move_up, hard_limit() > kSelectLimit);
  if (!plan.move_up) return;  // this system forbids it
  Served served;
  served.listeners[0].max_clients_per_address = 0;
  served.start(plan);
  Clients clients;
  connect(served, clients, all);
  EXPECT_THAT(accepted_sockets(served), SizeIs(all));
  EXPECT_THAT(accepted_sockets(served), Each(Ge(static_cast<int>(kSelectLimit))));
  for (auto& client : clients) ASSERT_TRUE(is_served(*client));

  clients.erase(clients.begin(), clients.begin() + all / 2);
  ASSERT_TRUE(served.await([&] { return served.server->counters().open == all - all / 2; }));
  connect(served, clients, all / 2);
  EXPECT_THAT(accepted_sockets(served), SizeIs(all)) << "what left has given its number back";
  EXPECT_THAT(accepted_sockets(served), Each(Ge(static_cast<int>(kSelectLimit))));
}

TEST_F(Descriptors, WhereTheLimitForbidsNumbersAbove1023OnlyAsManyClientsAsLeaveRoomForPortsAreServed) {
  Served served;
  served.listeners[0].max_clients_per_address = 0;
  served.start(modbus_tcp::plan_descriptors({256, 256}, {.clients = 1000, .listeners = 1, .buses = 1}));
  constexpr std::uint32_t room = 256 - 64 - 4 - 1;
  Clients clients;
  connect(served, clients, room);
  EXPECT_THAT(accepted_sockets(served), SizeIs(room));
  EXPECT_THAT(accepted_sockets(served), Each(Lt(static_cast<int>(kSelectLimit))));
  const std::size_t lines = served.lines.size();
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(TestClient(served).closed_by_server());
  EXPECT_EQ(served.lines.size(), lines + 1) << "said once a minute";
  EXPECT_THAT(served.lines.back(), HasSubstr("refused 127.0.0.1: the system's descriptor limit is reached"));
  EXPECT_EQ(served.server->counters().refused_full, 5U);
  for (auto& client : clients) ASSERT_TRUE(is_served(*client));

  clients.pop_back();
  ASSERT_TRUE(served.await([&] { return served.server->counters().open == room - 1; }));
  TestClient next(served);
  EXPECT_TRUE(is_served(next));
}

TEST_F(Descriptors, AllListenersShareTheRoomThereIs) {
  Served served;
  served.listeners.push_back(served.listeners[0]);
  served.start(modbus_tcp::plan_descriptors({71, 71}, {.clients = 2000, .listeners = 2, .buses = 1}));
  TestClient only(served, 0);
  EXPECT_TRUE(is_served(only));
  EXPECT_TRUE(TestClient(served, 0).closed_by_server());
  EXPECT_TRUE(TestClient(served, 1).closed_by_server());
  only.leave();
  ASSERT_TRUE(served.await([&] { return served.server->counters().open == 0; }));
  TestClient other(served, 1);
  EXPECT_TRUE(is_served(other));
}

TEST_F(Descriptors, AClientThatCannotBeMovedIsClosedAndCountsNoLonger) {
  const DescriptorPlan plan = modbus_tcp::take_descriptors({.clients = 1});
  ASSERT_EQ(plan.move_up, hard_limit() > kSelectLimit);
  if (!plan.move_up) return;  // this system forbids it
  Served served;
  served.listeners[0].max_clients = 1;
  served.start(plan);
  {
    const FewDescriptors none_above(kSelectLimit);  // somebody lowers it while the gateway runs
    TestClient unlucky(served);
    EXPECT_TRUE(unlucky.closed_by_server());
    EXPECT_THAT(accepted_sockets(served), IsEmpty());
    EXPECT_EQ(served.server->counters().open, 0U);
  }
  TestClient next(served);
  EXPECT_TRUE(is_served(next));
}

TEST_F(Descriptors, WithoutAnyAcceptingPausesInsteadOfSpinningAndThenGoesOn) {
  Served served;
  served.start();
  TestClient first(served);
  ASSERT_TRUE(is_served(first));
  TestClient second(served);
  {
    const FewDescriptors none_free(3);
    ASSERT_TRUE(served.await([&] { return served.server->counters().accept_pauses == 1; }));
    for (int i = 0; i < 100; ++i) served.settle();
    EXPECT_EQ(served.server->counters().accept_pauses, 1U) << "it tries again only after its pause";
    EXPECT_TRUE(is_served(first));
    served.pass(modbus_tcp::kAcceptPause);
    EXPECT_EQ(served.server->counters().accept_pauses, 2U);
  }
  served.pass(modbus_tcp::kAcceptPause);
  EXPECT_TRUE(is_served(second));
  TestClient third(served);
  EXPECT_TRUE(is_served(third)) << "and so it stays";
  EXPECT_THAT(served.lines.back(), HasSubstr("cannot accept: Too many open files; new clients wait"));
  EXPECT_EQ(std::count_if(served.lines.begin(), served.lines.end(),
                          [](const std::string& line) { return line.find("cannot accept") != std::string::npos; }),
            1);
}

}  // namespace
}  // namespace axisgate::test
