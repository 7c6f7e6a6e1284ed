// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "gateway/config/config_endpoint.hpp"
#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

using modbus_tcp::AllowEntry;
using modbus_tcp::ListenerSettings;

AllowEntry read_allow_entry(const JsonNode& node, ConfigFaults& faults) {
  AllowEntry entry;
  entry.role = role_named(node.text("role"));
  entry.rank = static_cast<std::uint8_t>(node.integer("rank").value_or(0));
  const auto from = node.string("from");
  if (!from || faults.within(node.pointer("from"))) return entry;

  const auto network = parse_network(*from);
  if (!network) {
    faults.add(
        node.pointer("from"),
        fmt::format("'{}' is no address or network: write \"192.168.1.7\", \"192.168.1.0/24\" or \"fd00::/8\"", *from));
    return entry;
  }
  if (!network->host_bits_clear) {
    faults.add(node.pointer("from"),
               fmt::format("'{}' has address bits behind its prefix: write the network's own address, "
                           "or leave the prefix out to name one host",
                           *from));
  }
  entry.network = network->address;
  entry.prefix = network->prefix;
  return entry;
}

void read_allow(const JsonNode& node, ListenerSettings& settings, ConfigFaults& faults) {
  settings.has_allow = node.has("allow");
  std::vector<std::string> pointers;
  for (const JsonNode& item : node["allow"].items()) {
    const AllowEntry entry = read_allow_entry(item, faults);
    const auto same = std::ranges::find_if(settings.allow, [&](const AllowEntry& other) {
      return other.network == entry.network && other.prefix == entry.prefix;
    });
    if (same != settings.allow.end() && !faults.within(item.pointer())) {
      const auto first = pointers[static_cast<std::size_t>(same - settings.allow.begin())];
      faults.add(item.pointer("from"), fmt::format("the same network as in {}: remove one of the two", first));
    }
    settings.allow.push_back(entry);
    pointers.push_back(item.pointer());
  }
}

bool is_everybody(const AllowEntry& entry) {
  for (const char* all : {"0.0.0.0/0", "::/0"})
    if (const auto network = parse_network(all); entry.network == network->address && entry.prefix == network->prefix)
      return true;
  return false;
}

void warn_about_reach(const JsonNode& node, const ListenerSettings& settings, ConfigFaults& faults) {
  if (settings.has_allow && settings.allow.empty())
    faults.warn(node.pointer("allow"), "names nobody, so nobody can connect: name a network, or leave `allow` out");
  if (is_loopback(settings.host)) return;
  for (std::size_t i = 0; i < settings.allow.size(); ++i)
    if (settings.allow[i].role == Role::engineer && is_everybody(settings.allow[i]))
      faults.warn(fmt::format("{}/{}/role", node.pointer("allow"), i),
                  "every host that reaches this address is engineer, and may write limits and any object of a drive: "
                  "name the engineers' own addresses");
  if (!settings.has_allow) {
    faults.warn(
        node.pointer("listen"),
        "without `allow`, every host that reaches this address may read all axes; clients on other hosts cannot write");
  }
  if (settings.client_is_address) {
    faults.warn(
        node.pointer("client"),
        "all connections from one address are one client: behind a NAT or a container's proxy, that is everybody");
  }
}

ListenerSettings read_listener(const JsonNode& node, ConfigFaults& faults) {
  ListenerSettings settings;
  settings.port = 0;  // until it is known: two listeners that both lack it do not collide
  settings.low_word_first = node.text("word_order") == "low-first";
  settings.float_numbers = node.text("numbers") == "float";
  settings.staged_halves = node.text("halves") == "staged";
  settings.per_axis_units = node.text("unit_ids") == "per-axis";
  settings.client_is_address = node.text("client") == "address";
  settings.posted_writes = node.text("writes") == "posted";
  settings.offline_reads_fail = node.text("offline_reads") == "exception";
  settings.rearm = node.milliseconds("rearm_ms", settings.rearm);
  settings.start_deadline = node.milliseconds("start_deadline_ms", settings.start_deadline);
  settings.reply_deadline = node.milliseconds("reply_deadline_ms", settings.reply_deadline);
  settings.max_clients = static_cast<std::uint32_t>(node.integer("max_clients").value_or(settings.max_clients));
  settings.max_clients_per_address =
      static_cast<std::uint32_t>(node.integer("max_clients_per_address").value_or(settings.max_clients_per_address));
  read_allow(node, settings, faults);

  const auto listen = node.string("listen");
  if (!listen || faults.within(node.pointer("listen"))) return settings;
  const auto endpoint = parse_endpoint(*listen);
  if (!endpoint) {
    faults.add(node.pointer("listen"),
               fmt::format("'{}' is no address and port: write \"127.0.0.1:1502\", \"0.0.0.0:1502\" or \"[::]:1502\"",
                           *listen));
    return settings;
  }
  if (is_group_address(endpoint->host)) {
    faults.add(
        node.pointer("listen"),
        fmt::format("'{}' is the address of many hosts, and a TCP server listens on one of this host's own: write "
                    "such as \"127.0.0.1:1502\", or \"0.0.0.0:1502\" for all of them",
                    *listen));
    return settings;
  }
  settings.host = endpoint->host;
  settings.port = endpoint->port;
  warn_about_reach(node, settings, faults);
  return settings;
}

bool collide(const ListenerSettings& a, const ListenerSettings& b) {
  return a.port != 0 && a.port == b.port && (a.host == b.host || is_any_address(a.host) || is_any_address(b.host));
}

}  // namespace

Role role_named(std::string_view name) {
  for (const Role role : {Role::viewer, Role::operator_, Role::engineer}) {
    if (name == axisgate::text(role)) return role;
  }
  return Role::none;
}

std::vector<ListenerSettings> read_listeners(const JsonNode& root, ConfigFaults& faults) {
  std::vector<ListenerSettings> listeners;
  if (!root.has("modbus_tcp")) {
    faults.add("/modbus_tcp",
               "there is no listener, so nobody could reach the gateway: add [{\"listen\": \"127.0.0.1:1502\"}]");
  }
  std::vector<std::string> pointers;
  for (const JsonNode& node : root["modbus_tcp"].items()) {
    const ListenerSettings settings = read_listener(node, faults);
    for (std::size_t i = 0; i < listeners.size(); ++i) {
      if (!collide(listeners[i], settings)) continue;
      faults.add(node.pointer("listen"), fmt::format("port {} is taken by {}: give each listener a port of its own",
                                                     settings.port, pointers[i]));
      break;
    }
    listeners.push_back(settings);
    pointers.push_back(node.pointer());
  }
  return listeners;
}

}  // namespace axisgate::config
