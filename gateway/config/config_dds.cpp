// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "gateway/config/config_endpoint.hpp"
#include "gateway/config/config_sections.hpp"
#include "gateway/upstream/dds_link/ros_names.hpp"

namespace axisgate::config {
namespace {

using dds::DdsSettings;

constexpr Duration kMaxAgeOnLoopback = std::chrono::milliseconds(500);
/// IFNAMSIZ of Linux without its end.
constexpr std::size_t kLongestInterfaceName = 15;

bool ipv4(std::string_view text) {
  const auto network = parse_network(text);
  return network && text.find('/') == std::string_view::npos && text.find(':') == std::string_view::npos;
}

bool interface_name(std::string_view text) {
  // An address that is wrong would be a good name: it is taken for what was meant.
  const bool digits_and_dots = text.find_first_not_of("0123456789.") == std::string_view::npos;
  const bool other = std::ranges::any_of(
      text, [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '/' || c == ':' || c == '\x7F'; });
  return !text.empty() && text.size() <= kLongestInterfaceName && !digits_and_dots && !other;
}

/// The texts of an array that are of the right form; the others are told.
template <typename Good>
std::vector<std::string> read_texts(const JsonNode& node, std::string_view key, ConfigFaults& faults, Good&& good,
                                    std::string_view what_is_wrong) {
  std::vector<std::string> texts;
  for (const JsonNode& item : node[key].items()) {
    if (!item.is_string() || faults.within(item.pointer())) continue;
    if (good(item.text()))
      texts.push_back(item.text());
    else
      faults.add(item.pointer(), fmt::format("'{}' {}", item.text(), what_is_wrong));
  }
  return texts;
}

void read_network(const JsonNode& node, DdsSettings& settings, ConfigFaults& faults) {
  settings.domain = static_cast<std::uint32_t>(node.integer("domain").value_or(settings.domain));
  settings.multicast = node.flag("multicast", settings.multicast);
  if (node.has("interfaces")) {
    settings.interfaces = read_texts(
        node, "interfaces", faults, [](const std::string& text) { return ipv4(text) || interface_name(text); },
        "is no interface: write its name such as \"eth0\", or its IPv4 address without prefix");
  }
  const auto with_port = [](const std::string& text) { return text.front() != '[' && parse_endpoint(text); };
  settings.peers = read_texts(
      node, "peers", faults, [&](const std::string& text) { return ipv4(text) || with_port(text); },
      "is no IPv4 address, and no such address with a port: write one such as \"192.168.1.5\"");
  settings.discovery_servers =
      read_texts(node, "discovery_servers", faults, with_port,
                 "is no IPv4 address and port of a discovery server: write one such as \"192.168.1.5:11811\"");
}

bool loopback_only(const DdsSettings& settings) {
  return std::ranges::all_of(settings.interfaces,
                             [](const std::string& text) { return text == "lo" || is_loopback(text); });
}

void check_reach(const JsonNode& node, const DdsSettings& settings, ConfigFaults& faults) {
  if (node.has("peers") && node.has("discovery_servers")) {
    faults.add(node.pointer("discovery_servers"),
               "with a discovery server participants find each other through it, and `peers` are not asked: remove one "
               "of the two keys");
  }
  if (!loopback_only(settings) || faults.within(node.pointer("interfaces"))) return;
  const auto check_reached = [&](std::string_view key, const std::vector<std::string>& places) {
    for (const std::string& place : places) {
      if (is_loopback(place.substr(0, place.find(':')))) continue;
      faults.add(node.pointer(key),
                 fmt::format("{} cannot be reached over {}: name the interface that leads there in `interfaces`", place,
                             fmt::join(settings.interfaces, ", ")));
    }
  };
  check_reached("peers", settings.peers);
  check_reached("discovery_servers", settings.discovery_servers);
}

/// The file that this key names; empty: there is none.
std::string read_file_name(const JsonNode& node, std::string_view key, ConfigFaults& faults) {
  const auto name = node.string(key);
  if (!name || faults.within(node.pointer(key))) return {};
  const auto file = std::filesystem::path(faults.file()).parent_path() / *name;
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) return file.string();
  faults.add(
      node.pointer(key),
      fmt::format("there is no file {}: a path that does not begin with / counts from this file", file.string()));
  return {};
}

void read_roles(const JsonNode& node, DdsSettings& settings, ConfigFaults& faults) {
  for (const JsonNode& each : node["roles"].items())
    settings.roles.push_back({read_file_name(each, "certificate", faults), role_named(each.text("role"))});
  if (!settings.roles.empty() && !node.has("qos_file")) {
    faults.add(node.pointer("roles"),
               "without DDS-Security nobody proves whose certificate is whose: add the \"qos_file\" that turns it on "
               "(docs/dds/networks.md)");
  }
}

void read_role(const JsonNode& node, DdsSettings& settings, ConfigFaults& faults) {
  settings.commands = node.flag("commands", settings.commands);
  read_roles(node, settings, faults);
  settings.role = loopback_only(settings) ? Role::engineer : Role::operator_;
  // Who has no certificate of those must not be given more than who has one.
  if (!settings.roles.empty()) settings.role = Role::viewer;
  if (const Role given = role_named(node.text("role")); given != Role::none) settings.role = given;
  if (!settings.commands) {
    for (const std::string_view key : {"role", "roles", "start_deadline_ms", "reply_deadline_ms", "max_age_ms"})
      if (node.has(key)) faults.warn(node.pointer(key), "without \"commands\": true this has no effect");
    return;
  }
  if (most_rights(settings) == Role::viewer)
    faults.warn(node.pointer("role"), "every request of a DDS client is refused: a viewer commands nothing");
  if (loopback_only(settings) || settings.role == Role::viewer) return;
  faults.warn(node.pointer("commands"),
              fmt::format("DDS has no passwords: every host that reaches {} may command all axes as {}",
                          fmt::join(settings.interfaces, ", "), axisgate::text(settings.role)));
}

void read_ros2(const JsonNode& node, DdsSettings& settings, const std::vector<BusConfig>& buses, ConfigFaults& faults) {
  if (const JsonNode tolerance = node["sync_tolerance"]; tolerance && !faults.within(tolerance.pointer())) {
    settings.sync_tolerance = tolerance.rational().value_or(Rational(1, 100)).to_double();
    if (!settings.ros2 || !settings.commands)
      faults.warn(tolerance.pointer(), "without \"ros2\" and \"commands\" this has no effect");
  }
  if (!settings.ros2) return;
  std::map<std::string, std::string> seen;
  each_axis(buses, [&](const AxisConfig& axis) {
    const auto known = seen.emplace(dds::ros_token(axis.name), axis.name);
    if (known.second) return;
    const auto& [token, other] = *known.first;
    faults.add(axis.pointer + "/name",
               fmt::format("'{}' and '{}' are both {} to ROS 2, which knows joints by their names: give one of them "
                           "another name",
                           other, axis.name, token));
  });
}

void read_times(const JsonNode& node, DdsSettings& settings, ConfigFaults& faults) {
  settings.min_period = node.milliseconds("min_period_ms", settings.min_period);
  settings.max_period = node.milliseconds("max_period_ms", settings.max_period);
  settings.start_deadline = node.milliseconds("start_deadline_ms", settings.start_deadline);
  settings.reply_deadline = node.milliseconds("reply_deadline_ms", settings.reply_deadline);
  // Clocks of different hosts differ.
  if (loopback_only(settings)) settings.max_age = kMaxAgeOnLoopback;
  if (const auto given = node.integer("max_age_ms")) {
    settings.max_age.reset();
    if (*given != 0) settings.max_age = std::chrono::milliseconds(*given);
  }
  settings.memory_limit_mib =
      static_cast<std::uint32_t>(node.integer("memory_limit_mb").value_or(settings.memory_limit_mib));
  if (settings.min_period <= settings.max_period) return;
  const auto ms = [](Duration time) { return std::chrono::duration_cast<std::chrono::milliseconds>(time).count(); };
  faults.add(node.pointer(node.has("min_period_ms") ? "min_period_ms" : "max_period_ms"),
             fmt::format("samples of an axis cannot be at least {} ms and at most {} ms apart: write a min_period_ms "
                         "that is not above max_period_ms",
                         ms(settings.min_period), ms(settings.max_period)));
}

}  // namespace

