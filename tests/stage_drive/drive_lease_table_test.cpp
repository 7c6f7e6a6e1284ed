// SPDX-License-Identifier: Apache-2.0
// Design 3.5 as a table: what each motor on each protocol does when whoever commands it dies, and that a drive which
// wants a command each second gets it as long as its owner lives, and no longer.
#include <gmock/gmock.h>

#include "tests/stage_drive/owned_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr Duration kLease = 2000ms, kWatchdog = simulated::KeyaDrive::watchdog_time;

LeaseRules lease(LeaseAction on_expiry) { return {.timeout = kLease, .on_expiry = on_expiry}; }

class OwnerDies : public testing::TestWithParam<std::tuple<Subject, LeaseAction>> {};

TEST_P(OwnerDies, TheMotorIsStoppedAndLatchedUntilAFreshEnable) {
  const auto& [subject, action] = GetParam();
  OwnedRig drive(subject, lease(action));
  drive.set_moving(3s);
  drive.rig.stage.run(kLease - 10ms);
  EXPECT_TRUE(drive.rig.turns()) << "not before its lease has run out";
  ASSERT_TRUE(drive.rig.stage.run_until([&] { return !drive.rig.turns(); }, 15s));
  drive.rig.stage.run(kWatchdog + 500ms);
  EXPECT_FALSE(drive.rig.turns());
  EXPECT_TRUE(drive.latched());
  EXPECT_FALSE(drive.rig.axis().lease.owner);
  const bool stays = subject == Subject::id286pro ? drive.rig.powered()
                                                  : action == LeaseAction::halt && !has_command_watchdog(subject);
  EXPECT_EQ(drive.rig.powered(), stays);
  EXPECT_EQ(drive.ask(drive.rig.motion()), Errc::state_unsuitable);
  drive.run(1s);
  EXPECT_FALSE(drive.rig.turns()) << "its owner's return alone starts nothing";
  EXPECT_EQ(drive.command(Command::enable), Errc::ok);
  EXPECT_FALSE(drive.latched());
  EXPECT_TRUE(drive.rig.powered());
  drive.run(500ms);
  EXPECT_FALSE(drive.rig.turns()) << "velocity and start are needed anew";
  EXPECT_EQ(drive.ask(drive.rig.motion()), Errc::ok);
  drive.run(500ms);
  EXPECT_TRUE(drive.rig.turns());
  EXPECT_FALSE(drive.rig.neighbour_powered());
}

INSTANTIATE_TEST_SUITE_P(
    Table, OwnerDies,
    testing::Combine(testing::ValuesIn(kSubjects),
                     testing::Values(LeaseAction::quick_stop, LeaseAction::halt, LeaseAction::disable)),
    [](const auto& case_of) { return name(std::get<0>(case_of.param)) + "_" + name(std::get<1>(case_of.param)); });

class KeepAliveOnAKeya : public testing::TestWithParam<Subject> {
 protected:
  static bool has_watchdog() { return has_command_watchdog(GetParam()); }
};

TEST_P(KeepAliveOnAKeya, NeverTripsWhileTheOwnerLivesAndTheMotorIsOffSoonAfterItsDeath) {
  OwnedRig drive(GetParam(), lease(LeaseAction::none));
  drive.set_moving(3s);
  drive.run(10s);
  EXPECT_TRUE(drive.rig.turns());
  EXPECT_TRUE(drive.rig.powered());
  EXPECT_EQ(drive.rig.trips(), 0U);
  drive.owner->last_request = drive.rig.stage.runtime().now();
  // The last command may have left just before the lease ran out.
  drive.rig.stage.run(kLease + kWatchdog + 10ms);
  EXPECT_EQ(drive.rig.powered(), !has_watchdog());
  EXPECT_EQ(drive.rig.trips(), has_watchdog() ? 1U : 0U);
  const unsigned alarm = drive.rig.axis().alarms >> static_cast<unsigned>(AxisAlarm::no_comm_watchdog) & 1U;
  EXPECT_EQ(alarm, has_watchdog() ? 0U : 1U) << "a drive that would go on says so";
  EXPECT_EQ(drive.rig.axis().loss_stop_ms == kGoesOn, !has_watchdog()) << "and row 98 says the same";
}

TEST_P(KeepAliveOnAKeya, ADisabledMotorIsToldNothing) {
  OwnedRig drive(GetParam(), lease(LeaseAction::quick_stop));
  ASSERT_EQ(drive.command(Command::enable), Errc::ok);
  drive.run(2s);
  ASSERT_EQ(drive.command(Command::disable), Errc::ok);
  const std::uint64_t controls = drive.rig.stage.keya(0).controls();
  drive.run(3s);
  EXPECT_EQ(drive.rig.stage.keya(0).controls(), controls);
  EXPECT_FALSE(drive.rig.powered());
}

INSTANTIATE_TEST_SUITE_P(Table, KeepAliveOnAKeya, testing::ValuesIn(subjects(is_keya)), named);

}  // namespace
}  // namespace axisgate::test
