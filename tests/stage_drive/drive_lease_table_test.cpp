// SPDX-License-Identifier: Apache-2.0
// Design 3.5 as a table: what each motor on each protocol does when whoever commands it dies, and that a drive which
// wants a command each second gets it as long as its owner lives, and no longer.
#include <gmock/gmock.h>

#include "tests/stage_drive/drive_table_rig.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr Duration kLease = 2000ms, kWatchdog = simulated::KeyaDrive::watchdog_time;

/// One drive and its owner.
struct OwnedDrive {
  OwnedDrive(Subject subject, LeaseAction on_expiry)
      : rig(subject, LeaseRules{.timeout = kLease, .on_expiry = on_expiry}) {
    rig.online();
  }

  Errc ask(WriteBatch batch) {
    owner->last_request = rig.stage.runtime().now();
    batch.client = owner->id;
    batch.role = owner->role;
    batch.life = owner;
    batch.claims = true;
    return rig.ask(batch).outcome.code;
  }
  Errc command(Command command) { return ask(with_command(command)); }
  /// The owner goes on asking for so long.
  void keep(Duration time) {
    for (Duration done{}; done < time; done += 100ms) {
      owner->last_request = rig.stage.runtime().now();
      rig.stage.run(100ms);
    }
  }
  void set_moving() {
    ASSERT_EQ(command(Command::enable), Errc::ok);
    ASSERT_EQ(ask(rig.motion()), Errc::ok);
    keep(3s);
    ASSERT_TRUE(rig.turns()) << "as long as its owner lives";
    owner->last_request = rig.stage.runtime().now();
  }
  bool latched() { return rig.axis().has(AxisInput::stop_latched); }

  TableRig rig;
  std::shared_ptr<ClientLife> owner = client(1, "10.0.0.1");
};

class OwnerDies : public testing::TestWithParam<std::tuple<Subject, LeaseAction>> {};

TEST_P(OwnerDies, TheMotorIsStoppedAndLatchedUntilAFreshEnable) {
  const auto& [subject, action] = GetParam();
  OwnedDrive drive(subject, action);
  drive.set_moving();
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
  drive.keep(1s);
  EXPECT_FALSE(drive.rig.turns()) << "its owner's return alone starts nothing";
  EXPECT_EQ(drive.command(Command::enable), Errc::ok);
  EXPECT_FALSE(drive.latched());
  EXPECT_TRUE(drive.rig.powered());
  drive.keep(500ms);
  EXPECT_FALSE(drive.rig.turns()) << "velocity and start are needed anew";
  EXPECT_EQ(drive.ask(drive.rig.motion()), Errc::ok);
  drive.keep(500ms);
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
  OwnedDrive drive(GetParam(), LeaseAction::none);
  drive.set_moving();
  drive.keep(10s);
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
  OwnedDrive drive(GetParam(), LeaseAction::quick_stop);
  ASSERT_EQ(drive.command(Command::enable), Errc::ok);
  drive.keep(2s);
  ASSERT_EQ(drive.command(Command::disable), Errc::ok);
  const std::uint64_t controls = drive.rig.stage.keya(0).controls();
  drive.keep(3s);
  EXPECT_EQ(drive.rig.stage.keya(0).controls(), controls);
  EXPECT_FALSE(drive.rig.powered());
}

INSTANTIATE_TEST_SUITE_P(Table, KeepAliveOnAKeya,
                         testing::Values(Subject::keya_can_speed, Subject::keya_rs232_speed, Subject::keya_rs485_speed,
                                         Subject::keya_canopen_speed, Subject::keya_can_position,
                                         Subject::keya_rs232_position, Subject::keya_rs485_position,
                                         Subject::keya_canopen_position),
                         [](const auto& case_of) { return name(case_of.param); });

}  // namespace
}  // namespace axisgate::test
