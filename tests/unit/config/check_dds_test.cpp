// SPDX-License-Identifier: Apache-2.0
// What `axisgate check` says of the DDS server, and of DDS clients as masters of an axis.
#include "gateway/check/check_sections.hpp"

#include <gmock/gmock.h>

#include "gateway/check/check.hpp"

namespace axisgate::config {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::Not;

class CheckDds : public ::testing::Test {
 protected:
  CheckDds() {
    settings.emplace();
    settings->units.resize(8);
    axis.number = 3;
    budget.command_wait = milliseconds(20);
    budget.command_wait_unresponsive = milliseconds(120);
  }
  std::string said() {
    std::string out = check::dds_title(*settings) + "\n";
    check::add_lines(out, check::dds_lines(*settings));
    return out;
  }
  std::string of_the_axis() {
    std::string out;
    check::add_lines(out, check::dds_master_lines(*settings, axis, budget));
    return out;
  }
  std::optional<dds::DdsSettings> settings;
  AxisConfig axis;
  BusBudget budget;
};

TEST_F(CheckDds, TellsWhereItPublishesAndHowOften) {
  EXPECT_THAT(said(), HasSubstr("DDS: domain 0 on lo\n"));
  EXPECT_THAT(said(),
              HasSubstr("samples         of an axis at most 100 a second (on change, 10 ms apart), at least one "
                        "each 1000 ms; with 8 axes at most 800 a second in all\n"));
  settings->domain = 9;
  settings->interfaces = {"eth0", "eth1"};
  settings->min_period = milliseconds(3);
  settings->units.resize(1);
  EXPECT_THAT(said(), HasSubstr("DDS: domain 9 on eth0, eth1\n"));
  EXPECT_THAT(said(), HasSubstr("333.3 a second (on change, 3 ms apart)"));
  EXPECT_THAT(said(), HasSubstr("with 1 axis at most 333.3 a second in all\n"));
}

TEST_F(CheckDds, TellsWhichTopicsThereAre) {
  EXPECT_THAT(said(), HasSubstr("topics          axisgate/axis_state, axis_event, gateway_state\n"));
  settings->ros2 = true;
  settings->commands = true;
  EXPECT_THAT(said(), HasSubstr("gateway_state, command_reply, object_reply\n"));
  EXPECT_THAT(said(),
              HasSubstr("ROS 2           /joint_states and /diagnostics, /joint_commands, and of each axis enable"));
  EXPECT_THAT(said(), HasSubstr("a stream of positions begins within 0.01 rad of its axis\n"));
  settings->gateway.name = "cell_7";
  EXPECT_THAT(said(), HasSubstr("ROS 2           /cell_7/joint_states and /diagnostics, /cell_7/joint_commands, and"));
  settings->commands = false;
  EXPECT_THAT(said(), HasSubstr("ROS 2           /cell_7/joint_states and /diagnostics\n"));
}

TEST_F(CheckDds, TellsTheTopicsOfAnAxisWhoseNameIsNoneToRos2) {
  settings->ros2 = true;
  settings->commands = true;
  settings->gateway.name = "cell_7";
  axis.name = "x-axis 1";
  EXPECT_THAT(of_the_axis(), HasSubstr("joint \"x-axis 1\"; its topics begin with /cell_7/x_axis_1/\n"));
  axis.lease.on = false;
  EXPECT_THAT(of_the_axis(), HasSubstr("/cell_7/x_axis_1/\n"));
  axis.name = "x_axis";
  EXPECT_EQ(of_the_axis(), "");
  settings->ros2 = false;
  axis.name = "x-axis";
  EXPECT_EQ(of_the_axis(), "");
}

TEST_F(CheckDds, TellsHowParticipantsFindEachOther) {
  EXPECT_THAT(said(), HasSubstr("network         UDP; participants find each other by multicast\n"));
  settings->shared_memory = true;
  settings->peers = {"10.0.0.2", "10.0.0.3"};
  settings->qos_file = "a.xml";
  EXPECT_THAT(said(), HasSubstr("UDP and shared memory; participants are looked for at 10.0.0.2, 10.0.0.3, nothing is "
                                "multicast; profiles in a.xml may change all of this\n"));
  settings->discovery_servers = {"10.0.0.4:11811"};
  EXPECT_THAT(said(), HasSubstr("found through discovery server 10.0.0.4:11811"));
}

TEST_F(CheckDds, TellsWhoMayCommand) {
  EXPECT_THAT(said(), HasSubstr("commands        off: DDS clients read, and own nothing\n"));
  settings->commands = true;
  settings->role = Role::operator_;
  EXPECT_THAT(said(),
              HasSubstr("commands        every participant of domain 0 that reaches lo may command as operator: "
                        "DDS has no passwords\n"));
}

TEST_F(CheckDds, TellsWhatCountsAsAliveForADdsClient) {
  settings->commands = true;
  EXPECT_THAT(of_the_axis(),
              HasSubstr("DDS client      kept by its samples, axisgate/heartbeat, and its liveliness where that is "
                        "MANUAL_BY_TOPIC with a finite lease\n"));
  axis.lease.renew = LeaseRenewal::write;
  EXPECT_THAT(of_the_axis(), HasSubstr("its samples for this axis; neither heartbeat nor liveliness count\n"));
  EXPECT_THAT(of_the_axis(), Not(HasSubstr("outlives")));
  axis.lease.renew = LeaseRenewal::heartbeat;
  EXPECT_THAT(of_the_axis(), HasSubstr("kept by axisgate/heartbeat, and its liveliness where that is MANUAL_BY_TOPIC"));
}

TEST_F(CheckDds, TellsTheWorstTimeFromADeadDdsClientToTheStop) {
  settings->commands = true;
  axis.lease.timeout = milliseconds(1500);
  EXPECT_THAT(of_the_axis(), HasSubstr("dead: the stop comes at most 1620 ms after its last sign of life, and its "
                                       "liveliness outlives it by the lease that it has stated\n"));
  EXPECT_THAT(of_the_axis(), HasSubstr("4620 ms where axisgate-dds dies as well\n"));
}

TEST_F(CheckDds, SaysNothingOfDdsClientsWhereTheyOwnNothing) {
  EXPECT_EQ(of_the_axis(), "");
  settings->commands = true;
  axis.lease.on = false;
  EXPECT_EQ(of_the_axis(), "");
  axis.lease.on = true;
  settings->role = Role::viewer;
  EXPECT_EQ(of_the_axis(), "");
}

TEST_F(CheckDds, IsPartOfTheReportWhereItIsConfigured) {
  LoadedConfig loaded;
  loaded.config.file = "a.json";
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("DDS")));
  loaded.config.dds = settings;
  EXPECT_THAT(check::report(loaded).text, HasSubstr("\nDDS: domain 0 on lo\n  topics "));
}

}  // namespace
}  // namespace axisgate::config
