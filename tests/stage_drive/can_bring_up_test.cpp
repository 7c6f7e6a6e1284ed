// SPDX-License-Identifier: Apache-2.0
// How CANopen drives come up, are lost and come back: what a client sees, and what reaches the wire.
#include <gmock/gmock.h>

#include <map>

#include "tests/stage_drive/can_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

class CanDrive : public testing::TestWithParam<Subject> {};
INSTANTIATE_TEST_SUITE_P(Types, CanDrive, testing::ValuesIn(kCanopenServos), named);

bool is_enabled(const AxisImage& axis) { return axis.has(AxisInput::enabled); }

TEST_P(CanDrive, ComesOnlineWithGoodValuesAndIsNotEnabled) {
  CanRig rig({GetParam()});
  rig.online();
  EXPECT_FALSE(is_enabled(rig.axis()));
  EXPECT_EQ(rig.axis().alarms & (bit(AxisAlarm::no_comm_watchdog) | bit(AxisAlarm::identity_mismatch)), 0U);
  EXPECT_EQ(rig.axis().loss_stop_ms, GetParam() == Subject::jd_can ? kLossNotKnown : 1500) << "as its manual says";
  EXPECT_TRUE(rig.axis()[Quantity::statusword].valid);
  EXPECT_TRUE(rig.axis()[Quantity::position_actual].valid);
  EXPECT_TRUE(rig.becomes_operational());
  EXPECT_THAT(rig.nmt(), ElementsAre("80 01", "01 01"));
}

TEST_P(CanDrive, OnlineAndIdleItIsHardlyAskedAndItsValuesStayGood) {
  CanRig rig({GetParam()});
  rig.online();
  rig.stage.run(3s);
  rig.mark();
  for (int i = 0; i < 100; ++i) {
    rig.stage.run(100ms);
    ASSERT_TRUE(rig.axis()[Quantity::statusword].valid);
    ASSERT_TRUE(rig.axis()[Quantity::position_actual].valid);
  }
  std::map<std::pair<std::uint16_t, int>, int> asked;
  for (const WireRequest& request : rig.requests()) ++asked[{request.index, int{request.sub}}];
  for (const auto& [object, times] : asked)
    EXPECT_LE(times, 11) << std::hex << object.first << ":" << object.second << ": once in confirm_ms at most";
  EXPECT_THAT(rig.writes(), IsEmpty());
}

TEST_P(CanDrive, ARestartAtAnyRequestOfTheBringUpOnlyBeginsItAnew) {
  std::size_t requests = 0;
  {
    CanRig rig({GetParam()});
    rig.online();
    requests = rig.requests().size();
  }
  ASSERT_GT(requests, 20U);
  for (std::size_t at = 1; at <= requests; ++at) {
    SCOPED_TRACE(at);
    CanRig rig({GetParam()});
    ASSERT_TRUE(rig.settles([&] { return rig.requests().size() >= at; }));
    rig.line().restart(0, rig.stage.can_link(0).time_of(rig.stage.runtime().now()));
    ASSERT_TRUE(rig.stage.come_online());
    EXPECT_TRUE(rig.becomes_operational());
    EXPECT_FALSE(is_enabled(rig.axis()));
  }
}

TEST_P(CanDrive, FoundEnabledItIsAdoptedAndNothingIsWrittenUntilItIsDisabled) {
  CanRig first({GetParam()});
  first.online();
  first.enable();
  // Another gateway takes over the running bus: here, the link goes and comes back.
  first.stage.can_link(0).unplug();
  first.stage.run(10ms);
  first.mark();
  first.stage.can_link(0).plug();
  ASSERT_TRUE(first.stage.come_online());
  ASSERT_TRUE(is_enabled(first.axis()));
  EXPECT_NE(first.axis().alarms & bit(AxisAlarm::adopted_running), 0U);
  EXPECT_EQ(first.axis().loss_stop_ms, kLossNotKnown) << "nothing was written to it that makes it notice";
  EXPECT_THAT(first.writes(), IsEmpty());
  EXPECT_THAT(first.nmt(), IsEmpty());
  ASSERT_EQ(first.stage.command(1, Command::disable).outcome.code, Errc::ok);
  ASSERT_TRUE(first.stage.come_online());
  EXPECT_EQ(first.axis().alarms & bit(AxisAlarm::adopted_running), 0U);
  EXPECT_EQ(first.axis().loss_stop_ms, GetParam() == Subject::jd_can ? kLossNotKnown : 1500) << "set up by now";
  EXPECT_THAT(first.nmt(), ElementsAre("80 01", "01 01"));
}

