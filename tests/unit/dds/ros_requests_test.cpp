// SPDX-License-Identifier: Apache-2.0
// ROS 2 nodes before the shipped core: streams of joint_commands, the topics of an axis, and what the motor does.
#include <gmock/gmock.h>

#include "gateway/upstream/dds_link/ros_names.hpp"
#include "tests/unit/dds/ros_rig.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using dds::RosAction;
using testing::Contains;
using testing::HasSubstr;

TEST_F(Ros, AStreamEnablesNothing) {
  stream(sample({1}), 3s);
  stream(sample({position()}), 3s);
  EXPECT_FALSE(enabled());
  EXPECT_FALSE(rig.turns());
}

TEST_F(Ros, NothingResumesAfterAStopByAnybody) {
  const auto stranger = rig.writer(3);
  for (const bool latches : {true, false}) {
    control();
    const double begun = position();
    ASSERT_TRUE(stream_until(sample({begun + 500 * kTurn}), [&] { return std::fabs(position() - begun) > 1; }));
    EXPECT_EQ(rig.ask(stranger, latches ? 3 : 4).result, kDone);
    stream(sample({begun + 500 * kTurn}), 2s);
    EXPECT_FALSE(rig.turns());
    const double stopped = position();
    act(RosAction::enable);
    stream(sample({begun + 500 * kTurn}), 1s);
    EXPECT_TRUE(enabled());
    EXPECT_NEAR(position(), stopped, 1e-3);
    act(RosAction::disable);
    ASSERT_TRUE(rig.run_until([&] { return !enabled(); }));
  }
}

TEST_F(Ros, SilenceAboutOneAxisStopsThatOne) {
  control();
  ASSERT_TRUE(stream_until(sample({position() + 500 * kTurn}), [&] { return rig.turns(); }));
  stream(sample({kNan, 0}), 3s);
  EXPECT_FALSE(rig.turns());
  EXPECT_TRUE((rig.state().alarms & bit(AxisAlarm::stop_latched)) != 0);
}

TEST_F(Ros, WhatCannotBeMeantIsRefusedWhole) {
  control();
  const double before = position();
  auto twice = sample({before + 1, before + 1});
  twice.names[1] = twice.names[0];
  auto endless = sample({before + 1, std::numeric_limits<double>::infinity()});
  auto efforts = sample({before + 1});
  efforts.efforts = 2;
  auto many = sample({before + 1});
  many.names.resize(dds::kMaxJoints + 1);
  many.positions.resize(dds::kMaxJoints + 1);
  auto unlike = sample({before + 1});
  unlike.names.emplace_back("another");
  for (const auto& each : {twice, endless, efforts, many}) {
    stream(each, 200ms);
    EXPECT_NEAR(position(), before, 1e-3);
  }
  stream(unlike, 3s);
  EXPECT_NEAR(position(), before, 1e-3);
  EXPECT_TRUE((rig.state().alarms & bit(AxisAlarm::stop_latched)) != 0) << "it is no sign of life";
  EXPECT_THAT(rig.told, Contains(HasSubstr("is refused as a whole: it names 2 joints, with 1 positions")));
  EXPECT_THAT(rig.told, Contains(HasSubstr("twice")));
  EXPECT_THAT(rig.told, Contains(HasSubstr("infinite")));
  EXPECT_THAT(rig.told, Contains(HasSubstr("2 efforts")));
  EXPECT_THAT(rig.told, Contains(HasSubstr("more than 512 joints")));
}

TEST_F(Ros, AJointThatIsNoAxisIsToldOnce) {
  auto record = sample({position()});
  record.names[0] = "gripper";
  stream(record, 5s);
  EXPECT_EQ(std::ranges::count_if(rig.told, [](const auto& line) { return line.find("gripper") != line.npos; }), 1);
}

TEST_F(Ros, PositionsBeatVelocities) {
  control();
  auto both = sample({position() + 1});
  both.velocities = {100};
  const double wanted = position() + 1;
  ASSERT_TRUE(stream_until(both, [&] { return std::fabs(position() - wanted) < 0.001; }));
  stream(both, 1s);
  EXPECT_NEAR(position(), wanted, 0.001);
}

TEST_F(Ros, AnAxisOfAnotherClientIsNotTaken) {
  const auto plc = client(1, "10.0.0.1");
  WriteBatch enable;
  enable.command = Command::enable;
  ASSERT_EQ(rig.modbus(plc, enable), Errc::ok);
  const double before = position();
  for (int i = 0; i < 50; ++i) {
    plc->last_request = rig.now();
    stream(sample({before}), 20ms);
    stream(sample({before + 1}), 20ms);
  }
  EXPECT_NEAR(position(), before, 1e-3);
  EXPECT_TRUE(rig.axis().lease.owned_by(1));
  act(RosAction::quick_stop);
  ASSERT_TRUE(rig.run_until([&] { return !enabled(); })) << "a stop is open to everybody";
}

TEST_F(Ros, AStreamInStepAfterTheGatewaysOwnRestartGoesOn) {
  control();
  ASSERT_TRUE(reaches(kTurn));
  rig.link_down();
  rig.run(1s);
  rig.link_up();
  EXPECT_TRUE(reaches(2 * kTurn)) << "the writer is the same one";
}

