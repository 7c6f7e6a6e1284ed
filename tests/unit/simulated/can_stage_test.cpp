// The stage's CAN link: what reaches the gateway, and a whole core against simulated nodes.
#include <gmock/gmock.h>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {
namespace {

using simulated::BusFrame;
using simulated::KincoType;
namespace cob = simulated::cob;

struct CanTold final : can::CanLinkEvents {
  void on_link_up() override { events.emplace_back("up"); }
  void on_link_down(std::string_view why) override { events.emplace_back("down: " + std::string(why)); }
  void on_frame(const can::CanFrame& frame, Instant received) override {
    events.push_back(std::to_string(frame.id));
    frames.push_back(frame);
    at.push_back(received);
  }
  std::vector<std::string> events;
  std::vector<can::CanFrame> frames;
  std::vector<Instant> at;
};

simulated::LeadshineOptions ld2(std::uint8_t node) {
  simulated::LeadshineOptions options;
  options.node = node;
  return options;
}

class CanLinkSimTest : public testing::Test {
 protected:
  CanLinkSimTest() {
    link.line().add(ld2(3));
    link.start(told, {{cob::sdo_reply + 3}, {cob::error_control + 3}});
    runtime.advance_by(Duration{});
  }
  static can::CanFrame read_of(std::uint8_t node) {
    const std::array<Byte, 8> bytes{0x40, 0x41, 0x60, 0, 0, 0, 0, 0};
    return can::data_frame(cob::sdo_request + node, bytes);
  }

  ManualRuntime runtime;
  CanTold told;
  CanLinkSim link{runtime, {}, 1};
};

TEST_F(CanLinkSimTest, AReplyComesWhenTheBusHasCarriedItAndNotFromInsideSend) {
  ASSERT_THAT(told.events, testing::ElementsAre("up"));
  link.send(read_of(3), false);
  EXPECT_EQ(told.frames.size(), 0U);
  runtime.advance_by(std::chrono::milliseconds(10));
  ASSERT_EQ(told.frames.size(), 1U);
  EXPECT_EQ(told.frames[0].data[0], 0x4B);
  // Two frames of 135 bits at 500 kbit/s and the drive's millisecond.
  EXPECT_EQ(told.at[0] - link.sent[0].at, std::chrono::microseconds(1540));
}

TEST_F(CanLinkSimTest, WhatNoFilterLetsThroughIsNotHandedOver) {
  link.line().add(ld2(4));
  link.send(read_of(4), false);
  runtime.advance_by(std::chrono::milliseconds(10));
  EXPECT_EQ(told.frames.size(), 0U);
}

TEST_F(CanLinkSimTest, AnUnpluggedLinkLosesWhatIsUnderWayAndSaysWhy) {
  link.send(read_of(3), false);
  link.unplug();
  runtime.advance_by(std::chrono::milliseconds(10));
  EXPECT_THAT(told.events, testing::ElementsAre("up", testing::HasSubstr("down: ")));
  link.plug();
  runtime.advance_by(std::chrono::milliseconds(10));
  EXPECT_EQ(told.events.back(), "up");
  link.bus_off();
  runtime.advance_by(std::chrono::milliseconds(10));
  EXPECT_THAT(told.events.back(), testing::HasSubstr("bus-off"));
  EXPECT_EQ(link.trouble().bus_offs, 1U);
  EXPECT_EQ(link.trouble().reconnects, 1U);
}

class CanStage : public testing::TestWithParam<const char*> {
 protected:
  static simulated::CanDriveOptions drive_of(std::uint8_t node) {
    if (std::string(GetParam()) == "ld2") return ld2(node);
    simulated::KincoCanDrive drive;
    drive.drive.type = std::string(GetParam()) == "jd" ? KincoType::jd : KincoType::md;
    drive.drive.station = node;
    return drive;
  }
};

TEST_P(CanStage, ADriveComesOnlineEnablesAndStops) {
  GatewayStage stage({can_line_of({drive_of(1)}, 1)});
  ASSERT_TRUE(stage.come_online()) << testing::PrintToString(stage.log());
  EXPECT_EQ(stage.command(1, Command::enable).outcome.code, Errc::ok) << testing::PrintToString(stage.log());
  EXPECT_EQ(stage.command(1, Command::disable).outcome.code, Errc::ok);
  EXPECT_EQ(stage.can_link(0).line().overlapping_requests(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Drives, CanStage, testing::Values("ld2", "jd", "md"),
                         [](const auto& type) { return std::string(type.param); });

std::vector<simulated::CanDriveOptions> one_can_drive_of_each() {
  simulated::KincoCanDrive jd;
  jd.drive.station = 2;
  simulated::KincoCanDrive md;
  md.drive.station = 3;
  md.drive.type = KincoType::md;
  return {ld2(1), jd, md};
}

TEST(CanStageOfAll, AllThreeKindsMoveOnOneBusAndOneRequestIsOutstandingAtMost) {
  GatewayStage stage({can_line_of(one_can_drive_of_each(), 1)});
  ASSERT_TRUE(stage.come_online()) << testing::PrintToString(stage.log());
  for (AxisNumber axis = 1; axis <= 3; ++axis) {
    SCOPED_TRACE(axis);
    ASSERT_EQ(stage.command(axis, Command::enable).outcome.code, Errc::ok);
    ASSERT_EQ(stage.write(axis, Quantity::profile_velocity, 60'000).outcome.code, Errc::ok);
    ASSERT_EQ(stage.write(axis, Quantity::target_position, 5000).outcome.code, Errc::ok);
    ASSERT_EQ(stage.command(axis, Command::move_absolute).outcome.code, Errc::ok);
  }
  EXPECT_TRUE(stage.run_until([&] {
    return stage.leadshine(0, 0).position() == 5000 && stage.drive(0, 1).position() == 5000 &&
           stage.drive(0, 2).position() == 32768;
  }));
  EXPECT_EQ(stage.can_link(0).line().overlapping_requests(), 0U);
  EXPECT_THROW((void)stage.drive(0, 0), std::invalid_argument);
  EXPECT_THROW((void)stage.leadshine(0, 1), std::invalid_argument);
}

TEST(CanStageOfAll, ALinkThatGoesAndARestartedDriveComeBack) {
  GatewayStage stage({can_line_of(one_can_drive_of_each(), 1)});
  ASSERT_TRUE(stage.come_online());
  stage.can_link(0).bus_off();
  EXPECT_TRUE(stage.run_until([&] { return stage.axis(3).link_state == LinkState::link_down; }));
  stage.can_link(0).bus_on();
  EXPECT_TRUE(stage.come_online());
  stage.can_link(0).line().restart(0, stage.can_link(0).time_of(stage.runtime().now()));
  EXPECT_TRUE(stage.run_until([&] { return stage.axis(1).link_state != LinkState::online; }));
  EXPECT_EQ(stage.axis(2).link_state, LinkState::online);
  EXPECT_TRUE(stage.come_online());
}

}  // namespace
}  // namespace axisgate::test