std::optional<DdsSettings> read_dds(const JsonNode& root, const std::vector<BusConfig>& buses, ConfigFaults& faults) {
  const JsonNode node = root["dds"];
  if (!node) return std::nullopt;
  DdsSettings settings;
  settings.ros2 = node.flag("ros2", settings.ros2);
  if (root.has("gateway")) settings.gateway = dds::gateway_id(root["gateway"].text("name"));
  read_network(node, settings, faults);
  // A ROS 2 node leaves the loopback alone as soon as there is another interface; what it always has is shared memory.
  settings.shared_memory = node.flag("shared_memory", settings.ros2 && loopback_only(settings));
  check_reach(node, settings, faults);
  settings.qos_file = read_file_name(node, "qos_file", faults);
  read_role(node, settings, faults);
  read_ros2(node, settings, buses, faults);
  read_times(node, settings, faults);
  each_axis(buses, [&](const AxisConfig& axis) {
    settings.units.push_back({axis.number, axis.units_per_rev, axis.metres_per_rev});
  });
  return settings;
}

// A renewed key comes with a certificate, and has no business in this process.
std::vector<profile::FileRead> read_files_of_dds(const DdsSettings& settings) {
  std::vector<profile::FileRead> out;
  if (settings.qos_file.empty()) return out;
  out.push_back(profile::read_file(settings.qos_file));
  for (const dds::CertificateRole& each : settings.roles) out.push_back(profile::read_file(each.certificate));
  const std::string qos = out.front().text.value_or("");
  constexpr std::string_view kFile = "file://";
  for (std::size_t at = 0; (at = qos.find(kFile, at)) != std::string::npos;) {
    const std::string_view name = std::string_view(qos).substr(0, at).substr(std::min(at, qos.rfind("<name>", at)));
    at += kFile.size();
    const std::string path = qos.substr(at, qos.find_first_of("< \t\r\n", at) - at);
    const bool known = std::ranges::any_of(out, [&](const auto& each) { return each.file == path; });
    if (!known && name.find("private_key") == std::string_view::npos) out.push_back(profile::read_file(path));
  }
  return out;
}

std::optional<Rational> read_metres_per_rev(const JsonNode& axis, ConfigFaults& faults) {
  const bool metres = axis.text("dds_unit") == "m";
  const JsonNode node = axis["metres_per_rev"];
  if (metres && !node) {
    faults.add(axis.pointer("dds_unit"),
               "metres need to know how far one motor turn goes: add \"metres_per_rev\", such as \"0.005\" for a "
               "spindle of 5 mm");
  }
  if (!node || faults.within(node.pointer())) return std::nullopt;
  const auto length = node.rational();
  if (!length || length->numerator() <= 0) {
    faults.add(node.pointer(), "is no length above 0: write metres as a number or a decimal string, such as \"0.005\"");
    return std::nullopt;
  }
  if (metres) return length;
  faults.warn(node.pointer(), "without \"dds_unit\": \"m\" this has no effect: DDS shows the axis in rad");
  return std::nullopt;
}

}  // namespace axisgate::config
