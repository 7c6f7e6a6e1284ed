// SPDX-License-Identifier: Apache-2.0
// ROS 2's messages for fast_peer: samples as text, and from text.
// Promises every member under its IDL name. Never makes a topic.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "ros2_msgs.h"
#include "tests/dds_peers/lines.h"
#include "tests/dds_peers/members.h"

namespace ros2_text {

inline void put_text(const char* name, const std::string& text) { ::put_text(name, text.c_str()); }

#define ROS2_PUT(kind, member) put_##kind(#member, sample.member());
#define ROS2_TAKE(kind, member) sample.member(value_##kind(line, #member));

inline void put_header(const char* name, const std_msgs::msg::dds_::Header_& header) {
  begin_object(name);
  begin_object("stamp");
  put_i64("sec", header.stamp().sec());
  put_u64("nanosec", header.stamp().nanosec());
  end_object();
  put_text("frame_id", header.frame_id());
  end_object();
}
inline void put_texts(const char* name, const std::vector<std::string>& texts) {
  begin_list(name);
  for (const auto& text : texts) put_text("", text);
  end_list();
}
inline void put_numbers(const char* name, const std::vector<double>& numbers) {
  begin_list(name);
  for (const double number : numbers) put_f64("", number);
  end_list();
}

inline void put_pairs(const char* name, const std::vector<diagnostic_msgs::msg::dds_::KeyValue_>& pairs) {
  begin_list(name);
  for (const auto& sample : pairs) {
    begin_object("");
    KEY_VALUE_MEMBERS(ROS2_PUT)
    end_object();
  }
  end_list();
}
inline void put_statuses(const char* name, const std::vector<diagnostic_msgs::msg::dds_::DiagnosticStatus_>& statuses) {
  begin_list(name);
  for (const auto& sample : statuses) {
    begin_object("");
    DIAGNOSTIC_STATUS_MEMBERS(ROS2_PUT)
    end_object();
  }
  end_list();
}

inline void show(const sensor_msgs::msg::dds_::JointState_& sample) { JOINT_STATE_MEMBERS(ROS2_PUT) }
inline void show(const diagnostic_msgs::msg::dds_::DiagnosticArray_& sample) { DIAGNOSTIC_ARRAY_MEMBERS(ROS2_PUT) }

inline std::vector<std::string> value_texts(const Line* line, const char* member) {
  std::vector<char*> words(kMaxLine);
  words.resize(value_list(line, member, words.data(), words.size()));
  return {words.begin(), words.end()};
}
inline std::vector<double> value_numbers(const Line* line, const char* member) {
  std::vector<double> numbers;
  for (const std::string& each : value_texts(line, member)) numbers.push_back(std::strtod(each.c_str(), nullptr));
  return numbers;
}
inline std_msgs::msg::dds_::Header_ value_header(const Line*, const char*) { return {}; }

inline void fill(const Line* line, sensor_msgs::msg::dds_::JointState_& sample) { JOINT_STATE_MEMBERS(ROS2_TAKE) }
inline void fill(const Line* line, std_msgs::msg::dds_::Bool_& sample) { BOOL_MEMBERS(ROS2_TAKE) }
inline void fill(const Line* line, std_msgs::msg::dds_::Empty_& sample) { EMPTY_MEMBERS(ROS2_TAKE) }

#undef ROS2_PUT
#undef ROS2_TAKE

}  // namespace ros2_text
