// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/client/own_gateway.hpp"

#include <nlohmann/json.hpp>

namespace axisgate::commands {
namespace {

using Json = nlohmann::json;

/// Of an object; null: it has none, or is none.
const Json& member(const Json& of, const char* name) {
  static const Json kNone;
  const auto found = of.is_object() ? of.find(name) : of.end();
  return found == of.end() ? kNone : *found;
}

bool is_own(const std::string& host) { return host.starts_with("127.") || host == "::1"; }

std::optional<HostPort> listener_in(const Json& listeners) {
  std::optional<HostPort> first;
  for (const Json& each : listeners) {
    const Json& listen = member(each, "listen");
    auto place = listen.is_string() ? parse_host_port(listen.get<std::string>()) : std::nullopt;
    if (!place) continue;
    if (is_own(place->host)) return place;
    if (first) continue;
    first = reached_here(*std::move(place));
  }
  return first;
}

void add_axes(AxisNames& names, const Json& drive) {
  for (const Json& axis : member(drive, "axes")) {
    const Json& number = member(axis, "axis");
    const Json& name = member(axis, "name");
    if (!number.is_number_unsigned()) continue;
    const auto called = axis_number_in(number.dump());
    if (called) names[*called] = name.is_string() ? name.get<std::string>() : "axis " + std::to_string(*called);
  }
}

}  // namespace

std::optional<OwnGateway> own_gateway_in(std::string_view configuration) {
  const Json root = Json::parse(configuration, nullptr, false);
  const auto place = listener_in(member(root, "modbus_tcp"));
  if (!place) return std::nullopt;
  OwnGateway own{*place, {}};
  for (const Json& bus : member(root, "buses"))
    for (const Json& drive : member(bus, "drives")) add_axes(own.names, drive);
  return own;
}

}  // namespace axisgate::commands
