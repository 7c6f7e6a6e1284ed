// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/ros/ros_diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/core/words.hpp"

namespace axisgate::dds {
namespace {

using Status = diagnostic_msgs::msg::dds_::DiagnosticStatus_;

// diagnostic_msgs/msg/DiagnosticStatus.msg
enum Level : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };

// Numbers of the register map: link_state, axis_state, gateway_state, axis_alarms.
constexpr std::uint8_t kLinkUnknown = 0, kLinkSetup = 1, kLinkOnline = 2, kLinkSuspect = 3;
constexpr std::uint8_t kErrorStop = 6;
constexpr std::uint8_t kGatewayRunning = 1;
constexpr std::uint32_t kErrors = 1U << 2U      // identity_mismatch
                                  | 1U << 8U    // duplicate_node
                                  | 1U << 12U   // profile_mismatch
                                  | 1U << 13U   // unexpected_motion
                                  | 1U << 14U;  // units_disagree
constexpr std::uint8_t kBusUp = 1;

void add(Status& status, const char* key, std::string value) {
  diagnostic_msgs::msg::dds_::KeyValue_ pair;
  pair.key(key);
  pair.value(std::move(value));
  status.values().push_back(std::move(pair));
}

void add(Status& status, const char* key, double value) {
  if (!std::isnan(value)) add(status, key, fmt::format("{:.6g}", value));
}

std::uint8_t level_of(const StateRecord& axis) {
  if (axis.link_state == kLinkUnknown) return kStale;
  if (axis.link_state > kLinkSuspect || axis.axis_state == kErrorStop || axis.error_code != 0) return kError;
  if ((axis.alarms & kErrors) != 0) return kError;
  return axis.link_state == kLinkOnline && axis.alarms == 0 ? kOk : kWarn;
}

std::string message_of(const StateRecord& axis) {
  std::string out(name_of(WordKind::link_state, axis.link_state));
  if (axis.link_state == kLinkOnline || axis.link_state == kLinkSuspect)
    out += fmt::format(", {}", name_of(WordKind::axis_state, axis.axis_state));
  if (axis.error_code != 0) {
    const Word* const word = find_error(axis.error_code);
    out += fmt::format(", error {:04X}{}{}", axis.error_code, word == nullptr ? "" : ": ",
                       word == nullptr ? "" : word->name);
  }
  if (axis.alarms != 0) out += ", " + names_of_bits(WordKind::axis_alarm, axis.alarms);
  return out;
}

bool says_the_same(const Status& a, const Status& b) {
  return a.level() == b.level() && a.message() == b.message() && a.name() == b.name();
}

}  // namespace

Status RosDiagnostics::status_of(const std::string& name) const {
  Status status;
  const std::string whose = gateway_.empty() ? "axisgate" : gateway_;
  status.name(whose + ": " + name);
  status.hardware_id(whose);
  return status;
}

void RosDiagnostics::put(std::uint16_t number, Status status) {
  Status& there = all_[number];
  changed_ = changed_ || !says_the_same(there, status);
  there = std::move(status);
}

void RosDiagnostics::on_state(const StateRecord& axis) {
  if (axis.name.empty()) {  // a reload has taken it away
    changed_ = all_.erase(axis.axis) > 0 || changed_;
    return;
  }
  Status status = status_of(axis.name);
  status.level(level_of(axis));
  status.message(message_of(axis));
  add(status, "axis", std::to_string(axis.axis));
  add(status, "link", std::string(name_of(WordKind::link_state, axis.link_state)));
  add(status, "state", std::string(name_of(WordKind::axis_state, axis.axis_state)));
  add(status, "statusword", fmt::format("{:04X}", axis.statusword));
  add(status, "mode", std::to_string(axis.mode));
  add(status, "error code", fmt::format("{:04X}", axis.error_code));
  add(status, "vendor error", fmt::format("{:08X}", axis.vendor_error));
  add(status, "alarms", names_of_bits(WordKind::axis_alarm, axis.alarms));
  add(status, "following error", axis.following_error);
  add(status, "torque (0.1 %)", axis.torque);
  add(status, "current (A)", axis.current);
  add(status, "drive temperature (degC)", axis.drive_temperature);
  add(status, "motor temperature (degC)", axis.motor_temperature);
  add(status, "voltage (V)", axis.voltage);
  put(axis.axis, std::move(status));
}

void RosDiagnostics::on_gateway(const GatewayRecord& gateway) {
  Status status = status_of("gateway");
  status.level(gateway.state == kGatewayRunning && gateway.alarms == 0 ? kOk : kWarn);
  std::string message(name_of(WordKind::gateway_state, gateway.state));
  if (gateway.alarms != 0) message += ", " + names_of_bits(WordKind::gateway_alarm, gateway.alarms);
  status.message(message);
  add(status, "axes", std::to_string(gateway.axis_count));
  add(status, "axes online", std::to_string(gateway.axes_online));
  add(status, "uptime (s)", std::to_string(gateway.uptime_s));
  add(status, "events lost", std::to_string(gateway.events_lost));
  for (const BusRecord& bus : gateway.buses) {
    add(status, ("bus " + bus.name).c_str(),
        fmt::format("{}, load {:.1f} %", bus.link == kBusUp ? "up" : "down or suspect", bus.load_permille / 10.0));
  }
  put(0, std::move(status));
}

diagnostic_msgs::msg::dds_::DiagnosticArray_ RosDiagnostics::take(SteadyNs at, ClockDifference difference) {
  changed_ = false;
  diagnostic_msgs::msg::dds_::DiagnosticArray_ out;
  const axisgate::Time stamp = to_time(at, difference);
  out.header().stamp().sec(stamp.sec());
  out.header().stamp().nanosec(stamp.nanosec());
  for (const auto& [number, status] : all_) out.status().push_back(status);
  return out;
}

}  // namespace axisgate::dds
