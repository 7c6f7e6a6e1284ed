// SPDX-License-Identifier: Apache-2.0
// What a subscriber sees when axisgate-dds reads late, slowly, or for the first time.
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "tests/unit/dds/plain_session.hpp"

namespace axisgate::dds {
namespace {

using namespace std::chrono_literals;
using test::command;
using test::guid;
using test::PlainSession;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kTurn = 2 * 3.14159265358979323846;

TEST(Reader, FirstHearsOfAllAxesAndOfTheGateway) {
  PlainSession plain(64);
  plain.image.buses.resize(2);
  plain.image.buses[1].name = "can0";
  plain.image.buses[1].reconnects = 4;
  plain.image.refresh = [&] { plain.image.gateway.axes_online = 63; };
  const auto all = plain.read();
  ASSERT_THAT(all, SizeIs(65));
  for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(std::get<StateRecord>(all[i]).axis, i + 1);
  const auto& gateway = std::get<GatewayRecord>(all.back());
  EXPECT_EQ(gateway.axis_count, 64);
  EXPECT_EQ(gateway.axes_online, 63) << "gathered when it was looked at";
  ASSERT_THAT(gateway.buses, SizeIs(2));
  EXPECT_EQ(gateway.buses[1].name, "can0");
  EXPECT_EQ(gateway.buses[1].counters.back(), 4U);
}

TEST(Reader, HearsOfTheGatewayEachSecond) {
  PlainSession plain;
  EXPECT_THAT(plain.read<GatewayRecord>(), SizeIs(1));
  EXPECT_EQ(plain.session->wake_at(), plain.now + 1s);
  plain.now += 999ms;
  EXPECT_THAT(plain.read<GatewayRecord>(), IsEmpty());
  plain.now += 1ms;
  EXPECT_THAT(plain.read<GatewayRecord>(), SizeIs(1));
}

TEST(Reader, IsWokenByAChangeOnceAndFindsTheNewestState) {
  PlainSession plain(2);
  static_cast<void>(plain.read());
  plain.now += 50ms;
  plain.woken = 0;
  for (int i = 1; i <= 5; ++i) plain.change(2, i * 10'000);
  EXPECT_EQ(plain.woken, 1);
  const auto states = plain.read<StateRecord>();
  ASSERT_THAT(states, SizeIs(1));
  EXPECT_EQ(states[0].axis, 2);
  EXPECT_DOUBLE_EQ(states[0].position, 5 * kTurn);
  EXPECT_EQ(states[0].sequence, 5U) << "the gap says that there were others";
  plain.change(1, 10'000);
  EXPECT_EQ(plain.woken, 2);
}

TEST(Reader, ThatIsAlwaysBehindHearsOfTheGatewayAllTheSame) {
  PlainSession plain(64);
  static_cast<void>(plain.read());
  int gateway = 0;
  for (int i = 1; i <= 1000; ++i) {
    plain.now += 10ms;
    for (AxisNumber axis = 1; axis <= 64; ++axis) plain.change(axis, i);
    const auto record = plain.session->next(plain.now);
    gateway += record && std::holds_alternative<GatewayRecord>(*record);
  }
  EXPECT_GE(gateway, 4);
}

TEST(Reader, GetsRepliesBeforeEventsBeforeStatesBeforeTheGateway) {
  PlainSession plain;
  plain.port.at_once = BatchResult{};
  plain.now += 1s;
  plain.ring.add(plain.now, 1, EventKind::fault, 1, "a fault");
  plain.session->on_record(command(guid(1), 1, 1), plain.now);
  plain.session->on_link_up(plain.now);
  const auto all = plain.read();
  ASSERT_THAT(all, SizeIs(4));
  EXPECT_TRUE(std::holds_alternative<ReplyRecord>(all[0]));
  EXPECT_TRUE(std::holds_alternative<EventRecord>(all[1]));
  EXPECT_TRUE(std::holds_alternative<StateRecord>(all[2]));
  EXPECT_TRUE(std::holds_alternative<GatewayRecord>(all[3]));
}

TEST(Reader, OfABurstOfEventsGetsTheNewestAndIsToldHowManyWereLost) {
  PlainSession plain;
  static_cast<void>(plain.read());
  plain.woken = 0;
  for (int i = 0; i < 1200; ++i) plain.ring.add(plain.now, 1, EventKind::warning, 0, "again");
  EXPECT_EQ(plain.woken, 1);
  const auto events = plain.read<EventRecord>();
  ASSERT_THAT(events, SizeIs(feed::kMaxEventsWaiting));
  EXPECT_EQ(events.front().number, 201U);
  EXPECT_EQ(events.back().number, 1200U);
  plain.now += 1s;
  const auto gateway = plain.read<GatewayRecord>();
  ASSERT_THAT(gateway, SizeIs(1));
  EXPECT_EQ(gateway.front().events_lost, 200U);
}

TEST(Reader, ThatComesBackGetsAllAxesAndTheNewestEventsAgain) {
  PlainSession plain(3);
  plain.ring.add(plain.now, 1, EventKind::boot, 0, "boot");
  static_cast<void>(plain.read());
  plain.session->on_link_down(plain.now);
  plain.now += 100ms;
  plain.change(2, 10'000);
  plain.ring.add(plain.now, 2, EventKind::link, 0, "gone");
  plain.woken = 0;
  EXPECT_THAT(plain.read(), IsEmpty());
  plain.now += 2s;
  plain.session->on_link_up(plain.now);
  const auto all = plain.read();
  ASSERT_THAT(all, SizeIs(6));
  EXPECT_EQ(std::get<EventRecord>(all[0]).number, 1U);
  EXPECT_EQ(std::get<EventRecord>(all[1]).number, 2U);
  EXPECT_DOUBLE_EQ(std::get<StateRecord>(all[3]).position, kTurn);
  plain.now += 20ms;
  plain.change(1, 1);
  EXPECT_EQ(plain.woken, 1) << "and is woken again";
}

TEST(Reader, ThatComesBackWithoutOneOfItsWritersHasLostIt) {
  PlainSession plain;
  plain.session->on_record(test::writer_there(guid(1)), plain.now);
  plain.session->on_record(test::command(guid(1), 3, 1), plain.now);
  static_cast<void>(plain.read());
  plain.session->on_link_down(plain.now);
  plain.now += 2s;
  plain.session->on_link_up(plain.now);
  plain.now += 8s - 500ms;
  static_cast<void>(plain.read());
  EXPECT_THAT(plain.port.gone, IsEmpty());
  EXPECT_EQ(plain.session->wake_at(), plain.now + 500ms) << "before anything is to be sent";
  plain.now += 500ms;
  static_cast<void>(plain.read());
  EXPECT_THAT(plain.port.gone, SizeIs(1));
}

TEST(Reader, OfAnAxisThatCannotBeReachedHearsSoAndKeepsItsLastNumbers) {
  PlainSession plain;
  AxisImage& axis = *plain.image.find(1);
  axis[Quantity::position_actual].value = 10'000;
  axis[Quantity::statusword].value = 0x1237;
  axis[Quantity::torque_actual] = {0, false, false, kLongAgo + 3h};
  axis.supported = ~bit(Quantity::dc_voltage);
  axis.link_state = LinkState::offline;
  axis[Quantity::current_actual].at = kLongAgo + 2h;
  const auto states = plain.read<StateRecord>();
  ASSERT_THAT(states, SizeIs(1));
  const StateRecord& state = states.front();
  EXPECT_EQ(state.link_state, 4);
  EXPECT_EQ(state.statusword, 0);
  EXPECT_EQ(state.error_code, 0x8130);
  EXPECT_EQ(state.valid, 0U);
  EXPECT_DOUBLE_EQ(state.position, kTurn);
  EXPECT_TRUE(std::isnan(state.torque)) << "never received";
  EXPECT_TRUE(std::isnan(state.voltage)) << "not supported";
  EXPECT_EQ(state.at, (kLongAgo + 2h).time_since_epoch().count()) << "the newest sample's";
  EXPECT_EQ(state.name, "axis 1");
}

}  // namespace
}  // namespace axisgate::dds
