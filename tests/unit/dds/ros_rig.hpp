// SPDX-License-Identifier: Apache-2.0
// A ROS 2 node before the shipped core: its topics of an axis, and streams of joint_commands as a control loop writes
// them. Promises a sample each 10 ms. Never decides what is right.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/dds/dds_rig.hpp"

namespace axisgate::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr Duration kPeriod = std::chrono::milliseconds(10);
inline constexpr double kNear = 0.002;  ///< three units of 10000 in a turn: the drive stands within its own window

struct Ros : testing::Test {
  explicit Ros(DdsRigOptions options = {}) : rig(std::move(options)) {}

  [[nodiscard]] double position() { return rig.state().position; }
  void act(dds::RosAction action, AxisNumber axis = kServo) {
    rig.give(dds::RosActionRecord{guid(9), 0, axis, static_cast<std::uint8_t>(action)});
  }
  dds::JointCommandsRecord sample(std::vector<double> positions, std::uint8_t writer = 1) {
    dds::JointCommandsRecord out;
    out.writer = guid(writer);
    out.positions = std::move(positions);
    out.names = {rig.axis(kServo).name, rig.axis(kStepper).name};
    out.names.resize(std::max<std::size_t>(1, std::min<std::size_t>(2, out.positions.size())));
    return out;
  }
  dds::JointCommandsRecord velocities(double velocity) {
    auto out = sample({});
    out.velocities = {velocity};
    return out;
  }
  /// The same sample again and again, as a control loop writes it.
  void stream(const dds::JointCommandsRecord& record, Duration time) {
    for (const Instant end = rig.now() + time; rig.now() < end; rig.run(kPeriod)) rig.give(record);
  }
  bool stream_until(const dds::JointCommandsRecord& record, const std::function<bool()>& done) {
    for (const Instant end = rig.now() + std::chrono::seconds(20); !done() && rig.now() < end; rig.run(kPeriod))
      rig.give(record);
    return done();
  }
  bool enabled() { return rig.axis().has(AxisInput::enabled); }
  /// Enabled, and a stream that is where the axis is.
  void control() {
    act(dds::RosAction::enable);
    ASSERT_TRUE(stream_until(sample({position()}), [&] { return enabled(); }));
    stream(sample({position()}), std::chrono::milliseconds(100));
  }
  bool reaches(double wanted) {
    return stream_until(sample({wanted}), [&] { return std::fabs(position() - wanted) < kNear; });
  }

  DdsRig rig;
};

}  // namespace axisgate::test