struct RosInMetres : Ros {
  RosInMetres() : Ros(options()) {}
  static DdsRigOptions options() {
    DdsRigOptions out;
    out.settings.units = {{kServo, Rational(10000), Rational(1, 200)}};
    return out;
  }
};

TEST_F(RosInMetres, TheToleranceIsThatOfTheMotor) {
  control();
  const double before = position();
  stream(sample({before + 0.009}, 2), 2s);  // nearly two turns of a 5 mm spindle
  EXPECT_NEAR(position(), before, 1e-6);
  EXPECT_THAT(rig.told, Contains(HasSubstr("positions act once they were within")));
  stream(sample({before + 0.000007}, 2), 200ms);
  EXPECT_TRUE(stream_until(sample({before + 0.009}, 2), [&] { return position() > before + 0.0089; }));
}

struct RosWithAge : Ros {
  RosWithAge() : Ros(options()) {}
  static DdsRigOptions options() {
    DdsRigOptions out;
    out.settings.max_age = 500ms;
    return out;
  }
  void act_written(RosAction action, Duration ago) {
    rig.give(dds::RosActionRecord{guid(9), (rig.now() - ago).time_since_epoch().count(), kServo,
                                  static_cast<std::uint8_t>(action)});
  }
  void stream_written(Duration ago, Duration time) {
    for (const Instant end = rig.now() + time; rig.now() < end; rig.run(kPeriod)) {
      auto record = sample({position()});
      record.written = (rig.now() - ago).time_since_epoch().count();
      rig.give(record);
    }
  }
};

TEST_F(RosWithAge, WhatIsOldStartsNothingAndIsNoSignOfLifeButAStopIsAStop) {
  act_written(RosAction::enable, 600ms);
  stream_written(0ms, 500ms);
  EXPECT_FALSE(enabled());
  act_written(RosAction::enable, 0ms);
  stream_written(0ms, 3s);
  EXPECT_TRUE(enabled());
  act_written(RosAction::quick_stop, 10s);
  stream_written(0ms, 500ms);
  EXPECT_TRUE((rig.state().alarms & bit(AxisAlarm::stop_latched)) != 0);
  act_written(RosAction::enable, 0ms);
  stream_written(0ms, 500ms);
  ASSERT_TRUE(enabled());
  stream_written(600ms, 3s);
  EXPECT_TRUE((rig.state().alarms & bit(AxisAlarm::stop_latched)) != 0) << "its lease has run out";
  EXPECT_THAT(rig.told, Contains(HasSubstr("older than max_age_ms")));
}

TEST_F(RosWithAge, AStaleStopIsNoSignOfLife) {
  act_written(RosAction::enable, 0ms);
  stream_written(0ms, 500ms);
  ASSERT_TRUE(enabled());
  rig.run(100ms);
  const Instant before = rig.axis().lease.last_sign();
  act_written(RosAction::quick_stop, 10s);
  EXPECT_EQ(rig.axis().lease.last_sign(), before);
}

// The gateway stood still. Where clocks differ, max_age_ms does not tell.
TEST_F(Ros, WhatHasWaitedTooLongForTheGatewayIsNotCarriedOutUnlessItIsAStop) {
  const auto before = [&](Duration time) { return (rig.now() - time).time_since_epoch().count(); };
  const auto act_received = [&](RosAction action, Duration ago) {
    rig.give(dds::RosActionRecord{guid(9), 0, kServo, static_cast<std::uint8_t>(action), before(ago)});
    rig.run(200ms);
  };
  const auto stream_received = [&](double wanted, Duration ago, Duration time) {
    for (const Instant end = rig.now() + time; rig.now() < end; rig.run(kPeriod)) {
      auto record = sample({wanted});
      record.received = before(ago);
      rig.give(record);
    }
  };
  act_received(RosAction::enable, 501ms);
  EXPECT_FALSE(enabled());
  act_received(RosAction::enable, 500ms);
  ASSERT_TRUE(enabled());
  const double begun = position();
  stream_received(begun, 0ms, 200ms);
  stream_received(begun + 7, 501ms, 1s);
  EXPECT_NEAR(position(), begun, kNear);
  stream_received(begun, 0ms, 200ms);
  act_received(RosAction::quick_stop, 10s);
  EXPECT_TRUE((rig.state().alarms & bit(AxisAlarm::stop_latched)) != 0);
  act_received(RosAction::enable, 0ms);
  ASSERT_TRUE(enabled());
  stream_received(begun, 501ms, 3s);
  EXPECT_TRUE((rig.state().alarms & bit(AxisAlarm::stop_latched)) != 0) << "no sign of life";
}

struct RosWithWrites : Ros {
  RosWithWrites() : Ros(options()) {}
  static DdsRigOptions options() {
    DdsRigOptions out;
    out.lease.renew = LeaseRenewal::write;
    return out;
  }
};

TEST_F(RosWithWrites, SamplesAreWrites) {
  control();
  const double before = position();
  stream(sample({before}), 10s);
  EXPECT_TRUE(enabled());
  EXPECT_TRUE(reaches(before + 1));
}

}  // namespace
}  // namespace axisgate::test
