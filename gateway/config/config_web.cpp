// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "gateway/config/config_endpoint.hpp"
#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

using web::WebSettings;

void check_port(const JsonNode& node, const Endpoint& endpoint,
                const std::vector<modbus_tcp::ListenerSettings>& listeners, ConfigFaults& faults) {
  const auto taken = std::ranges::find_if(listeners, [&](const auto& listener) {
    return listener.port == endpoint.port &&
           (listener.host == endpoint.host || is_any_address(listener.host) || is_any_address(endpoint.host));
  });
  if (taken != listeners.end())
    faults.add(node.pointer("listen"),
               fmt::format("port {} is taken by /modbus_tcp/{}: give the page a port of its own", endpoint.port,
                           taken - listeners.begin()));
}

/// The address is not the loopback's.
void check_reach(const JsonNode& node, const WebSettings& settings, ConfigFaults& faults) {
  if (!settings.insecure) {
    faults.add(node.pointer("listen"),
               fmt::format("{} is reached from other hosts, and the page has neither encryption nor passwords: add "
                           "\"insecure\": true where every host that `allow` names may look, or listen on "
                           "127.0.0.1",
                           settings.listen));
    return;
  }
  faults.warn(node.pointer("insecure"),
              fmt::format("the page at {} is neither encrypted nor has it passwords: it shows all axes to {}",
                          settings.listen, fmt::join(settings.allow, ", ")));
  if (!node.has("allow")) faults.warn(node.pointer("listen"), "without `allow`, this computer alone may look");
}

void read_listen(const JsonNode& node, WebSettings& settings,
                 const std::vector<modbus_tcp::ListenerSettings>& listeners, ConfigFaults& faults) {
  if (faults.within(node.pointer("listen"))) return;
  settings.listen = node.string("listen").value_or(settings.listen);
  const auto endpoint = parse_endpoint(settings.listen);
  if (!endpoint || is_group_address(endpoint->host)) {
    faults.add(node.pointer("listen"),
               fmt::format("'{}' is no address and port of this computer: write \"127.0.0.1:8080\", \"0.0.0.0:8080\" "
                           "or \"[::1]:8080\"",
                           settings.listen));
    return;
  }
  if (!node.has("allow") && settings.listen.front() == '[') settings.allow.emplace_back("::1/128");
  check_port(node, *endpoint, listeners, faults);
  if (!is_loopback(endpoint->host)) return check_reach(node, settings, faults);
  if (settings.insecure) faults.warn(node.pointer("insecure"), "on the loopback this has no effect");
}

void read_allow(const JsonNode& node, WebSettings& settings, ConfigFaults& faults) {
  if (!node.has("allow")) return;
  settings.allow.clear();
  for (const JsonNode& item : node["allow"].items()) {
    const auto from = item.string("from");
    if (!from || faults.within(item.pointer("from"))) continue;
    const auto network = parse_network(*from);
    if (!network || !network->host_bits_clear)
      faults.add(item.pointer("from"), fmt::format("'{}' is no address or network: write \"192.168.1.7\", "
                                                   "\"192.168.1.0/24\" or \"fd00::/8\"",
                                                   *from));
    settings.allow.push_back(*from);
  }
  if (settings.allow.empty()) faults.warn(node.pointer("allow"), "names nobody, so nobody can look");
}

std::uint32_t number(const JsonNode& node, std::string_view key, std::uint32_t otherwise) {
  return static_cast<std::uint32_t>(node.integer(key).value_or(otherwise));
}

constexpr std::int64_t kLastBit = 31;
/// Quantities whose bits mean something.
constexpr std::array<std::string_view, 6> kWords = {"statusword",   "mode",   "error_code",
                                                    "vendor_error", "inputs", "outputs"};

