// SPDX-License-Identifier: Apache-2.0
// The names under which ROS 2 nodes find this gateway: what its DDS topics are called on the wire (prefix "rt/",
// rmw_dds_common). Promises names that ROS 2 takes: letters, digits and single underscores, no digit in front.
// Never makes a topic, and never promises that two axes have two names: the configuration is checked for that.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace axisgate::dds {

/// What a node asks of one axis by a topic of its own.
enum class RosAction : std::uint8_t { enable = 0, disable = 1, quick_stop = 2, fault_reset = 3, home = 4 };

inline constexpr std::string_view kRosDiagnostics = "rt/diagnostics";  ///< one for all, as ROS 2 has it

/// An axis's name as a part of a topic's: "x-axis 2" is x_axis_2, "2nd" is _2nd.
[[nodiscard]] std::string ros_token(std::string_view name);
/// "rt/cell_7/joint_states"; without a name of the gateway "rt/joint_states".
[[nodiscard]] std::string ros_topic(std::string_view gateway, std::string_view topic);
/// "rt/cell_7/lift/enable".
[[nodiscard]] std::string ros_axis_topic(std::string_view gateway, std::string_view axis, std::string_view topic);

}  // namespace axisgate::dds
