#include "gateway/upstream/modbus_tcp/client_registry.hpp"

#include <gtest/gtest.h>

namespace axisgate::modbus_tcp {
namespace {

using namespace std::chrono_literals;

constexpr Instant kStart = Instant{} + 1h;

Address host(int n) {
  Address address{};
  address[14] = static_cast<std::uint8_t>(n >> 8);
  address[15] = static_cast<std::uint8_t>(n & 0xFF);
  return address;
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
