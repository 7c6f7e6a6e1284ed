// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/client/host_port.hpp"

#include <fmt/format.h>

#include <charconv>

#include "gateway/config/config_endpoint.hpp"

namespace axisgate::commands {

std::optional<HostPort> parse_host_port(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view digits = text.substr(colon + 1);
  HostPort place{std::string(host), 0};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), place.port);
  if (error != std::errc() || end != digits.data() + digits.size() || place.port == 0) return std::nullopt;
  return place;
}

HostPort reached_here(HostPort place) {
  if (config::is_any_address(place.host)) place.host = place.host == "::" ? "::1" : "127.0.0.1";
  return place;
}

std::string host_port_mistake(std::string_view text) {
  return fmt::format("'{}' is no HOST:PORT: write 127.0.0.1:1502, gateway.local:1502 or [::1]:1502", text);
}

}  // namespace axisgate::commands
