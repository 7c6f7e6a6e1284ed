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
