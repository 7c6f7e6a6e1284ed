// SPDX-License-Identifier: Apache-2.0
// What `axisgate check` says of the death of an axis's masters, and the warnings that go with it.
#include "gateway/check/check_sections.hpp"

#include <gmock/gmock.h>

#include "gateway/check/check.hpp"

namespace axisgate::config {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// One drive of two motors on a bus where a command waits at most 20 ms, 120 ms beside an unresponsive drive.
class Masters : public ::testing::Test {
 protected:
  Masters() {
    loaded.config.modbus_tcp.emplace_back();
    BusConfig bus;
    bus.adapter = "kinco-serial";
    bus.timeout = milliseconds(100);
    DriveConfig drive;
    for (const AxisNumber number : {AxisNumber{1}, AxisNumber{2}}) {
      drive.axes.emplace_back();
      drive.axes.back().number = number;
    }
    bus.drives.push_back(drive);
    loaded.config.buses.push_back(bus);

    model::DriveModel model;
    model.protocol = "kinco-serial";
    for (int i = 0; i < 2; ++i) {
      model::AxisModel axis;
      axis.binding_of.fill(-1);
      axis.commands[static_cast<std::size_t>(Command::quick_stop)].emplace();
      axis.commands[static_cast<std::size_t>(Command::halt)].emplace();
      axis.modes = {{3, 3}};
      model.axes.push_back(axis);
    }
    loaded.models.push_back({model});
    budgets.emplace_back();
    budgets[0].command_wait = milliseconds(20);
    budgets[0].command_wait_unresponsive = milliseconds(120);
  }

  AxisConfig& config(std::size_t axis = 0) { return loaded.config.buses[0].drives[0].axes[axis]; }
  model::DriveModel& drive() { return loaded.models[0][0]; }

  std::string said() {
    std::string out;
    check::add_lines(out, check::master_lines({config(), drive().axes[0], drive(), budgets[0], loaded.config.dds}));
    return out;
  }
  std::string warned() {
    std::string out;
    for (const std::string& line : check::lease_warnings(loaded, budgets)) out += line + "\n";
    return out;
  }

