// SPDX-License-Identifier: Apache-2.0
// What ROS 2 nodes call the topics of a gateway.
#include "gateway/upstream/dds_link/ros_names.hpp"

#include <gtest/gtest.h>

namespace axisgate::dds {
namespace {

TEST(RosNames, AreThoseOfTheAxesWhereRos2TakesThem) {
  EXPECT_EQ(ros_axis_topic("cell_7", "lift", "enable"), "rt/cell_7/lift/enable");
  EXPECT_EQ(ros_axis_topic("", "Lift_2", "home"), "rt/Lift_2/home");
  EXPECT_EQ(ros_topic("", "joint_states"), "rt/joint_states");
  EXPECT_EQ(ros_topic("cell_7", "joint_commands"), "rt/cell_7/joint_commands");
}

TEST(RosNames, HaveLettersDigitsAndSingleUnderscoresAlone) {
  EXPECT_EQ(ros_token("axis 1"), "axis_1");
  EXPECT_EQ(ros_token("x-axis (left)"), "x_axis_left_");
  EXPECT_EQ(ros_token("2nd"), "_2nd");
  EXPECT_EQ(ros_token("H\xC3\xB6he"), "H_he");
  EXPECT_EQ(ros_token(""), "_");
}

}  // namespace
}  // namespace axisgate::dds
