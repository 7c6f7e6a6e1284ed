// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/topics_table.hpp"
#include "gateway/upstream/program/steady.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "gateway/core/shown_words.hpp"
#include "gateway/core/words.hpp"

namespace axisgate::dds {
namespace {

// Bits of `supported` and `valid`.
constexpr std::uint32_t kMode = 1U << 1;
constexpr std::uint32_t kPosition = 1U << 2;
constexpr std::uint32_t kVelocity = 1U << 3;
constexpr std::uint32_t kTorque = 1U << 4;
constexpr std::uint32_t kVendorError = 1U << 8;

constexpr std::uint32_t kStopLatched = 1U << 7;  // of alarms
constexpr std::uint8_t kErrorStop = 6;
/// Below this nothing shows that it turns, as in `axisgate top`: one rpm, in rad/s.
constexpr double kTremble = 0.105;

std::string marked(const axisgate::AxisState& axis, std::uint32_t bit, const std::string& text) {
  if ((axis.supported() & bit) == 0) return "-";
  return (axis.valid() & bit) == 0 ? text + "?" : text;
}

std::string number(const axisgate::AxisState& axis, std::uint32_t bit, double value, int digits) {
  return marked(axis, bit, std::isnan(value) ? "" : fmt::format("{:.{}f}", value, digits));
}

bool stands(const axisgate::AxisState& axis) {
  if ((axis.supported() & kVelocity) == 0) return true;
  return (axis.valid() & kVelocity) != 0 && std::abs(axis.velocity()) < kTremble;
}

std::string age(const axisgate::Time& stamp, std::int64_t now_ns) {
  if (stamp.sec() == 0 && stamp.nanosec() == 0) return "-";
  const std::int64_t age_ns = now_ns - (stamp.sec() * kSecond + stamp.nanosec());
  return fmt::format("{:.2f}", static_cast<double>(age_ns) / static_cast<double>(kSecond));
}

/// What is shown of an axis.
struct Texts {
  std::string gateway, number, name, link, state, mode, position, velocity, torque, age, error, alarms;
};

Texts texts_of(const axisgate::AxisState& axis, std::int64_t now_ns) {
  const bool latched_and_stands = (axis.alarms() & kStopLatched) != 0 && stands(axis);
  const std::uint32_t vendor = (axis.valid() & kVendorError) == 0 ? 0 : axis.vendor_error();
  const std::string alarms = names_of_bits(WordKind::axis_alarm, axis.alarms());
  return {.gateway = axis.gateway().to_string(),
          .number = fmt::format("{}", axis.axis()),
          .name = axis.name().to_string(),
          .link = std::string(name_of(WordKind::link_state, axis.link_state())),
          .state = std::string(axis_state_text(axis.axis_state(), latched_and_stands)),
          .mode = marked(axis, kMode, shown_mode(axis.mode())),
          .position = number(axis, kPosition, axis.position(), 3),
          .velocity = number(axis, kVelocity, axis.velocity(), 3),
          .torque = number(axis, kTorque, axis.torque(), 1),
          .age = age(axis.stamp(), now_ns),
          .error = shown_error(axis.error_code(), vendor, axis.axis_state() == kErrorStop),
          .alarms = alarms.empty() ? "-" : alarms};
}

Texts column_names() {
  return {"gateway",  "axis",     "name",   "link",  "state", "mode",
          "position", "velocity", "torque", "age s", "error", "alarms"};
}

constexpr const char* kWideRow = "{:<{}}{:>4}  {:<{}}  {:<9}  {:<17}  {:<17}  {:>12}  {:>12}  {:>8}  {:>7}  {:<18}  {}";
constexpr const char* kNarrowRow = "{:>4}  {:<9}  {:<17}  {:>12}  {:>14}  {:>9}";
constexpr const char* kGatewayRow = "{:<16} {:<9} {:>5} {:>7} {:>9}  {}\n";

/// How wide the columns are that are as wide as what they hold.
struct Widths {
  std::size_t gateway = 0;  ///< 0: there is none
  std::size_t name = 4;
};

std::string wide(const Texts& t, const Widths& widths) {
  return fmt::format(kWideRow, widths.gateway == 0 ? "" : t.gateway, widths.gateway, t.number, t.name, widths.name,
                     t.link, t.state, t.mode, t.position, t.velocity, t.torque, t.age, t.error, t.alarms);
}

std::string narrow(const Texts& t) {
  return fmt::format(kNarrowRow, t.number, t.link, t.state, t.position, t.velocity, t.torque);
}

/// What a narrow row has no room for, broken between words; a word that is longer stands alone.
std::string more(const Texts& t, std::size_t columns) {
  std::string text = t.gateway.empty() || t.name.empty() ? t.gateway + t.name : t.gateway + " " + t.name;
  if (!text.empty()) text += ": ";
  text += t.mode + ", age " + t.age + " s";
  if (t.error != "none") text += ", error " + t.error;
  if (t.alarms != "-") text += ", alarms: " + t.alarms;
  constexpr std::string_view kIndent = "      ";
  std::string lines(kIndent);
  std::size_t used = kIndent.size();
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (used > kIndent.size() && used + 1 + end > columns) {
      lines += fmt::format("\n{}", kIndent);
      used = kIndent.size();
    } else if (used > kIndent.size()) {
      lines += ' ';
      ++used;
    }
    lines += rest.substr(0, end);
    used += end;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return lines;
}

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

std::string topics_table(const AxisSamples& axes, std::int64_t now_ns, std::size_t columns) {
  std::vector<Texts> rows{column_names()};
  Widths widths;
  for (const auto& [key, axis] : axes) {
    rows.push_back(texts_of(axis, now_ns));
    widths.name = std::max(widths.name, rows.back().name.size());
    if (!rows.back().gateway.empty())
      widths.gateway = std::max({widths.gateway, rows.back().gateway.size() + 1, std::size_t{8}});
  }
  std::vector<std::string> lines;
  for (const Texts& row : rows) lines.push_back(wide(row, widths));
  if (columns != 0 && std::ranges::any_of(lines, [&](const std::string& line) { return line.size() > columns; })) {
    lines = {narrow(rows.front())};
    for (const Texts& row : std::span(rows).subspan(1)) lines.insert(lines.end(), {narrow(row), more(row, columns)});
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string topics_line(const axisgate::AxisState& axis) {
  const Texts t = texts_of(axis, 0);
  return fmt::format("{}axis {} {}: {}, {}, {}, position {}, velocity {}, torque {}, error {}, alarms {}",
                     t.gateway.empty() ? "" : t.gateway + " ", t.number, t.name, t.link, t.state, t.mode, t.position,
                     t.velocity, t.torque, t.error, t.alarms);
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
