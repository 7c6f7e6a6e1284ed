// SPDX-License-Identifier: Apache-2.0
// How the server starts and how it ends.
#include <gmock/gmock.h>

#include <optional>
#include <stdexcept>
#include <vector>

#include "tests/unit/modbus_server/served.hpp"

namespace axisgate::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string failure_of_start(Served& served) {
  try {
    served.start();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "started";
}

TEST(ModbusServerStart, APortThatIsTakenIsNamedWithWhatToDo) {
  Served holder;
  holder.start();
  Served served;
  served.listeners[0].port = holder.server->ports()[0];
  const std::string port = std::to_string(holder.server->ports()[0]);
  EXPECT_THAT(failure_of_start(served), AllOf(HasSubstr("/modbus_tcp/0/listen: cannot listen on 127.0.0.1:" + port),
                                              HasSubstr("stop that one or choose another port")));
}

/// Beside one that is there.
struct LateAddress : testing::Test {
  LateAddress() {
    served.listeners.push_back(served.listeners[0]);
    served.listeners[0].host = "192.0.2.1";  // TEST-NET-1: nobody's
  }
  Served served;
};

TEST_F(LateAddress, IsToldOnceWhileTheOthersServe) {
  served.start();
  EXPECT_TRUE(served.listener_down);
  for (int second = 0; second < 90; ++second) served.pass(std::chrono::seconds(1));
  EXPECT_THAT(served.events, ElementsAre(AllOf(HasSubstr("/modbus_tcp/0/listen: cannot listen on 192.0.2.1:"),
                                               HasSubstr("no interface of this computer has this address"),
                                               HasSubstr("trying again each second"))));
  EXPECT_THAT(served.lines, ElementsAre(HasSubstr("listening on 127.0.0.1:"))) << "one of the two listens";
  TestClient client(served, 1);
  client.send(read_request(1, 0, 1));
  EXPECT_EQ(client.receive(11).size(), 11U);
}

TEST_F(LateAddress, DoesNotHideOneThatIsTaken) {
  Served holder;
  holder.start();
  served.listeners[1].port = holder.server->ports()[0];
  EXPECT_THAT(failure_of_start(served), HasSubstr("/modbus_tcp/1/listen"));
}

TEST_F(LateAddress, IsForgottenByAReloadThatAsksForAnother) {
  served.start();
  const std::vector<modbus_tcp::ListenerSettings> wanted{served.listeners[1]};
  const std::vector<std::optional<std::size_t>> kept{1};
  served.server->prepare(wanted, kept);
  served.server->commit({});
  EXPECT_FALSE(served.listener_down);
}

TEST_F(LateAddress, OfAReloadIsTriedToo) {
  const std::vector<modbus_tcp::ListenerSettings> wanted{served.listeners[1], served.listeners[0]};
  served.listeners.erase(served.listeners.begin());
  served.start();
  EXPECT_FALSE(served.listener_down);
  const std::vector<std::optional<std::size_t>> kept{0, std::nullopt};
  served.server->prepare(wanted, kept);
  EXPECT_FALSE(served.listener_down) << "nothing has changed yet";
  served.server->commit({});
  EXPECT_TRUE(served.listener_down);
  EXPECT_THAT(served.events, ElementsAre(HasSubstr("/modbus_tcp/1/listen: cannot listen on 192.0.2.1:")));
}

TEST(ModbusServerStart, ATextThatIsNoAddressIsRefused) {
  Served served;
  served.listeners[0].host = "gateway.local";
  EXPECT_THAT(failure_of_start(served), HasSubstr("not an IP address"));
}

TEST(ModbusServerStart, WhereOneListenerCannotBeOpenedNoneStaysOpen) {
  Served holder;
  holder.start();
  Served served;
  served.listeners.push_back(served.listeners[0]);
  served.listeners[1].port = holder.server->ports()[0];
  EXPECT_THAT(failure_of_start(served), HasSubstr("/modbus_tcp/1/listen"));
  const std::uint16_t first = served.server->ports()[0];
  ASSERT_NE(first, 0);

  Served next;
  next.listeners[0].port = first;
  EXPECT_EQ(failure_of_start(next), "started") << "the first listener's port is free again";
}

TEST(ModbusServerStart, APortIsFreeForTheNextStartAtOnce) {
  Served served;
  served.start();
  const std::uint16_t port = served.server->ports()[0];
  {
    TestClient client(served);
    client.send(read_request(1, 0, 1));
    EXPECT_EQ(client.receive(11).size(), 11U);
    served.server->stop();
    EXPECT_TRUE(client.closed_by_server());
  }
  Served next;
  next.listeners[0].port = port;
  EXPECT_EQ(failure_of_start(next), "started");
}

TEST(ModbusServerStop, NothingOfItRunsOnceItIsGone) {
  Served served;
  served.port.answers_at_once = false;
  served.start();
  TestClient writer(served);
  writer.send(write_request(1, 146, 100));
  ASSERT_TRUE(served.await([&] { return served.port.submitted.size() == 1; }));
  served.server.reset();
  served.settle();  // handlers of closed sockets are still to run: they must find nothing to touch
  served.port.submitted[0].on_result(BatchResult{});
  served.pass(std::chrono::hours(1));
  EXPECT_TRUE(writer.closed_by_server());
}

TEST(ModbusServerStop, ConnectionsThatEndedInTheSameTurnAreGoneToo) {
  Served served;
  served.start();
  auto client = std::make_unique<TestClient>(served);
  served.settle();
  client.reset();
  // One step at a time, the server ends between the connection's end and its removal.
  while (served.server->counters().open != 0) {
    served.io.restart();
    ASSERT_TRUE(served.io.run_one_for(kPatience));
  }
  served.server.reset();
  served.settle();
}

}  // namespace
}  // namespace axisgate::test
