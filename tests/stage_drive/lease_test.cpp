// SPDX-License-Identifier: Apache-2.0
// Design 3.5 on an axis that really moves: what its motor does when whoever commands it falls silent, goes, or comes
// back.
#include <gmock/gmock.h>

#include "tests/stage_drive/leased_axis.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

TEST(Lease, NothingOnExpiryLeavesTheMotorRunningAndSaysSo) {
  LeasedAxis axis(leased(LeaseAction::none));
  axis.run(axis.plc);
  axis.rig.stage.run(8s);
  EXPECT_TRUE(axis.rig.turns());
  EXPECT_TRUE(axis.event("nothing is done"));
  EXPECT_FALSE(axis.rig.axis().lease.owner);
}

TEST(Lease, AnEnableThatIsUnderWayWhenItRunsOutIsStopped) {
  RigOptions options = leased();
  options.lease->timeout = 20ms;
  options.reply_delay = 15ms;
  LeasedAxis axis(options);
  const auto enable = axis.rig.stage.begin(1, axis.from(axis.plc, with_command(Command::enable)));
  axis.rig.stage.run(2s);
  EXPECT_TRUE(enable->has_value());
  EXPECT_FALSE(axis.rig.motor_enabled()) << "nobody owns it";
  EXPECT_TRUE(axis.latched());
}

TEST(Lease, AnotherClientIsRefusedButMayAlwaysStop) {
  LeasedAxis axis;
  axis.run(axis.plc);
  axis.rig.mark();
  EXPECT_EQ(axis.ask(axis.panel, setpoints({{Quantity::target_velocity, 5'000}})), Errc::not_owner);
  EXPECT_EQ(axis.command(axis.panel, Command::enable), Errc::not_owner);
  EXPECT_EQ(axis.command(axis.panel, Command::fault_reset), Errc::not_owner);
  EXPECT_TRUE(axis.rig.writes().empty());
  EXPECT_EQ(axis.command(axis.panel, Command::quick_stop), Errc::ok);
  EXPECT_TRUE(axis.rig.axis().lease.owned_by(1)) << "a stop does not move the lease";
  EXPECT_FALSE(axis.rig.turns());
}

TEST(Lease, WhatAStopHasDroppedUnsentItsOwnerAsksForAnew) {
  LeasedAxis axis;
  const auto enable = axis.rig.stage.begin(1, axis.from(axis.plc, with_command(Command::enable)));
  ASSERT_TRUE(axis.rig.stage.run_until([&] { return !axis.rig.writes().empty(); }));
  const auto target = axis.rig.stage.begin(1, axis.from(axis.plc, setpoints({{Quantity::target_position, 77}})));
  EXPECT_FALSE(axis.rig.stage.gateway().owner_asks(1, 1, Quantity::target_position, 77)) << "it waits";
  EXPECT_EQ(axis.command(axis.panel, Command::disable), Errc::ok);
  EXPECT_EQ((*target)->outcome.code, Errc::dropped_by_stop);
  EXPECT_TRUE(axis.rig.stage.gateway().owner_asks(1, 1, Quantity::target_position, 77));
}

TEST(Lease, AStopOfAnotherClientIsCarriedOutAndWhatStandsBesideItRefused) {
  LeasedAxis axis;
  axis.run(axis.plc);
  EXPECT_EQ(axis.ask(axis.panel, with_command(Command::quick_stop, {{Quantity::target_velocity, 5'000}})),
            Errc::not_owner);
  EXPECT_TRUE(axis.latched());
  EXPECT_TRUE(axis.rig.axis().lease.owned_by(1));
}

TEST(Lease, APlcInStopWhoseScannerGoesOnIsDeadWhereHeartbeatsRenew) {
  LeasedAxis axis(leased(LeaseAction::quick_stop, LeaseRenewal::heartbeat));
  WriteBatch beat;
  beat.beats = true;
  EXPECT_EQ(axis.command(axis.plc, Command::enable), Errc::ok);
  EXPECT_EQ(axis.ask(axis.plc, with_command(Command::run_velocity, {{Quantity::target_velocity, 100'000}})), Errc::ok);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(axis.ask(axis.plc, beat), Errc::ok);
    axis.rig.stage.run(200ms);
  }
  EXPECT_TRUE(axis.rig.turns());
  for (int i = 0; i < 40; ++i) {
    static_cast<void>(axis.ask(axis.plc, WriteBatch{}));
    axis.rig.stage.run(200ms);
  }
  EXPECT_FALSE(axis.rig.turns());
}

TEST(Lease, AReleasedRunningAxisIsStoppedUnlessSomebodyTakesIt) {
  LeasedAxis axis;
  axis.run(axis.plc);
  EXPECT_EQ(axis.command(axis.plc, Command::release), Errc::ok);
  EXPECT_FALSE(axis.rig.axis().lease.owner);
  axis.rig.stage.run(1s);
  EXPECT_TRUE(axis.rig.turns());
  axis.rig.stage.run(4s);
  EXPECT_FALSE(axis.rig.turns());
}

// 3.5: on_expiry "acts only if the axis is enabled". The answer spoke of another client that nobody was.
TEST(Lease, ThatRunsOutBesideAFaultResetStopsNothing) {
  constexpr std::uint16_t kTooHigh = 0x0020;  // the supply
  RigOptions options = leased();
  options.lease->timeout = 500ms;
  LeasedAxis axis(options);
  axis.run(axis.plc);
  axis.rig.motor().inject_fault(1, kTooHigh);
  axis.keep(axis.plc, 2s);
  EXPECT_EQ(axis.command(axis.plc, Command::fault_reset), Errc::not_reached);
  EXPECT_FALSE(axis.rig.axis().has(AxisInput::stop_latched));
  EXPECT_FALSE(axis.rig.has_event(EventKind::lease, "quick stop"));
}

}  // namespace
}  // namespace axisgate::test
