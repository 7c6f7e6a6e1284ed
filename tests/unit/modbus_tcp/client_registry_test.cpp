// SPDX-License-Identifier: Apache-2.0
// Who is one client, what outlives its connections, and for how long.
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"

#include <gtest/gtest.h>

namespace axisgate::modbus_tcp {
namespace {

using namespace std::chrono_literals;

constexpr Instant kStart = Instant{} + 1h;

Peer host(int n) {
  Peer peer{.address = {}, .port = 51234, .role = Role::operator_, .rank = 3};
  peer.address[14] = static_cast<std::uint8_t>(n >> 8);
  peer.address[15] = static_cast<std::uint8_t>(n & 0xFF);
  return peer;
}

class Clients : public ::testing::Test {
 protected:
  auto connect(int n, bool by_address = false, Duration at = {}) {
    return registry.connect(host(n), by_address, kStart + at).client;
  }
  template <typename Client>
  auto disconnect(const Client& client, Duration at = {}) {
    return registry.disconnect(client, kStart + at);
  }
  ClientRegistry registry;
};

TEST_F(Clients, are_one_for_each_connection_by_default_and_gone_with_it) {
  const auto a = connect(1);
  const auto b = connect(1);
  EXPECT_NE(a, b);
  EXPECT_NE(a->id, b->id);
  EXPECT_EQ(a->host, b->host) << "command ids belong to the address";
  EXPECT_EQ(disconnect(a), a->id);
}

TEST_F(Clients, by_address_are_one_for_all_connections_of_a_host) {
  const auto a = connect(1, true);
  EXPECT_EQ(a, connect(1, true));
  EXPECT_NE(a, connect(2, true));
}

TEST_F(Clients, of_a_host_outlive_their_connections_and_forget_after_60_s_but_what_they_own) {
  const auto first = connect(1, true);
  const auto life = first->life;
  EXPECT_EQ(disconnect(first), std::nullopt);
  EXPECT_FALSE(life->connected);
  EXPECT_EQ(connect(1, true, 59999ms), first);
  EXPECT_TRUE(life->connected);
  EXPECT_EQ(disconnect(first, 60s), std::nullopt);
  const auto later = registry.connect(host(1), true, kStart + 120s);
  EXPECT_NE(later.client, first) << "what it wrote is forgotten";
  EXPECT_EQ(later.client->id, first->id) << "but it is nobody else";
  EXPECT_EQ(later.client->life, life) << "and what it owns is its own";
  EXPECT_TRUE(life->connected);
  EXPECT_EQ(later.forgotten, std::nullopt) << "a reader's return ends nothing that it commanded before";
}

TEST_F(Clients, lives_tell_of_the_connection_that_may_most) {
  Peer peer = host(1);
  const auto client = registry.connect(peer, true, kStart).client;
  EXPECT_EQ(client->life->role, Role::operator_);
  EXPECT_EQ(client->life->rank, 3);
  peer.role = Role::engineer;
  peer.rank = 5;
  static_cast<void>(registry.connect(peer, true, kStart));
  EXPECT_EQ(client->life->role, Role::engineer) << "by a listener that knows it otherwise";
  EXPECT_EQ(client->life->rank, 5);
}

TEST_F(Clients, lives_are_not_lowered_by_what_else_their_address_connects) {
  Peer pump = host(1);
  Peer weaker = pump, viewer = pump;
  weaker.rank = 1;
  viewer.role = Role::viewer;
  viewer.rank = 9;
  const auto client = registry.connect(pump, true, kStart).client;
  const auto is_as_before = [&] { return client->life->role == Role::operator_ && client->life->rank == 3; };
  for (const Peer& peer : {weaker, viewer}) {
    static_cast<void>(registry.connect(peer, true, kStart));
    EXPECT_TRUE(is_as_before()) << int{peer.rank};
  }
  for (int each = 0; each < 3; ++each) static_cast<void>(disconnect(client));
  static_cast<void>(registry.connect(viewer, true, kStart));
  EXPECT_TRUE(is_as_before()) << "it may own an axis still";
  static_cast<void>(disconnect(client));
  static_cast<void>(registry.connect(weaker, true, kStart));
  EXPECT_EQ(client->life->rank, 1) << "the only one that commands now";
}

TEST_F(Clients, lives_name_connections_by_address_and_port_and_hosts_by_address) {
  Peer peer{.address = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 168, 1, 7}, .port = 51234};
  EXPECT_EQ(registry.connect(peer, false, kStart).client->life->name, "192.168.1.7:51234");
  EXPECT_EQ(registry.connect(peer, true, kStart).client->life->name, "192.168.1.7");
  peer.address = {0xFE, 0x80, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  EXPECT_EQ(registry.connect(peer, false, kStart).client->life->name, "[fe80::1]:51234");
}

TEST_F(Clients, the_life_of_a_host_ends_though_others_from_its_address_stay) {
  const auto host_client = connect(1, true);
  const auto other = connect(1);
  disconnect(host_client);
  EXPECT_FALSE(host_client->life->connected);
  EXPECT_TRUE(other->life->connected);
}

TEST_F(Clients, command_ids_are_kept_per_address_for_60_s_after_its_last_connection_closed) {
  const auto first = connect(1);
  const auto second = connect(1);
  first->host->ids[3].last = 17;
  EXPECT_EQ(connect(2)->last_id(3), std::nullopt) << "another address";
  disconnect(first);
  EXPECT_EQ(second->last_id(3), 17) << "one connection is left";
  disconnect(second, 100s);
  const auto third = connect(1, false, 159s);
  EXPECT_EQ(third->last_id(3), 17);
  EXPECT_EQ(third->last_id(4), std::nullopt) << "per axis";
  disconnect(third, 160s);
  EXPECT_EQ(connect(1, false, 220s)->last_id(3), std::nullopt);
}

TEST_F(Clients, never_have_a_number_twice) {
  ClientId last = 0;
  for (int i = 0; i < 100; ++i) {
    const auto client = connect(i % 3, i % 2 == 0, i * 100s);
    if (i % 2 == 1) {
      EXPECT_GT(client->id, last);
    }
    last = client->id;
    disconnect(client, i * 100s);
  }
}

TEST_F(Clients, hosts_are_forgotten_in_the_order_in_which_they_left_and_never_while_connected) {
  const auto stays = connect(0, true);
  const auto leaves = connect(1, true);
  disconnect(leaves, 1ms);
  std::optional<ClientId> forgotten;
  for (int n = 2; !forgotten && n < 3000; ++n) {
    auto connected = registry.connect(host(n), false, kStart + 2ms);
    forgotten = connected.forgotten;
    disconnect(connected.client, n * 2us + 2ms);
  }
  EXPECT_EQ(forgotten, leaves->id) << "the first that left";
  for (int n = 3000; n < 6000; ++n) disconnect(connect(n, false, 1s), 1s);
  EXPECT_LE(registry.hosts(), kMaxIdleHosts + 2);
  EXPECT_EQ(connect(0, true, 1s), stays);
}

}  // namespace
}  // namespace axisgate::modbus_tcp
