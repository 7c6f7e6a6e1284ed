// SPDX-License-Identifier: Apache-2.0
// Reads the two texts of a listener that name places in a network: "HOST:PORT" and "ADDRESS/PREFIX".
// Promises numeric addresses only, so that reading a configuration never asks a name server.
// Never opens a socket.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"

namespace axisgate::config {

struct Endpoint {
  std::string host;  ///< as the system prints it, without brackets
  std::uint16_t port = 0;
};

/// "127.0.0.1:1502", "[::]:1502". No value: not of that form.
[[nodiscard]] std::optional<Endpoint> parse_endpoint(std::string_view text);
/// "0.0.0.0" or "::".
[[nodiscard]] bool is_any_address(std::string_view host);
[[nodiscard]] bool is_loopback(std::string_view host);
/// Multicast (224.0.0.0/4, ff00::/8) or 255.255.255.255: TCP has no connection to more than one host.
[[nodiscard]] bool is_group_address(std::string_view host);

struct Network {
  modbus_tcp::Address address{};
  std::uint8_t prefix = 128;    ///< 96 more than written for IPv4
  bool host_bits_clear = true;  ///< "192.168.1.7/24" names a host inside the network it means
};

/// "192.168.1.7", "192.168.1.0/24", "fd00::/8". No value: not of that form.
[[nodiscard]] std::optional<Network> parse_network(std::string_view text);

}  // namespace axisgate::config
