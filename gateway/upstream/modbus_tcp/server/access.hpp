// SPDX-License-Identifier: Apache-2.0
// Who may connect, and as what: allow-list, roles and client limits of one listener. Pure: addresses and times in,
// verdicts out. Promises that the most specific allow entry decides whatever its place in the list, and that every
// admitted client is counted until it is released. Never opens, closes or looks at a socket.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"
#include "gateway/upstream/modbus_tcp/client/peer.hpp"

namespace axisgate::modbus_tcp {

[[nodiscard]] bool is_loopback(const Address& address);

[[nodiscard]] bool holds(const AllowEntry& entry, const Address& address);
/// Role::none: no entry names it, close at accept. Several entries that hold: the longest prefix decides, as in a
/// routing table, so that reordering the list changes no rights; of equal prefixes the first.
[[nodiscard]] Role role_of(const ListenerSettings& settings, const Address& address);
/// Of the same entry: command take_over takes an axis from a lower one. 0 without `allow`.
[[nodiscard]] std::uint8_t rank_of(const ListenerSettings& settings, const Address& address);

enum class ConnectionVerdict : std::uint8_t {
  admitted,
  not_allowed,
  listener_full,
  address_full,
  kept_for_operators,
  no_descriptor,
};
/// "max_clients (1000) is reached": what a refusal's log line says.
[[nodiscard]] std::string text(ConnectionVerdict verdict, const ListenerSettings& settings);

/// Room that viewers cannot take: the last tenth of max_clients, where `allow` names anyone above a viewer. So a crowd
/// of panels in a wide network never locks out the PLC.
[[nodiscard]] std::uint32_t kept_for_operators(const ListenerSettings& settings);

/// The clients of one listener.
class ClientCounts {
 public:
  /// `descriptors_for`: clients that the descriptor rule leaves room for, whatever the settings say.
  [[nodiscard]] ConnectionVerdict admit(const ListenerSettings& settings, const Address& address, Role role,
                                        std::uint32_t descriptors_for);
  /// Once for each admitted client, with the same address.
  void release(const Address& address);
  [[nodiscard]] std::uint32_t total() const { return total_; }
  [[nodiscard]] std::uint32_t of(const Address& address) const;

 private:
  std::map<Address, std::uint32_t> by_address_;
  std::uint32_t total_ = 0;
};

/// Lets one line through per interval and counts the others.
class LineLimit {
 public:
  explicit LineLimit(Duration interval) : interval_(interval) {}
  /// With a value: write the line, and say that so many like it were left out since the last. Without: leave it out.
  [[nodiscard]] std::optional<std::uint64_t> admit(Instant now);

 private:
  Duration interval_;
  std::optional<Instant> last_;
  std::uint64_t left_out_ = 0;
};

}  // namespace axisgate::modbus_tcp
