// SPDX-License-Identifier: Apache-2.0
// What clients get from the server when all goes well, and that no client costs another its turn.
#include "gateway/upstream/modbus_tcp/session/session.hpp"
#include "tests/unit/modbus_server/served.hpp"

namespace axisgate::test {
namespace {

constexpr std::uint16_t kTargetTorqueOfAxis1 = 146;

std::vector<Byte> position_reply(std::uint16_t transaction) {
  // 100000 in 1/10000 of a turn, high word first.
  std::vector<Byte> adu{0, 0, 0, 0, 0, 7, 0xFF, 0x03, 4, 0x00, 0x01, 0x86, 0xA0};
  store_be16(adu, 0, transaction);
  return adu;
}

TEST(ModbusServer, AnswersARead) {
  Served served;
  served.start();
  TestClient client(served);
  client.send(read_request(7, kPositionOfAxis1, 2));
  EXPECT_EQ(client.receive(13), position_reply(7));
  EXPECT_EQ(served.server->counters().accepted, 1U);
  EXPECT_EQ(served.server->counters().open, 1U);
}

TEST(ModbusServer, ServesIpv6AndIpv4OnOneListenerOfAllAddresses) {
  Served served;
  served.listeners[0].host = "::";
  served.start();
  TestClient six(served, 0, TestClient::Family::v6);
  TestClient four(served, 0, TestClient::Family::v4);
  six.send(read_request(1, kPositionOfAxis1, 2));
  four.send(read_request(2, kPositionOfAxis1, 2));
  EXPECT_EQ(six.receive(13), position_reply(1));
  EXPECT_EQ(four.receive(13), position_reply(2));
  // An IPv4 client of an IPv6 socket keeps its rights: loopback is engineer.
  four.send(read_request(3, 7, 1));
  EXPECT_EQ(four.receive(11).back(), 3);
}

TEST(ModbusServer, ServesEachListenerByItsOwnSettings) {
  Served served;
  served.listeners.push_back(served.listeners[0]);
  served.listeners[1].low_word_first = true;
  served.start();
  ASSERT_EQ(served.server->ports().size(), 2U);
  TestClient high(served, 0);
  TestClient low(served, 1);
  high.send(read_request(1, 10, 2));
  low.send(read_request(1, 10, 2));
  EXPECT_EQ(high.receive(13), (std::vector<Byte>{0, 1, 0, 0, 0, 7, 0xFF, 3, 4, 1, 2, 3, 4}));
  EXPECT_EQ(low.receive(13), (std::vector<Byte>{0, 1, 0, 0, 0, 7, 0xFF, 3, 4, 3, 4, 1, 2}));
}

TEST(ModbusServer, AnswersPipelinedRequestsInOrderHoweverManyComeAtOnce) {
  Served served;
  served.start();
  TestClient client(served);
  std::vector<Byte> requests;
  std::vector<Byte> expected;
  for (std::uint16_t i = 0; i < 500; ++i) {
    for (const Byte b : read_request(i, kPositionOfAxis1, 2)) requests.push_back(b);
    for (const Byte b : position_reply(i)) expected.push_back(b);
  }
  client.send(requests);
  EXPECT_EQ(client.receive(expected.size()), expected);
}

TEST(ModbusServer, AnswersARequestThatComesByteByByteInItsTime) {
  Served served;
  served.start();
  TestClient client(served);
  for (const Byte b : read_request(9, kPositionOfAxis1, 2)) {
    client.send({b});
    served.pass(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(client.receive(13), position_reply(9));
}

class ManyClients : public ::testing::TestWithParam<int> {};

TEST_P(ManyClients, AreAllServedAtOnce) {
  Served served;
  served.listeners[0].max_clients_per_address = 0;
  served.start();
  std::vector<std::unique_ptr<TestClient>> clients;
  for (int i = 0; i < GetParam(); ++i) {
    clients.push_back(std::make_unique<TestClient>(served));
    served.settle();
  }
  for (std::uint16_t round = 0; round < 5; ++round) {
    for (auto& client : clients) client->send(read_request(round, kPositionOfAxis1, 2));
    for (auto& client : clients) ASSERT_EQ(client->receive(13), position_reply(round));
  }
  EXPECT_EQ(served.server->counters().open, static_cast<std::uint32_t>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Loopback, ManyClients, ::testing::Values(32, 200));

TEST(ModbusServer, AReadOfAnotherClientDoesNotWaitForAWriteThatWaitsForTheBus) {
  Served served;
  served.port.answers_at_once = false;
  served.start();
  TestClient writer(served);
  TestClient reader(served);
  writer.send(write_request(1, kTargetTorqueOfAxis1, 100));
  ASSERT_TRUE(served.await([&] { return served.port.submitted.size() == 1; }));
  reader.send(read_request(2, kPositionOfAxis1, 2));
  EXPECT_EQ(reader.receive(13), position_reply(2));
  EXPECT_EQ(writer.received_so_far(), 0U);

  served.port.submitted[0].on_result(BatchResult{});
  EXPECT_EQ(writer.receive(12), write_request(1, kTargetTorqueOfAxis1, 100));
}

TEST(ModbusServer, RequestsBehindASlowWriteAreStartedOnArrivalUpToTheBound) {
  Served served;
  served.port.answers_at_once = false;
  served.start();
  TestClient client(served);
  for (std::uint16_t i = 0; i < 6; ++i) client.send(write_request(i, kTargetTorqueOfAxis1, i));
  ASSERT_TRUE(served.await([&] { return served.port.submitted.size() == modbus_tcp::kMaxPipelined; }));
  served.settle();
  EXPECT_EQ(served.port.submitted.size(), modbus_tcp::kMaxPipelined);

  for (std::size_t i = 0; i < 6; ++i) {
    ASSERT_TRUE(served.await([&] { return served.port.submitted.size() > i; }));
    const BatchCallback on_result = served.port.submitted[i].on_result;
    on_result(BatchResult{});
  }
  for (std::uint16_t i = 0; i < 6; ++i) EXPECT_EQ(client.receive(12), write_request(i, kTargetTorqueOfAxis1, i));
}

TEST(ModbusServer, ServesAnObjectInPartsWhenItsDriveHasSentIt) {
  Served served;
  served.port.answers_at_once = false;
  served.start();
  TestClient client(served);
  // 1008h:0 of axis 1, from its begin and from behind what one reply holds.
  client.send({0, 1, 0, 0, 0, 13, 0xFF, 0x2B, 0x0D, 0, 0, 1, 0x10, 0x08, 0, 0, 0, 0, 0});
  client.send({0, 2, 0, 0, 0, 13, 0xFF, 0x2B, 0x0D, 0, 0, 1, 0x10, 0x08, 0, 0, 0xF1, 0, 0});
  ASSERT_TRUE(served.await([&] { return served.port.submitted.size() == 1; }));
  served.settle();
  EXPECT_EQ(client.received_so_far(), 0U);

  BatchResult result;
  result.object_bytes = std::make_shared<const std::vector<Byte>>(243, Byte{'x'});
  served.port.submitted[0].on_result(result);
  std::vector<Byte> first{0, 1, 0, 0, 0, 254, 0xFF, 0x2B, 0x0D, 0x80, 0, 1, 0x10, 0x08, 0, 0, 0, 0, 0xF1};
  first.resize(first.size() + 241, 'x');
  EXPECT_EQ(client.receive(first.size()), first);
  EXPECT_EQ(client.receive(21),
            (std::vector<Byte>{0, 2, 0, 0, 0, 15, 0xFF, 0x2B, 0x0D, 0, 0, 1, 0x10, 0x08, 0, 0, 0xF1, 0, 2, 'x', 'x'}));
}

TEST(ModbusServer, AResultThatComesAfterItsClientLeftReachesNobody) {
  Served served;
  served.port.answers_at_once = false;
  served.start();
  auto client = std::make_unique<TestClient>(served);
  client->send(write_request(1, kTargetTorqueOfAxis1, 100));
  ASSERT_TRUE(served.await([&] { return served.port.submitted.size() == 1; }));
  client.reset();
  ASSERT_TRUE(served.await([&] { return served.server->counters().open == 0; }));
  served.port.submitted[0].on_result(BatchResult{});
  served.settle();
  EXPECT_EQ(served.server->counters().closed_by_peer, 1U);
}

TEST(ModbusServer, AFloodOfRequestsDoesNotStarveAnotherClient) {
  Served served;
  served.start();
  TestClient flooding(served);
  TestClient modest(served);
  constexpr std::size_t kFlood = 3000;
  std::vector<Byte> flood;
  for (std::size_t i = 0; i < kFlood; ++i) {
    for (const Byte b : read_request(1, kPositionOfAxis1, 2)) flood.push_back(b);
  }
  const std::size_t sent = flooding.send_what_fits(flood) / 12;
  ASSERT_GT(sent, 1000U);
  modest.send(read_request(2, kPositionOfAxis1, 2));
  EXPECT_EQ(modest.receive(13), position_reply(2));
  EXPECT_LT(flooding.received_so_far() / 13, sent / 2) << "the modest client had to wait for the flood's end";
  EXPECT_EQ(flooding.receive(sent * 13).size(), sent * 13);
}

TEST(ModbusServer, AClientHasRoleRankAndNameByItsEntryOfTheAllowList) {
  Served served;
  const modbus_tcp::Address loopback{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 127, 0, 0, 0};
  served.listeners[0].has_allow = true;
  served.listeners[0].allow = {{loopback, 104, Role::operator_, 7}};
  served.start();
  TestClient plc(served);
  plc.send(write_request(1, kTargetTorqueOfAxis1, 1));
  ASSERT_TRUE(served.await([&] { return served.port.submitted.size() == 1; }));
  const auto life = served.port.submitted[0].batch.life;
  ASSERT_NE(life, nullptr);
  EXPECT_EQ(life->role, Role::operator_);
  EXPECT_EQ(life->rank, 7);
  EXPECT_EQ(life->name.rfind("127.0.0.1:", 0), 0U) << life->name;
  plc.leave(true);
  EXPECT_TRUE(served.await([&] { return !life->connected; }));
}

}  // namespace
}  // namespace axisgate::test
