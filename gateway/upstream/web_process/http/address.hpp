// SPDX-License-Identifier: Apache-2.0
// Addresses of those who look, which networks may, and by which names they may call this server.
// Promises one comparison for both families: IPv4 is mapped into IPv6.
// Never asks a name server: a name is compared as it is written.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::web {

/// IPv4 as ::ffff:a.b.c.d.
using Address = std::array<std::uint8_t, 16>;

/// "192.168.1.7", "fd00::1"; none: it is no address.
[[nodiscard]] std::optional<Address> parse_address(std::string_view text);
[[nodiscard]] std::string text(const Address& address);
[[nodiscard]] bool is_loopback(const Address& address);
/// Whom a count is kept for: an IPv4 address, of IPv6 the network of 64 bits, of which one host has as many as it
/// likes.
[[nodiscard]] Address counted_as(const Address& address);

struct Network {
  Address address{};
  unsigned bits = 128;  ///< that count; of IPv4 96 more than written
  [[nodiscard]] bool holds(const Address& other) const;
};
/// "192.168.1.0/24", "fd00::/8", an address alone.
[[nodiscard]] std::optional<Network> parse_network(std::string_view text);

/// Whether a request's Host is ours: the address that was reached, "localhost", or one of `hosts`, whatever the port
/// (a port can be mapped, a name is what a rebinding page would change). @param field "[fd00::1]:8080", "plant:80"
[[nodiscard]] bool names_us(std::string_view field, const Address& reached, const std::vector<std::string>& hosts);

}  // namespace axisgate::web
