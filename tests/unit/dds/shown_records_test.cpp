// SPDX-License-Identifier: Apache-2.0
// What samples of axis_state and gateway_state are filled with: each member by its own row. And what is bounded.
#include <gmock/gmock.h>

#include "gateway/image/shown.hpp"
#include "gateway/upstream/dds/gateway_record.hpp"
#include "gateway/upstream/dds/namesakes.hpp"
#include "gateway/upstream/dds/reply_queue.hpp"
#include "gateway/upstream/dds/state_record.hpp"
#include "tests/unit/dds/samples.hpp"

namespace axisgate::dds {
namespace {

using namespace std::chrono_literals;
using test::guid;
using test::kStart;
using testing::ElementsAre;

TEST(StateRecords, EachMemberIsFilledByItsOwnQuantity) {
  AxisImage axis;
  axis.link_state = LinkState::online;
  axis.supported = UINT32_MAX;
  for (std::size_t i = 0; i < axis.samples.size(); ++i)
    axis.samples[i] = {static_cast<std::int64_t>(101 + i), true, true, kStart};
  const DdsUnits units;
  const StateRecord out = state_record(axis, units);
  const auto si = [&](Quantity quantity) { return units.to_si(quantity, shown_value(axis, quantity)); };
  EXPECT_EQ(out.statusword, shown_value(axis, Quantity::statusword));
  EXPECT_EQ(out.mode, shown_value(axis, Quantity::mode_display));
  EXPECT_EQ(out.position, si(Quantity::position_actual));
  EXPECT_EQ(out.velocity, si(Quantity::velocity_actual));
  EXPECT_EQ(out.torque, si(Quantity::torque_actual));
  EXPECT_EQ(out.current, si(Quantity::current_actual));
  EXPECT_EQ(out.following_error, si(Quantity::following_error));
  EXPECT_EQ(out.error_code, shown_value(axis, Quantity::error_code));
  EXPECT_EQ(out.vendor_error, shown_value(axis, Quantity::vendor_error));
  EXPECT_EQ(out.inputs, shown_value(axis, Quantity::digital_inputs));
  EXPECT_EQ(out.outputs, shown_value(axis, Quantity::digital_outputs));
  EXPECT_EQ(out.drive_temperature, si(Quantity::drive_temperature));
  EXPECT_EQ(out.motor_temperature, si(Quantity::motor_temperature));
  EXPECT_EQ(out.voltage, si(Quantity::dc_voltage));
}

TEST(GatewayRecords, TheCountersOfABusStandInTheirOrder) {
  ProcessImage image;
  image.buses.push_back({"lift", 1, 2, 3, 4, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21});
  const GatewayRecord out = gateway_record(image, 0);
  ASSERT_EQ(out.buses.size(), 1U);
  EXPECT_THAT(out.buses[0].counters, ElementsAre(11, 12, 13, 14, 15, 16, 17, 18, 19, 20));
}

TEST(NamesakesKnown, OneThatIsToldAgainAfterTheLinkWasDownStays) {
  ProcessImage image;
  image.add_axis(1, "lift", 0);
  Namesakes others(image);
  others.on_record({guid(1), 1, "192.168.1.8", false});
  others.on_record({guid(2), 1, "192.168.1.9", false});
  others.on_link_up(kStart + 5s);
  others.on_record({guid(2), 1, "192.168.1.9", false});
  others.on_time(kStart + 5s);
  EXPECT_EQ(others.text(), "axis 1 of 192.168.1.9");
}

TEST(NamesakesKnown, OneMoreThanThereIsRoomForIsNotSeen) {
  ProcessImage image;
  image.add_axis(1, "lift", 0);
  Namesakes others(image);
  for (std::uint8_t n = 0; n < kMaxNamesakes; ++n) others.on_record({guid(n), 2, {}, false});
  others.on_record({guid(200), 1, {}, false});
  EXPECT_FALSE(others.taken());
}

TEST(Replies, WaitForASlowReaderAsFarAsThereIsRoom) {
  ReplyQueue replies(2);
  replies.open();
  for (int n = 0; n < 9; ++n) replies.add(ReplyRecord{});
  int waited = 0;
  while (replies.next()) ++waited;
  EXPECT_EQ(waited, 4) << "two replies, and as many refusals";
}

}  // namespace
}  // namespace axisgate::dds
