// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/shown.hpp"

#include <gtest/gtest.h>

namespace axisgate {
namespace {

AxisImage online_axis() {
  AxisImage axis;
  axis.number = 1;
  axis.supported = ~0U;
  axis.link_state = LinkState::online;
  return axis;
}

void receive(AxisImage& axis, Quantity quantity, std::int64_t value) {
  axis[quantity] = {value, true, true, Instant{}};
}

TEST(Shown, AValueOnceReceivedIsShown) {
  AxisImage axis = online_axis();
  receive(axis, Quantity::position_actual, -123456);
  EXPECT_EQ(shown_value(axis, Quantity::position_actual), -123456);
}

TEST(Shown, AValueNeverReceivedReadsAsTheEndOfItsType) {
  const AxisImage axis = online_axis();
  for (const QuantityRow& each : quantity_table())
    EXPECT_EQ(shown_value(axis, each.quantity), no_value(each.type)) << each.name;
}

TEST(Shown, AValueTheDriveDoesNotHaveReadsAsTheEndOfItsType) {
  AxisImage axis = online_axis();
  receive(axis, Quantity::motor_temperature, 250);
  axis.supported &= ~bit(Quantity::motor_temperature);
  EXPECT_EQ(shown_value(axis, Quantity::motor_temperature), -32768);
}

TEST(Shown, AValueThatDoesNotFitItsRegisterReadsAsTheEndOfItsTypeAndNeverWraps) {
  AxisImage axis = online_axis();
  receive(axis, Quantity::velocity_actual, 2147483648LL);
  receive(axis, Quantity::torque_actual, -40000);
  receive(axis, Quantity::dc_voltage, -1);
  EXPECT_EQ(shown_value(axis, Quantity::velocity_actual), -2147483648LL);
  EXPECT_EQ(shown_value(axis, Quantity::torque_actual), -32768);
  EXPECT_EQ(shown_value(axis, Quantity::dc_voltage), 65535);
}

TEST(Shown, WhileTheAxisCannotBeReachedItsStatusIsZeroAndItsNumbersAreTheLastGoodOnes) {
  for (const LinkState state : {LinkState::unknown, LinkState::setup, LinkState::offline, LinkState::link_down}) {
    AxisImage axis = online_axis();
    receive(axis, Quantity::statusword, 0x1237);
    receive(axis, Quantity::position_actual, 42);
    axis.inputs = 0x17FF;
    axis.level_coils = 0x89;
    axis.link_state = state;
    EXPECT_EQ(shown_value(axis, Quantity::statusword), 0);
    EXPECT_EQ(shown_value(axis, Quantity::position_actual), 42);
    EXPECT_EQ(axis.valid_bits(), 0U);
    EXPECT_EQ(shown_inputs(axis), bit(AxisInput::stop_latched)) << "the latch is the gateway's own knowledge";
    EXPECT_EQ(shown_level_coils(axis), 0);
  }
}

TEST(Shown, ASuspectAxisStillShowsWhatItKnows) {
  AxisImage axis = online_axis();
  axis.link_state = LinkState::suspect;
  receive(axis, Quantity::statusword, 0x1237);
  axis.inputs = bit(AxisInput::enabled);
  EXPECT_EQ(shown_value(axis, Quantity::statusword), 0x1237);
  EXPECT_EQ(shown_inputs(axis), bit(AxisInput::enabled));
}

TEST(Shown, ErrorCodeTellsOfTheLostContactUnlessTheDrivesLastCodeWasAnother) {
  AxisImage axis = online_axis();
  axis.link_state = LinkState::offline;
  EXPECT_EQ(shown_value(axis, Quantity::error_code), 0x8130) << "never received";
  receive(axis, Quantity::error_code, 0);
  EXPECT_EQ(shown_value(axis, Quantity::error_code), 0x8130) << "no error before";
  receive(axis, Quantity::error_code, 0x2310);
  EXPECT_EQ(shown_value(axis, Quantity::error_code), 0x2310);
}

TEST(Shown, OwnershipIsEachClientsOwnAndNeverTheAxiss) {
  AxisImage axis = online_axis();
  axis.inputs = 0xFFFF;
  EXPECT_EQ(shown_inputs(axis) & bit(AxisInput::owned_by_me), 0);
}

TEST(Shown, OnlyLevelCoilsAreReadBack) {
  AxisImage axis = online_axis();
  axis.level_coils = 0xFFFF;
  EXPECT_EQ(shown_level_coils(axis), 0x389);
}

}  // namespace
}  // namespace axisgate
