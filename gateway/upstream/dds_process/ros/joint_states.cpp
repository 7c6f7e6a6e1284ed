// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/ros/joint_states.hpp"

#include <algorithm>
#include <limits>

namespace axisgate::dds {
namespace {

// Bits of `valid` (register map): without it the value is the last one that was good.
constexpr std::uint32_t kPosition = 1U << 2U, kVelocity = 1U << 3U;

double value_if(bool valid, double value) { return valid ? value : std::numeric_limits<double>::quiet_NaN(); }

}  // namespace

void JointStates::on_state(const StateRecord& record) {
  // The last state of an axis that a reload has taken away has no name.
  if (record.name.empty()) {
    joints_.erase(record.axis);
  } else {
    joints_[record.axis] = {record.name, value_if((record.valid & kPosition) != 0, record.position),
                            value_if((record.valid & kVelocity) != 0, record.velocity)};
  }
  newest_ = std::max(newest_, record.at);
  due_ = true;
}

sensor_msgs::msg::dds_::JointState_ JointStates::take(ClockDifference difference) {
  due_ = false;
  sensor_msgs::msg::dds_::JointState_ message;
  const axisgate::Time stamp = to_time(newest_, difference);
  message.header().stamp().sec(stamp.sec());
  message.header().stamp().nanosec(stamp.nanosec());
  for (const auto& [axis, joint] : joints_) {
    message.name().push_back(joint.name);
    message.position().push_back(joint.position);
    message.velocity().push_back(joint.velocity);
  }
  return message;
}

}  // namespace axisgate::dds