TEST_P(CanDrive, AdoptedAndQuickStoppedItStaysOnlineWhereverTheStopEnds) {
  CanRig rig({GetParam()});
  rig.online();
  rig.enable();
  rig.stage.can_link(0).unplug();
  rig.stage.run(10ms);
  rig.stage.can_link(0).plug();
  ASSERT_TRUE(rig.stage.come_online());
  ASSERT_EQ(rig.stage.command(1, Command::quick_stop).outcome.code, Errc::ok);
  rig.stage.run(1s);
  int changes = 0;
  LinkState before = rig.axis().link_state;
  for (int i = 0; i < 500; ++i) {
    rig.stage.run(2ms);
    changes += rig.axis().link_state != before;
    before = rig.axis().link_state;
  }
  EXPECT_EQ(changes, 0) << "it is set up once, or not at all, but not over and over";
  ASSERT_EQ(rig.stage.command(1, Command::enable).outcome.code, Errc::ok);
}

TEST_P(CanDrive, UnpluggedItIsSeenByItsSilenceAndComesBackByItself) {
  CanRig rig({GetParam(), Subject::leadshine});
  rig.online();
  rig.line().connect(0, false);
  ASSERT_TRUE(rig.settles([&] { return rig.axis(1).link_state == LinkState::offline; }));
  EXPECT_EQ(rig.axis(2).link_state, LinkState::online);
  EXPECT_FALSE(rig.axis(1)[Quantity::position_actual].valid);
  rig.stage.run(30s);
  EXPECT_EQ(rig.axis(2).link_state, LinkState::online);
  rig.line().connect(0, true);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis(1).link_state == LinkState::online; }, 70s));
  EXPECT_FALSE(is_enabled(rig.axis(1)));
}

TEST(CanIdentity, AnotherDriveThanTheConfiguredOneIsReadOnly) {
  GatewayStage::Line line = can_line_of({options_of(Subject::leadshine, 1)}, 1);
  line.can_drives[0].identity = {0x4321, 77, std::nullopt, std::nullopt};
  CanRig rig(std::move(line));
  rig.online();
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::identity_mismatch), 0U);
  EXPECT_TRUE(rig.told("product is 0x1, configured 0x4D"));
  EXPECT_THAT(rig.writes(), IsEmpty());
  EXPECT_THAT(rig.nmt(), IsEmpty());
  EXPECT_EQ(rig.stage.command(1, Command::enable).outcome.code, Errc::identity_mismatch);
  EXPECT_EQ(rig.stage.write(1, Quantity::target_position, 5).outcome.code, Errc::identity_mismatch);
  EXPECT_TRUE(rig.axis()[Quantity::position_actual].valid) << "it is read all the same";
  WriteBatch read;
  read.role = Role::engineer;
  read.object = ObjectRequest{.index = 0x1018, .subindex = 1, .size = 4};
  EXPECT_EQ(rig.stage.ask(1, read).object_data, 0x4321U);
}

TEST(CanMapping, WhatTheDriveDoesNotMapIsPolledAndToldAndAsGood) {
  simulated::LeadshineOptions options;
  options.unmappable = {{0x6064, 0}};
  CanRig rig(can_line_of({options}, 1));
  rig.online();
  EXPECT_TRUE(rig.told("does not take position_actual"));
  rig.enable();
  ASSERT_EQ(rig.stage.write(1, Quantity::target_velocity, 300'000).outcome.code, Errc::ok);
  ASSERT_EQ(rig.stage.command(1, Command::run_velocity).outcome.code, Errc::ok);
  const auto before = rig.axis()[Quantity::position_actual].value;
  rig.stage.run(1s);
  EXPECT_TRUE(rig.axis()[Quantity::position_actual].valid);
  EXPECT_GT(rig.axis()[Quantity::position_actual].value, before);
}

TEST(CanEmergency, AFaultIsShownAndToldWithItsCode) {
  CanRig rig({Subject::leadshine});
  rig.online();
  rig.stage.leadshine(0).inject_fault(0x3150);
  ASSERT_TRUE(rig.settles([&] { return rig.axis().has(AxisInput::fault); }));
  ASSERT_TRUE(rig.settles([&] { return rig.axis()[Quantity::error_code].value == 0x3150; }));
  EXPECT_TRUE(rig.told("EMCY 0x3150"));
}

TEST(CanDuplicateNode, IsToldAndForgottenAMinuteAfterItIsGone) {
  CanRig rig({Subject::leadshine});
  rig.online();
  const std::size_t duplicate = rig.line().add_duplicate(0);
  const auto alarmed = [&] { return (rig.axis().alarms & bit(AxisAlarm::duplicate_node)) != 0; };
  ASSERT_TRUE(rig.stage.run_until(alarmed, 30s));
  EXPECT_TRUE(rig.told("two devices answer as node 1"));
  rig.line().connect(duplicate, false);
  EXPECT_TRUE(rig.stage.run_until([&] { return !alarmed(); }, 90s));
}

}  // namespace
}  // namespace axisgate::test
