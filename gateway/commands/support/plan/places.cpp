// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/support/plan/places.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gateway/config/config_endpoint.hpp"
#include "gateway/upstream/web/web_settings.hpp"

namespace axisgate::commands::support {
namespace {

using nlohmann::json;

/// The text at a key; empty: none.
std::string text_at(const json& object, const char* key) {
  if (!object.is_object()) return {};
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// The list at a key; empty: none.
json list_at(const json& object, const char* key) {
  if (!object.is_object()) return json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : json::array();
}

/// As one on this computer reaches it.
std::optional<HostPort> reached(std::string_view listen) {
  const auto endpoint = config::parse_endpoint(listen);
  if (!endpoint) return std::nullopt;
  return reached_here({endpoint->host, endpoint->port});
}

}  // namespace

Device device_of(std::string bus, std::string_view device) {
  constexpr std::string_view kSerialCan = "slcan:";
  Device out{.bus = std::move(bus), .path = {}};
  const bool is_adapter = device.starts_with(kSerialCan);
  if (is_adapter) device = device.substr(kSerialCan.size());
  if (!device.starts_with('/')) {
    out.interface = device;
    return out;
  }
  // The rate of an adapter's own serial port.
  if (const std::size_t at = device.rfind('@'); is_adapter && at != std::string_view::npos)
    device = device.substr(0, at);
  out.path = device;
  return out;
}

Places places_of(std::string_view configuration) {
  Places out;
  const json document = json::parse(configuration, nullptr, false);
  if (!document.is_object()) return out;
  for (const json& bus : list_at(document, "buses")) {
    if (const std::string device = text_at(bus, "device"); !device.empty() && out.devices.size() < kMostDevices)
      out.devices.push_back(device_of(text_at(bus, "name"), device));
    for (const json& drive : list_at(bus, "drives")) {
      const std::string profile = text_at(drive, "profile");
      if (!profile.empty() && std::ranges::find(out.profiles, profile) == out.profiles.end() &&
          out.profiles.size() < kMostProfiles)
        out.profiles.push_back(profile);
    }
  }
  if (const auto page = document.find("web"); page != document.end() && page->is_object()) {
    const std::string listen = text_at(*page, "listen");
    out.page = reached(listen.empty() ? web::WebSettings().listen : listen);
  }
  for (const json& listener : list_at(document, "modbus_tcp"))
    if (!out.listener) out.listener = reached(text_at(listener, "listen"));
  return out;
}

}  // namespace axisgate::commands::support
