// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_link/ros_names.hpp"

namespace axisgate::dds {
namespace {

bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::string ros_token(std::string_view name) {
  std::string token;
  for (const char c : name) {
    if (token.empty() && digit(c)) token += '_';
    if (letter(c) || digit(c)) {
      token += c;
    } else if (token.empty() || token.back() != '_') {
      token += '_';
    }
  }
  return token.empty() ? "_" : token;
}

std::string ros_topic(std::string_view gateway, std::string_view topic) {
  std::string out = "rt/";
  if (!gateway.empty()) out += std::string(gateway) + "/";
  return out + std::string(topic);
}

std::string ros_axis_topic(std::string_view gateway, std::string_view axis, std::string_view topic) {
  return ros_topic(gateway, ros_token(axis) + "/" + std::string(topic));
}

}  // namespace axisgate::dds
