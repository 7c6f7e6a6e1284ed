// SPDX-License-Identifier: Apache-2.0
// Bounds by counts, whatever the machine: what a crowd of slow and deaf clients takes, and that all others are answered
// once for each request.
#include <gmock/gmock.h>
#include <malloc.h>

#include "gateway/upstream/modbus_tcp/session/session.hpp"
#include "tests/unit/modbus_server/served.hpp"

namespace axisgate::test {
namespace {

constexpr std::size_t kSlow = 200, kGood = 20, kRounds = 4;
constexpr std::uint16_t kMostRegisters = 125;
/// What one connection takes of the process: its requests and replies that wait, each at most an ADU, and what stands
/// around them. Twice that: the test's own ends are in the same process.
constexpr std::size_t kAroundASession = 8'192;
constexpr std::size_t kMostPerSession = 2 * (2 * modbus_tcp::kMaxPipelined * modbus_tcp::kMaxAdu + kAroundASession);
/// The lines of a connection, which the test keeps.
constexpr std::size_t kLogOfOne = 1'024;

std::size_t allocated() { return mallinfo2().uordblks; }

/// Many requests at once, none of them cut in two but the last.
void ask_until_nothing_fits(Served& served, TestClient& deaf) {
  constexpr std::size_t kAtOnce = 100;
  std::vector<Byte> many;
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    const std::vector<Byte> one = read_request(1, 100, kMostRegisters);
    many.insert(many.end(), one.begin(), one.end());
  }
  std::vector<Byte> rest = many;
  for (std::size_t sent = 1; sent != 0;) {
    sent = deaf.send_what_fits(rest);
    served.settle();
    rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(sent));
    if (rest.empty()) rest = many;
  }
}

TEST(ModbusServerCrowd, OfSlowAndDeafClientsTakesABoundedPlaceAndEveryOtherIsAnsweredOnce) {
  Served served;
  served.listeners[0].max_clients = kSlow + kGood + 1;
  served.listeners[0].max_clients_per_address = 0;
  served.start();
  std::vector<std::unique_ptr<TestClient>> good, slow;
  for (std::size_t i = 0; i < kGood; ++i) good.push_back(std::make_unique<TestClient>(served));
  ASSERT_TRUE(served.await([&] { return served.server->counters().open == kGood; }));

  const std::size_t before = allocated();
  for (std::size_t i = 0; i < kSlow; ++i) slow.push_back(std::make_unique<TestClient>(served));
  const auto deaf = TestClient::with_small_buffer(served);
  ASSERT_TRUE(served.await([&] { return served.server->counters().open == kSlow + kGood + 1; }));
  ask_until_nothing_fits(served, *deaf);

  const std::vector<Byte> request = read_request(7, kPositionOfAxis1, 2);
  std::uint16_t transaction = 0;
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (const auto& client : slow) client->send({request[round]});  // never whole
    ++transaction;
    for (const auto& client : good) client->send(read_request(transaction, kPositionOfAxis1, 2));
    for (const auto& client : good) {
      const std::vector<Byte> reply = client->receive(read_reply_size(2));
      ASSERT_EQ(reply.size(), read_reply_size(2));
      EXPECT_EQ(load_be16(reply, 0), transaction);
    }
  }
  served.settle();
  for (const auto& client : good) EXPECT_EQ(client->received_so_far(), 0U) << "an answer that nobody asked for";
  for (const auto& client : slow) EXPECT_EQ(client->received_so_far(), 0U);
  EXPECT_EQ(served.server->counters().open, kSlow + kGood + 1);
  EXPECT_LE(allocated(), before + (kSlow + 1) * kMostPerSession);

  const TestClient one_more(served);  // NOLINT: it is closed at once
  ASSERT_TRUE(served.await([&] { return served.server->counters().refused_full == 1; }));
  EXPECT_EQ(served.server->counters().open, kSlow + kGood + 1);

  served.pass(served.listeners[0].request_deadline + std::chrono::milliseconds(1));
  ASSERT_TRUE(served.await([&] { return served.server->counters().closed_late == kSlow + 1; }));
  EXPECT_EQ(served.server->counters().open, kGood);
  EXPECT_LE(allocated(), before + (kSlow + 1) * kLogOfOne) << "what they took is given back";
}

}  // namespace
}  // namespace axisgate::test
