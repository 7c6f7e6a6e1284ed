// SPDX-License-Identifier: Apache-2.0
// Who is at the other end of a connection: its address, and what the listener lets it do.
// Promises one way of writing addresses, in log lines and in the names of clients alike.
// Never changes while the connection stands.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"

namespace axisgate::modbus_tcp {

struct Peer {
  Address address{};
  std::uint16_t port = 0;
  Role role = Role::viewer;
  std::uint8_t rank = 0;
};

inline constexpr std::size_t kMappedBytes = 12;  ///< ::ffff: before the four bytes of IPv4

/// The way people write it: mapped IPv4 in dots.
[[nodiscard]] std::string text(const Address& address);
[[nodiscard]] bool is_mapped(const Address& address);
/// "192.168.1.7:51234", "[fe80::1]:51234".
[[nodiscard]] std::string text(const Peer& peer);

}  // namespace axisgate::modbus_tcp
