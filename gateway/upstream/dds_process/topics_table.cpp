// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/topics_table.hpp"
#include "gateway/upstream/program/steady.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "gateway/core/words.hpp"

namespace axisgate::dds {
namespace {

// Bits of `supported` and `valid`.
constexpr std::uint32_t kStatusword = 1U << 0;
constexpr std::uint32_t kMode = 1U << 1;
constexpr std::uint32_t kPosition = 1U << 2;
constexpr std::uint32_t kVelocity = 1U << 3;
constexpr std::uint32_t kTorque = 1U << 4;

std::string marked(const axisgate::AxisState& axis, std::uint32_t bit, std::string text) {
  if ((axis.supported() & bit) == 0) return "-";
  return (axis.valid() & bit) == 0 ? text + "?" : text;
}

std::string number(const axisgate::AxisState& axis, std::uint32_t bit, double value, int digits) {
  return marked(axis, bit, std::isnan(value) ? "" : fmt::format("{:.{}f}", value, digits));
}

/// Of a fault whose cause is not known yet there is none.
std::string error_text(const axisgate::AxisState& axis) {
  constexpr std::uint16_t kNotKnown = 0xFFFF;
  return axis.error_code() == kNotKnown ? "?" : fmt::format("{:04X}", axis.error_code());
}

std::string age(const axisgate::Time& stamp, std::int64_t now_ns) {
  if (stamp.sec() == 0 && stamp.nanosec() == 0) return "-";
  const std::int64_t age_ns = now_ns - (stamp.sec() * kSecond + stamp.nanosec());
  return fmt::format("{:.2f}", static_cast<double>(age_ns) / static_cast<double>(kSecond));
}

constexpr const char* kRow = "{:>4}  {:<16} {:<9}  {:<17} {:>6} {:>5} {:>13} {:>12} {:>9} {:>6} {:>10} {:>8}\n";
constexpr const char* kGatewayRow = "{:<16} {:<9} {:>5} {:>7} {:>9}  {}\n";

std::string shown_gateway(const std::string& name) { return name.empty() ? "(no name)" : name; }

}  // namespace

std::string gateways_table(const SeenGateways& gateways, std::int64_t now_ns) {
  std::string text = fmt::format(kGatewayRow, "gateway", "state", "axes", "online", "uptime s", "alarms");
  for (const auto& [name, seen] : gateways) {
    std::size_t there = 0;
    for (const auto& [writer, at] : seen.writers) there += now_ns - at < kGatewayGoneAfter ? 1 : 0;
    std::string alarms = names_of_bits(WordKind::gateway_alarm, seen.state.alarms());
    if (there > 1) alarms = fmt::format("{} GATEWAYS HAVE THIS NAME{}{}", there, alarms.empty() ? "" : "; ", alarms);
    text += fmt::format(kGatewayRow, shown_gateway(name),
                        there == 0 ? "gone" : name_of(WordKind::gateway_state, seen.state.state()),
                        seen.state.axis_count(), seen.state.axes_online(), seen.state.uptime_s(), alarms);
  }
  return text;
}

std::string topics_table(const AxisSamples& axes, std::int64_t now_ns) {
  const bool named = std::any_of(axes.begin(), axes.end(), [](const auto& each) { return !each.first.first.empty(); });
  const auto with_gateway = [&](const std::string& gateway, const std::string& line) {
    return named ? fmt::format("{:<16} {}", gateway, line) : line;
  };
  std::string text = with_gateway("gateway", fmt::format(kRow, "axis", "name", "link", "state", "status", "mode",
                                                         "position", "velocity", "torque", "error", "alarms", "age s"));
  for (const auto& [key, axis] : axes) {
    text += with_gateway(
        key.first,
        fmt::format(kRow, key.second, axis.name().to_string(), name_of(WordKind::link_state, axis.link_state()),
                    name_of(WordKind::axis_state, axis.axis_state()),
                    marked(axis, kStatusword, fmt::format("{:04X}", axis.statusword())),
                    marked(axis, kMode, fmt::format("{}", axis.mode())), number(axis, kPosition, axis.position(), 3),
                    number(axis, kVelocity, axis.velocity(), 3), number(axis, kTorque, axis.torque(), 1),
                    error_text(axis), fmt::format("{:08X}", axis.alarms()), age(axis.stamp(), now_ns)));
  }
  return text;
}

std::string topics_line(const axisgate::AxisState& axis) {
  return fmt::format(
      "{}axis {} {}: {}, {}, statusword {}, mode {}, position {}, velocity {}, torque {}, error {}",
      axis.gateway().size() == 0 ? "" : axis.gateway().to_string() + " ", axis.axis(), axis.name().to_string(),
      name_of(WordKind::link_state, axis.link_state()), name_of(WordKind::axis_state, axis.axis_state()),
      marked(axis, kStatusword, fmt::format("{:04X}", axis.statusword())),
      marked(axis, kMode, fmt::format("{}", axis.mode())), number(axis, kPosition, axis.position(), 3),
      number(axis, kVelocity, axis.velocity(), 3), number(axis, kTorque, axis.torque(), 1), error_text(axis));
}

std::string topics_json(const axisgate::AxisState& axis) {
  const nlohmann::ordered_json sample{{"gateway_key", axis.gateway_key()},
                                      {"gateway", axis.gateway().to_string()},
                                      {"axis", axis.axis()},
                                      {"name", axis.name().to_string()},
                                      {"stamp", {{"sec", axis.stamp().sec()}, {"nanosec", axis.stamp().nanosec()}}},
                                      {"sequence_number", axis.sequence_number()},
                                      {"statusword", axis.statusword()},
                                      {"mode", axis.mode()},
                                      {"position", axis.position()},
                                      {"velocity", axis.velocity()},
                                      {"torque", axis.torque()},
                                      {"current", axis.current()},
                                      {"following_error", axis.following_error()},
                                      {"error_code", axis.error_code()},
                                      {"vendor_error", axis.vendor_error()},
                                      {"inputs", axis.inputs()},
                                      {"outputs", axis.outputs()},
                                      {"drive_temperature", axis.drive_temperature()},
                                      {"motor_temperature", axis.motor_temperature()},
                                      {"voltage", axis.voltage()},
                                      {"axis_state", axis.axis_state()},
                                      {"motion_state", axis.motion_state()},
                                      {"motion_id", axis.motion_id()},
                                      {"alarms", axis.alarms()},
                                      {"link_state", axis.link_state()},
                                      {"supported", axis.supported()},
                                      {"valid", axis.valid()}};
  // A name is the configuration's, but a sample may be anybody's: what is no UTF-8 is replaced, not thrown.
  return sample.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace axisgate::dds
