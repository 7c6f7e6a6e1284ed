// SPDX-License-Identifier: Apache-2.0
// The settings of one Modbus-TCP listener (design sections 3 and 5), with their defaults.
// Promises values within their documented ranges: the configuration was checked before.
// Never changes while the gateway runs.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::modbus_tcp {

/// An address as 16 bytes, IPv4 mapped to ::ffff:a.b.c.d, so that one comparison serves both families.
using Address = std::array<std::uint8_t, 16>;

struct AllowEntry {
  Address network{};
  std::uint8_t prefix = 128;  ///< bits of `network` that count (96 more than written for IPv4)
  Role role = Role::viewer;
  std::uint8_t rank = 0;
  friend bool operator==(const AllowEntry&, const AllowEntry&) = default;
};

struct ListenerSettings {
  std::string host = "127.0.0.1";
  std::uint16_t port = 1502;
  bool low_word_first = false;
  bool float_numbers = false;  ///< "numbers": "float": 32-bit positions, velocities and accelerations as IEEE 754
  bool staged_halves = false;  ///< "halves": "staged": function 6 writes a 32-bit row in two requests
  bool per_axis_units = false;
  bool client_is_address = false;  ///< "client": "address": all connections of one host are one client
  bool posted_writes = false;
  bool offline_reads_fail = false;  ///< "offline_reads": "exception"
  bool has_allow = false;           ///< with `allow`, an address it does not name is closed at accept
  std::vector<AllowEntry> allow;
  Duration rearm = std::chrono::milliseconds(1000);
  Duration start_deadline = std::chrono::milliseconds(500);
  Duration reply_deadline = std::chrono::milliseconds(900);
  Duration request_deadline = std::chrono::seconds(5);  ///< a whole request from its first byte; a reply from its first
  Duration idle_timeout = std::chrono::seconds(60);     ///< 0: none
  std::uint32_t max_clients = 1000;
  std::uint32_t max_clients_per_address = 64;  ///< 0: no limit
  friend bool operator==(const ListenerSettings&, const ListenerSettings&) = default;
};

[[nodiscard]] inline bool same_address(const ListenerSettings& a, const ListenerSettings& b) {
  return a.host == b.host && a.port == b.port;
}
/// "0.0.0.0:1502", "[::1]:1502".
[[nodiscard]] inline std::string address_text(const std::string& host, std::uint16_t port) {
  const bool v6 = host.find(':') != std::string::npos;
  return (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

}  // namespace axisgate::modbus_tcp
