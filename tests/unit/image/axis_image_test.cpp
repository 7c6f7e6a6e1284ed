// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/axis_image.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace axisgate {
namespace {

AxisImage running_axis() {
  AxisImage axis;
  axis.number = 3;
  axis.supported = ~0U;
  axis.link_state = LinkState::online;
  for (const QuantityRow& each : quantity_table()) axis[each.quantity] = {7, true, true, Instant{}};
  return axis;
}

struct Change {
  const char* what;
  std::function<void(AxisImage&)> make;
};

TEST(Sequence, StepsForEveryChangeThatAClientCouldNotice) {
  const Change changes[] = {
      {"a value", [](AxisImage& a) { a[Quantity::position_actual].value = 8; }},
      {"a setpoint read back", [](AxisImage& a) { a[Quantity::max_velocity].value = 8; }},
      {"a valid bit", [](AxisImage& a) { a[Quantity::torque_actual].valid = false; }},
      {"a value lost", [](AxisImage& a) { a[Quantity::torque_actual].received = false; }},
      {"the error", [](AxisImage& a) { a[Quantity::error_code].value = 0x2310; }},
      {"the link", [](AxisImage& a) { a.link_state = LinkState::suspect; }},
      {"an input", [](AxisImage& a) { a.inputs = bit(AxisInput::homed); }},
      {"a level coil", [](AxisImage& a) { a.level_coils = 1; }},
      {"the axis state", [](AxisImage& a) { a.axis_state = AxisState::homing; }},
      {"the motion", [](AxisImage& a) { a.motion_state = MotionState::active; }},
      {"the motion's id", [](AxisImage& a) { a.motion_id = 9; }},
      {"an alarm", [](AxisImage& a) { a.alarms = bit(AxisAlarm::clamped); }},
      {"the owner", [](AxisImage& a) { a.lease.owner = std::make_shared<ClientLife>(); }},
  };
  for (const Change& change : changes) {
    AxisImage changed = running_axis();
    change.make(changed);
    EXPECT_FALSE(shows_the_same(running_axis(), changed)) << change.what;
  }
}

TEST(Sequence, DoesNotStepForAgesEqualValuesOrResults) {
  const Change changes[] = {
      {"nothing", [](AxisImage&) {}},
      {"the same value again",
       [](AxisImage& a) {
         a[Quantity::position_actual] = {7, true, true, Instant::max()};
       }},
      {"the age", [](AxisImage& a) { a.oldest_cyclic = Instant{}; }},
      {"the sequence", [](AxisImage& a) { a.sequence = 99; }},
      {"a result",
       [](AxisImage& a) {
         a.latest = {CommandResult::done, 0, 4};
       }},
  };
  for (const Change& change : changes) {
    AxisImage changed = running_axis();
    change.make(changed);
    EXPECT_TRUE(shows_the_same(running_axis(), changed)) << change.what;
  }
}

TEST(Sequence, DoesNotStepForWhatNobodyIsShown) {
  AxisImage before = running_axis();
  before.link_state = LinkState::offline;
  AxisImage after = before;
  after[Quantity::statusword].value = 0x37;
  after.inputs = bit(AxisInput::enabled);
  EXPECT_TRUE(shows_the_same(before, after));
}

TEST(ValidBits, AreThoseOfSupportedValuesThatAreGoodNow) {
  AxisImage axis = running_axis();
  EXPECT_EQ(axis.valid_bits(), ~0U);
  axis[Quantity::dc_voltage].valid = false;
  axis.supported &= ~bit(Quantity::statusword);
  axis[Quantity::max_torque].received = false;
  EXPECT_EQ(axis.valid_bits(),
            ~0U & ~bit(Quantity::dc_voltage) & ~bit(Quantity::statusword) & ~bit(Quantity::max_torque));
}

TEST(Texts, AreThereForEveryAlarmAndState) {
  for (std::size_t i = 0; i < kAxisAlarmCount; ++i) EXPECT_NE(text(static_cast<AxisAlarm>(i)), "?");
  for (int i = 0; i <= 5; ++i) EXPECT_NE(text(static_cast<LinkState>(i)), "?");
  for (int i = 0; i <= 6; ++i) EXPECT_NE(text(static_cast<AxisState>(i)), "?");
}

TEST(AxisImage, IsOfAnUnknownStateUntilItsDriveIsSeen) {
  const AxisImage axis;
  EXPECT_EQ(axis.axis_state, AxisState::unknown);
  EXPECT_EQ(static_cast<int>(AxisState::unknown), 7);
  EXPECT_EQ(text(AxisState::unknown), "unknown") << "as `axisgate top` shows it";
}

}  // namespace
}  // namespace axisgate
