#include "gateway/upstream/modbus_tcp/client_registry.hpp"

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

TEST(Clients, AreOneForEachConnectionByDefault) {
  ClientRegistry registry;
  const auto a = registry.connect(host(1), false, kStart).client;
  const auto b = registry.connect(host(1), false, kStart).client;
  EXPECT_NE(a, b);
  EXPECT_NE(a->id, b->id);
  EXPECT_EQ(a->host, b->host) << "command ids belong to the address";
}

TEST(Clients, AreOneForAllConnectionsOfAHostWithClientAddress) {
  ClientRegistry registry;
  const auto a = registry.connect(host(1), true, kStart).client;
  const auto b = registry.connect(host(1), true, kStart).client;
  const auto other = registry.connect(host(2), true, kStart).client;
  EXPECT_EQ(a, b);
  EXPECT_NE(a, other);
}

TEST(Clients, OfAConnectionAreGoneWithIt) {
  ClientRegistry registry;
  const auto client = registry.connect(host(1), false, kStart).client;
  EXPECT_EQ(registry.disconnect(client, kStart), client->id);
}

TEST(Clients, OfAHostOutliveTheirConnectionsAndForgetAfter60s) {
  ClientRegistry registry;
  const auto first = registry.connect(host(1), true, kStart).client;
  EXPECT_EQ(registry.disconnect(first, kStart), std::nullopt);
  EXPECT_EQ(registry.connect(host(1), true, kStart + 59999ms).client, first);
  EXPECT_EQ(registry.disconnect(first, kStart + 60s), std::nullopt);
  const auto later = registry.connect(host(1), true, kStart + 120s);
  EXPECT_NE(later.client, first) << "what it wrote is forgotten";
  EXPECT_EQ(later.client->id, first->id) << "but it is nobody else";
  EXPECT_EQ(later.forgotten, std::nullopt) << "a reader's return ends nothing that it commanded before";
}

TEST(Lives, OfAHostAreKeptWhateverIsForgotten) {
  ClientRegistry registry;
  const auto first = registry.connect(host(1), true, kStart).client;
  const auto life = first->life;
  registry.disconnect(first, kStart);
  EXPECT_FALSE(life->connected);
  const auto later = registry.connect(host(1), true, kStart + 120s).client;
  ASSERT_NE(later, first) << "what it wrote is forgotten";
  EXPECT_EQ(later->life, life) << "but what it owns is its own";
  EXPECT_TRUE(life->connected);
}

TEST(Lives, TellOfTheNewestConnection) {
  ClientRegistry registry;
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

TEST(Lives, NameConnectionsByAddressAndPortAndHostsByAddress) {
  ClientRegistry registry;
  Peer peer{.address = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 168, 1, 7}, .port = 51234};
  EXPECT_EQ(registry.connect(peer, false, kStart).client->life->name, "192.168.1.7:51234");
  EXPECT_EQ(registry.connect(peer, true, kStart).client->life->name, "192.168.1.7");
  peer.address = {0xFE, 0x80, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  EXPECT_EQ(registry.connect(peer, false, kStart).client->life->name, "[fe80::1]:51234");
}

TEST(Lives, OfAHostAreDisconnectedThoughOthersFromItsAddressStay) {
  ClientRegistry registry;
  const auto host_client = registry.connect(host(1), true, kStart).client;
  const auto other = registry.connect(host(1), false, kStart).client;
  registry.disconnect(host_client, kStart);
  EXPECT_FALSE(host_client->life->connected);
  EXPECT_TRUE(other->life->connected);
}

TEST(CommandIds, AreKeptPerAddressFor60sAfterItsLastConnectionClosed) {
  ClientRegistry registry;
  const auto first = registry.connect(host(1), false, kStart).client;
  const auto second = registry.connect(host(1), false, kStart).client;
  first->host->ids[3].last = 17;
  registry.disconnect(first, kStart);
  EXPECT_EQ(second->last_id(3), 17) << "one connection is left";
  registry.disconnect(second, kStart + 100s);
  const auto third = registry.connect(host(1), false, kStart + 159s).client;
  EXPECT_EQ(third->last_id(3), 17);
  EXPECT_EQ(third->last_id(4), std::nullopt) << "per axis";
  registry.disconnect(third, kStart + 160s);
  EXPECT_EQ(registry.connect(host(1), false, kStart + 220s).client->last_id(3), std::nullopt);
}

TEST(CommandIds, OfAnotherAddressAreNotSeen) {
  ClientRegistry registry;
  const auto plc = registry.connect(host(1), false, kStart).client;
  plc->host->ids[3].last = 17;
  EXPECT_EQ(registry.connect(host(2), false, kStart).client->last_id(3), std::nullopt);
}

TEST(Clients, NeverHaveANumberTwice) {
  ClientRegistry registry;
  ClientId last = 0;
  for (int i = 0; i < 100; ++i) {
    const auto client = registry.connect(host(i % 3), i % 2 == 0, kStart + i * 100s).client;
    if (i % 2 == 1) {
      EXPECT_GT(client->id, last);
    }
    last = client->id;
    registry.disconnect(client, kStart + i * 100s);
  }
}

TEST(Hosts, AreForgottenInTheOrderInWhichTheyLeftAndNeverWhileConnected) {
  ClientRegistry registry;
  const auto stays = registry.connect(host(0), true, kStart).client;
  const auto leaves = registry.connect(host(1), true, kStart).client;
  registry.disconnect(leaves, kStart + 1ms);
  std::optional<ClientId> forgotten;
  for (int n = 2; !forgotten && n < 3000; ++n) {
    auto connected = registry.connect(host(n), false, kStart + 2ms);
    forgotten = connected.forgotten;
    registry.disconnect(connected.client, kStart + n * 2us + 2ms);
  }
  EXPECT_EQ(forgotten, leaves->id) << "the first that left";
  for (int n = 3000; n < 6000; ++n) {
    registry.disconnect(registry.connect(host(n), false, kStart + 1s).client, kStart + 1s);
  }
  EXPECT_LE(registry.hosts(), kMaxIdleHosts + 2);
  EXPECT_EQ(registry.connect(host(0), true, kStart + 1s).client, stays);
}

}  // namespace
}  // namespace axisgate::modbus_tcp
