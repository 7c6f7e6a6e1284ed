// SPDX-License-Identifier: Apache-2.0
// The state of the gateway and its axes as ROS 2's diagnostic_msgs/DiagnosticArray: one status each, in words.
// Promises a level and a message that change only when something did, the words of gateway/core/words.hpp, and that
// no number of an axis is shown that is not good now. Never knows a topic or a clock.
#pragma once

#include <ros2_msgs.h>

#include <map>
#include <string>

#include "gateway/upstream/dds_process/topics/to_idl.hpp"

namespace axisgate::dds {

class RosDiagnostics {
 public:
  /// `gateway`: its name, or empty.
  explicit RosDiagnostics(std::string gateway) : gateway_(std::move(gateway)) {}

  void on_state(const StateRecord& record);
  void on_gateway(const GatewayRecord& record);
  /// A level or a message is another one since the last message.
  [[nodiscard]] bool changed() const { return changed_; }
  /// Not changed any more. `at`: now.
  [[nodiscard]] diagnostic_msgs::msg::dds_::DiagnosticArray_ take(SteadyNs at, ClockDifference difference);

 private:
  using Status = diagnostic_msgs::msg::dds_::DiagnosticStatus_;
  void put(std::uint16_t number, Status status);
  [[nodiscard]] Status status_of(const std::string& name) const;

  std::string gateway_;
  std::map<std::uint16_t, Status> all_;  ///< by axis; 0: the gateway itself
  bool changed_ = false;
};

}  // namespace axisgate::dds