/// What stands beside `is` must be what it is judged by, and no more.
void check_trigger(const JsonNode& node, const Config& config, ConfigFaults& faults) {
  if (faults.within(node.pointer())) return;
  const std::string is = node.text("is");
  const bool outside = is == "outside";
  for (const auto& [key, wanted] :
       {std::pair("value", !outside && is != "changes"), std::pair("min", outside), std::pair("max", outside)}) {
    if (node.has(key) == wanted) continue;
    if (wanted)
      faults.add(node.pointer("is"), fmt::format("\"{0}\" needs \"{1}\": add it", is, key));
    else
      faults.add(node.pointer(key), fmt::format("\"{0}\" takes no \"{1}\": remove it", is, key));
  }
  const auto decimal = [](const Rational& number) {
    return static_cast<double>(number.numerator()) / static_cast<double>(number.denominator());
  };
  if (const auto min = node["min"].rational(), max = node["max"].rational();
      outside && min && max && decimal(*max) < decimal(*min))
    faults.add(node.pointer("max"), "is below \"min\": nothing would be between");
  const auto bit = node.integer("value");
  if (is.starts_with("bit_") && node.has("value") && (!bit || *bit < 0 || *bit > kLastBit))
    faults.add(node.pointer("value"), fmt::format("must be a bit's number, 0 to {}", kLastBit));
  if (is.starts_with("bit_") && std::ranges::find(kWords, node.text("quantity")) == kWords.end())
    faults.add(node.pointer("is"), fmt::format("\"{}\" asks for a bit, and {} is a number: bits are in {}", is,
                                               node.text("quantity"), fmt::join(kWords, ", ")));
  const auto number = node.integer("axis");
  bool there = false;
  each_axis(config.buses, [&](const AxisConfig& axis) { there = there || axis.number == number; });
  if (!there)
    faults.add(node.pointer("axis"), fmt::format("there is no axis {} in this configuration", number.value_or(0)));
}

/// For axisgate-web, which goes by it.
std::string read_recorder(const JsonNode& node, const Config& config, ConfigFaults& faults) {
  for (const JsonNode& trigger : node["triggers"].items()) check_trigger(trigger, config, faults);
  const JsonNode captures = node["captures"];
  if (const auto folder = captures.string("folder"); folder && !folder->starts_with('/'))
    faults.add(captures.pointer("folder"),
               fmt::format("'{}' would be looked for wherever the gateway is started: write the whole path, "
                           "\"/var/lib/axisgate/captures\"",
                           *folder));
  std::vector<std::string> given;
  for (const char* const key : {"captures", "triggers"})
    if (node.has(key)) given.push_back(fmt::format("\"{}\": {}", key, node[key].dump()));
  return fmt::format("{{{}}}", fmt::join(given, ", "));
}

}  // namespace

std::optional<WebSettings> read_web(const JsonNode& root, const Config& config, ConfigFaults& faults) {
  const JsonNode node = root["web"];
  if (!node) return std::nullopt;
  WebSettings settings;
  settings.gateway = root["gateway"].text("name");
  for (const JsonNode& host : node["hosts"].items()) settings.hosts.push_back(host.text());
  settings.insecure = node.flag("insecure", settings.insecure);
  read_allow(node, settings, faults);
  read_listen(node, settings, config.modbus_tcp, faults);
  settings.sample_period = node.milliseconds("sample_ms", settings.sample_period);
  settings.history_mib = number(node, "history_mb", settings.history_mib);
  settings.max_connections = number(node, "max_connections", settings.max_connections);
  settings.max_streams = number(node, "max_streams", settings.max_streams);
  settings.memory_limit_mib = number(node, "memory_limit_mb", settings.memory_limit_mib);
  if (web::history_mib(settings) < settings.history_mib && node.has("history_mb"))
    faults.warn(node.pointer("history_mb"),
                fmt::format("half of memory_limit_mb is the most that the history gets: it has {} MiB",
                            web::history_mib(settings)));
  settings.recorder = read_recorder(node, config, faults);
  return settings;
}

}  // namespace axisgate::config
