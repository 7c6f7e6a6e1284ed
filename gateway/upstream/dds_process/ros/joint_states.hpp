// SPDX-License-Identifier: Apache-2.0
// All axes as one ROS 2 sensor_msgs/JointState, in the order of their numbers.
// Promises NaN where an axis has no value that is good now, that the first message has all axes there are, and that one
// is due only when a state has come since the last one. Never fills in effort: the motors' rated torque in Nm is not
// known.
#pragma once

#include <ros2_msgs.h>

#include <map>

#include "gateway/upstream/dds_process/topics/to_idl.hpp"

namespace axisgate::dds {

class JointStates {
 public:
  void on_state(const StateRecord& record);
  /// The states of all axes have come.
  void on_all_known() { all_known_ = true; }
  [[nodiscard]] bool due() const { return due_ && all_known_; }
  /// Not due any more.
  [[nodiscard]] sensor_msgs::msg::dds_::JointState_ take(ClockDifference difference);

 private:
  struct Joint {
    std::string name;
    double position = 0;
    double velocity = 0;
  };
  std::map<std::uint16_t, Joint> joints_;  ///< bounded by the axis number
  SteadyNs newest_ = 0;
  bool due_ = false;
  bool all_known_ = false;
};

}  // namespace axisgate::dds
