#include "gateway/upstream/dds_process/topics_table.hpp"
#include "gateway/upstream/dds_process/steady.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

namespace axisgate::dds {
namespace {

// Numbers of design 3.1, registers 18 and 31.
constexpr std::array<std::string_view, 6> kLinks{"unknown", "setup", "online", "suspect", "offline", "link down"};
constexpr std::array<std::string_view, 8> kStates{"disabled", "standstill", "moving to target", "moving",
                                                  "homing",   "stopping",   "error stop",       "unknown"};
// Bits of `supported` and `valid`.
constexpr std::uint32_t kStatusword = 1U << 0;
constexpr std::uint32_t kMode = 1U << 1;
constexpr std::uint32_t kPosition = 1U << 2;
constexpr std::uint32_t kVelocity = 1U << 3;
constexpr std::uint32_t kTorque = 1U << 4;

template <std::size_t Size>
std::string name_of(const std::array<std::string_view, Size>& names, std::uint8_t number) {
  return number < Size ? std::string(names[number]) : fmt::format("{}", number);
}

std::string marked(const axisgate::AxisState& axis, std::uint32_t bit, std::string text) {
  if ((axis.supported() & bit) == 0) return "-";
  return (axis.valid() & bit) == 0 ? text + "?" : text;
}

std::string number(const axisgate::AxisState& axis, std::uint32_t bit, double value, int digits) {
  return marked(axis, bit, std::isnan(value) ? "" : fmt::format("{:.{}f}", value, digits));
}

std::string age(const axisgate::Time& stamp, std::int64_t now_ns) {
  if (stamp.sec() == 0 && stamp.nanosec() == 0) return "-";
  const std::int64_t age_ns = now_ns - (stamp.sec() * kSecond + stamp.nanosec());
  return fmt::format("{:.2f}", static_cast<double>(age_ns) / static_cast<double>(kSecond));
}

constexpr const char* kRow = "{:>4}  {:<16} {:<9}  {:<16} {:>6} {:>5} {:>13} {:>12} {:>9} {:>6} {:>10} {:>8}\n";

}  // namespace

std::string topics_table(const AxisSamples& axes, std::int64_t now_ns) {
  std::string text = fmt::format(kRow, "axis", "name", "link", "state", "status", "mode", "position", "velocity",
                                 "torque", "error", "alarms", "age s");
  for (const auto& [number_of_axis, axis] : axes) {
    text += fmt::format(
        fmt::runtime(kRow), number_of_axis, axis.name().to_string(), name_of(kLinks, axis.link_state()),
        name_of(kStates, axis.axis_state()), marked(axis, kStatusword, fmt::format("{:04X}", axis.statusword())),
        marked(axis, kMode, fmt::format("{}", axis.mode())), number(axis, kPosition, axis.position(), 3),
        number(axis, kVelocity, axis.velocity(), 3), number(axis, kTorque, axis.torque(), 1),
        fmt::format("{:04X}", axis.error_code()), fmt::format("{:08X}", axis.alarms()), age(axis.stamp(), now_ns));
  }
  return text;
}

std::string topics_line(const axisgate::AxisState& axis) {
  return fmt::format(
      "axis {} {}: {}, {}, statusword {}, mode {}, position {}, velocity {}, torque {}, error {:04X}", axis.axis(),
      axis.name().to_string(), name_of(kLinks, axis.link_state()), name_of(kStates, axis.axis_state()),
      marked(axis, kStatusword, fmt::format("{:04X}", axis.statusword())),
      marked(axis, kMode, fmt::format("{}", axis.mode())), number(axis, kPosition, axis.position(), 3),
      number(axis, kVelocity, axis.velocity(), 3), number(axis, kTorque, axis.torque(), 1), axis.error_code());
}

std::string topics_json(const axisgate::AxisState& axis) {
  const nlohmann::ordered_json sample{{"axis", axis.axis()},
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