  LoadedConfig loaded;
  std::vector<BusBudget> budgets;
};

TEST_F(Masters, TellsWhoCountsAsAlive) {
  EXPECT_THAT(said(), HasSubstr("lease           2000 ms, kept by any request of its owner, reads too\n"));
  config().lease.renew = LeaseRenewal::write;
  EXPECT_THAT(said(), HasSubstr("kept by a write of its owner to this axis\n"));
  config().number = 5;
  config().lease.renew = LeaseRenewal::heartbeat;
  EXPECT_THAT(said(), HasSubstr("kept by a changed number that its owner writes to register 556 or 8\n"));
}

TEST_F(Masters, TellsTheTimeFromADeadProgramToTheStop) {
  config().lease.timeout = milliseconds(1500);
  EXPECT_THAT(said(),
              HasSubstr("program dies    quick stop at most 1520 ms after its last sign of life, 1620 ms beside "
                        "an unresponsive drive\n"));
  config().lease.on_expiry = LeaseAction::halt;
  EXPECT_THAT(said(), HasSubstr("halt at most 1520 ms"));
}

TEST_F(Masters, RecommendsTheHeartbeatWhereAStoppedPlcMayGoOnScanning) {
  const std::string recommended = "\"renew\": \"heartbeat\" notices that";
  EXPECT_THAT(said(), HasSubstr(recommended));
  config().lease.renew = LeaseRenewal::write;
  EXPECT_THAT(said(), HasSubstr(recommended));
  config().lease.renew = LeaseRenewal::heartbeat;
  EXPECT_THAT(said(), Not(HasSubstr(recommended)));
}

TEST_F(Masters, SaysThatTheAxisGoesOnWhereNothingIsDone) {
  config().lease.on_expiry = LeaseAction::none;
  EXPECT_THAT(said(), AllOf(HasSubstr("THE AXIS GOES ON; after 2000 ms another client may have it"),
                            Not(HasSubstr("the stop"))));
  config().lease.on = false;
  EXPECT_THAT(said(),
              AllOf(HasSubstr("lease           null: nobody owns it\n"), HasSubstr("THE AXIS GOES ON: nobody")));
}

TEST_F(Masters, TellsWhatTheStopIsOnThisDrive) {
  EXPECT_THAT(said(), HasSubstr("the stop        it decelerates and stands energised\n"));
  config().stop_without_torque = true;
  EXPECT_THAT(said(), HasSubstr("it decelerates, then the torque goes\n"));
  config().stop_without_torque = false;
  drive().objects.emplace_back();
  drive().objects.back().name = "quick_stop_option";
  EXPECT_THAT(said(), HasSubstr("as its quick_stop_option (605Ah) says"));
  config().lease.on_expiry = LeaseAction::disable;
  EXPECT_THAT(said(), HasSubstr("the torque goes at once"));
  drive().axes[0].virtual_axis.emplace().gate_only = true;
  EXPECT_THAT(said(), HasSubstr("it decelerates and stays energised: no bus takes its torque away"));
}

TEST_F(Masters, TellsInWhichModesAStopIsWithoutARamp) {
  config().stop_without_torque = true;
  model::AxisModel& axis = drive().axes[0];
  axis.virtual_axis.emplace();
  model::Step off;
  model::Step wait;
  wait.verb = model::Step::Verb::wait;
  model::CommandDef& stop = *axis.commands[static_cast<std::size_t>(Command::quick_stop)];
  stop.steps = {off, wait};
  EXPECT_THAT(said(), HasSubstr("the stop        the torque goes at once\n"));
  stop.variants.push_back({{3}, {off, wait, off, wait}});
  EXPECT_THAT(said(), HasSubstr("the stop        it decelerates, then the torque goes\n"));
  axis.modes = {{1, 1}, {3, 3}};
  EXPECT_THAT(said(),
              HasSubstr("in mode 3 it decelerates, then the torque goes; in its others the torque goes at once\n"));
}

TEST_F(Masters, AHaltThatIsAQuickStopInSomeModesSaysSo) {
  config().lease.on_expiry = LeaseAction::halt;
  EXPECT_THAT(said(), HasSubstr("it decelerates and stays enabled\n"));
  drive().axes[0].commands[static_cast<std::size_t>(Command::halt)]->quick_stop_otherwise = true;
  config().stop_without_torque = true;
  EXPECT_THAT(said(), HasSubstr("in modes without halt a quick stop: it decelerates, then the torque goes"));
}

TEST_F(Masters, NamesTheAlarmOfADriveThatDoesNotNoticeADeadGateway) {
  EXPECT_THAT(said(), AllOf(HasSubstr("THE DRIVE DOES NOT STOP BY ITSELF on kinco-serial"),
                            HasSubstr("alarm no_comm_watchdog")));
  drive().stops_by_itself = true;
  drive().loss_text = "it disables itself after 1000 ms";
  EXPECT_THAT(said(),
              AllOf(HasSubstr("WHETHER IT STOPS BY ITSELF IS NOT KNOWN: the drive notices by itself: it disables"),
                    Not(HasSubstr("no_comm_watchdog"))));
  drive().loss_after = milliseconds(1000);
  EXPECT_THAT(said(),
              HasSubstr("gateway dies    it begins to stop by itself within 1000 ms: the drive notices by itself: "
                        "it disables itself after 1000 ms\n"));
}

TEST_F(Masters, TellsWhatKeepsADriveEnabledAndForHowLong) {
  EXPECT_THAT(said(), Not(HasSubstr("kept alive")));
  drive().keep_alive = milliseconds(300);
  EXPECT_THAT(said(), HasSubstr("kept alive      in no mode"));
  drive().axes[0].keep_alive = {{3, 0}};
  EXPECT_THAT(said(), HasSubstr("kept alive      each 300 ms in mode 3, while it is enabled and its lease lives\n"));
  drive().axes[0].modes = {{1, 1}, {3, 3}};
  EXPECT_THAT(said(), HasSubstr("the drive's watchdog ends a motion"));
  config().lease.on = false;
  EXPECT_THAT(said(), HasSubstr("in mode 3, while it is enabled\n"));
}

TEST_F(Masters, SaysOfAVerticalAxisWhereItsLoadCouldFall) {
  EXPECT_THAT(said(), Not(HasSubstr("vertical")));
  config().vertical = true;
  EXPECT_THAT(said(),
              AllOf(HasSubstr("its brake must hold the load wherever"), HasSubstr("no register shows the brake")));
  config().stop_without_torque = true;
  drive().axes[0].supported = bit(Quantity::digital_outputs);
  EXPECT_THAT(said(), AllOf(HasSubstr("A QUICK STOP ENDS WITHOUT TORQUE"), HasSubstr("digital_outputs bit 0")));
}

TEST_F(Masters, WarnsOnceOfAllAxesThatNobodyWatches) {
  EXPECT_THAT(warned(), Not(HasSubstr("nobody notices")));
  config(1).lease.on = false;
  EXPECT_THAT(warned(),
              HasSubstr("axis 2: \"lease\": null: nobody notices that the client is dead, the motor goes on\n"));
  config(0).lease.on = false;
  EXPECT_THAT(warned(), HasSubstr("axes 1, 2: \"lease\": null"));
}

TEST_F(Masters, WarnsThatAKeepAliveOutlivesTheClientWhereThereIsNoLease) {
  drive().keep_alive = milliseconds(300);
  for (model::AxisModel& axis : drive().axes) axis.keep_alive = {{3, 0}};
  config(1).lease.on = false;
  EXPECT_THAT(warned(), HasSubstr("axis 2: \"lease\": null: nobody notices that the client is dead, and the keep-alive "
                                  "runs as long as the axis is enabled"));
}

TEST_F(Masters, WarnsOfALeaseThatEndsBeforeAWriteIsAnswered) {
  config().lease.timeout = milliseconds(900);
  EXPECT_THAT(warned(), Not(HasSubstr("shorter than")));
  config().lease.timeout = milliseconds(899);
  EXPECT_THAT(warned(),
              HasSubstr("axis 1: its lease of 899 ms is shorter than the reply_deadline_ms of a listener (900 ms)"));
  config().lease.on = false;
  EXPECT_THAT(warned(), Not(HasSubstr("shorter than")));
}

TEST_F(Masters, WarnsOfALeaseThatTheBusItselfCouldUseUp) {
  budgets[0].command_wait_unresponsive = milliseconds(700);
  EXPECT_THAT(warned(),
              HasSubstr("axis 1: its lease of 2000 ms is shorter than 3 of the longest waits for its bus (2100 ms)"));
  config().lease.timeout = milliseconds(2100);
  EXPECT_THAT(warned(), Not(HasSubstr("axis 1: its lease")));
}

TEST_F(Masters, WarnsWhereAnUnresponsiveDriveCouldMakeTheKeepAliveOfOthersLate) {
  loaded.config.buses[0].name = "agv";
  loaded.models[0].push_back(drive());
  loaded.config.buses[0].drives.push_back(loaded.config.buses[0].drives[0]);
  budgets[0].kept_alive.reads = 4;
  budgets[0].kept_alive.period = milliseconds(120);
  EXPECT_THAT(warned(), Not(HasSubstr("bus agv")));
  budgets[0].kept_alive.period = milliseconds(100);
  EXPECT_THAT(warned(),
              HasSubstr("bus agv: beside an unresponsive drive a command may wait 120 ms, longer than the 100 ms"));
  loaded.models[0].pop_back();
  EXPECT_THAT(warned(), Not(HasSubstr("bus agv"))) << "no other drive can be unresponsive";
}

TEST_F(Masters, HintsAtOneShotToolsWhereEachConnectionIsAClient) {
  EXPECT_THAT(warned(), HasSubstr("on 127.0.0.1:1502 each connection is a client: one-shot tools such as mbpoll"));
  loaded.config.modbus_tcp[0].client_is_address = true;
  EXPECT_THAT(warned(), Not(HasSubstr("one-shot tools")));
  loaded.config.modbus_tcp[0].client_is_address = false;
  config(0).lease.on = false;
  config(1).lease.on = false;
  EXPECT_THAT(warned(), Not(HasSubstr("one-shot tools"))) << "nothing runs out behind them";
}

TEST_F(Masters, SaysThatTwoProgramsOfOneAddressAreOneClientWhateverRenews) {
  EXPECT_THAT(warned(), Not(HasSubstr("two programs of one computer")));
  loaded.config.modbus_tcp[0].client_is_address = true;
  const std::string one = "on 127.0.0.1:1502 two programs of one computer are one client (\"client\": \"address\"): ";
  EXPECT_THAT(warned(), HasSubstr(one + "an HMI that writes from the PLC's computer keeps "));
  config(0).lease.renew = config(1).lease.renew = LeaseRenewal::heartbeat;
  EXPECT_THAT(warned(), HasSubstr(one + "what one of them owns the other commands too"));
  config(0).lease.on = config(1).lease.on = false;
  EXPECT_THAT(warned(), Not(HasSubstr("two programs of one computer"))) << "nobody owns anything";
}

}  // namespace
}  // namespace axisgate::config
