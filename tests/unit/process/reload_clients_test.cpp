// SPDX-License-Identifier: Apache-2.0
// Which axes without a lease a closed connection could stop: a reload must not.
#include <gtest/gtest.h>

#include "gateway/process/reload.hpp"

namespace axisgate::process {
namespace {

AxisImage axis_in(AxisState state, bool lease = false) {
  AxisImage axis;
  axis.axis_state = state;
  axis.lease.rules.on = lease;
  return axis;
}

TEST(ReloadClients, AMotionThatNothingElseEndsMayStopWithItsClient) {
  for (const AxisState state : {AxisState::discrete_motion, AxisState::continuous_motion, AxisState::homing}) {
    EXPECT_TRUE(may_stop_with_a_client(axis_in(state), true)) << text(state);
    EXPECT_FALSE(may_stop_with_a_client(axis_in(state), false)) << text(state);
    EXPECT_FALSE(may_stop_with_a_client(axis_in(state, true), true)) << "its owner is known: " << text(state);
  }
}

TEST(ReloadClients, AnAxisThatDoesNotMoveHasNothingToLose) {
  for (const AxisState state :
       {AxisState::disabled, AxisState::standstill, AxisState::stopping, AxisState::error_stop, AxisState::unknown})
    EXPECT_FALSE(may_stop_with_a_client(axis_in(state), true)) << text(state);
}

TEST(ReloadClients, AJogAlwaysNeedsItsClient) {
  for (const auto coils : {std::uint16_t{0x100}, std::uint16_t{0x200}}) {
    AxisImage axis = axis_in(AxisState::continuous_motion);
    axis.level_coils = coils;
    EXPECT_TRUE(may_stop_with_a_client(axis, false)) << coils;
  }
}

}  // namespace
}  // namespace axisgate::process
