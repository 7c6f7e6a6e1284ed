// SPDX-License-Identifier: Apache-2.0
// Who owns an axis, and until when (design 3.5), in words that every server and the drive layer share.
// Promises that a lease can be judged at any time from what is in it, without asking anybody.
// Never decides what becomes of an axis whose lease has run out: gateway/drive/motion/ownership.hpp does.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "gateway/core/clock.hpp"

namespace axisgate {

enum class Role : std::uint8_t { none = 0, viewer = 1, operator_ = 2, engineer = 3 };

/// One client of any server: a TCP connection, a host (listener option "client": "address"), a DDS writer. Never
/// reused.
using ClientId = std::uint64_t;

/// Where a client comes from: its IP address (IPv4 mapped into IPv6), or a DDS participant's GUID.
using Origin = std::array<std::uint8_t, 16>;

/// What its server knows of one client, kept up to date as long as anybody asks. The server alone writes it.
struct ClientLife {
  ClientId id = 0;
  Role role = Role::viewer;
  std::uint8_t rank = 0;  ///< 0..9: command take_over takes an axis from a lower one
  Origin origin{};
  std::string name;                 ///< "192.168.1.7:51234", for events
  Instant last_request = kLongAgo;  ///< any request, reads included; of an address, accepted writes alone
  Instant heartbeat = kLongAgo;     ///< gateway register 8 was written with another value than before
  bool connected = true;            ///< false: its connection has ended, its leases are orphans
  /// When its connection was opened, the oldest of those that an address has. None: of a DDS writer, whose origin is
  /// one program.
  std::optional<Instant> opened{};
  /// Another writer of its program, whose leases are its own as if that one had gone. 0: none.
  ClientId goes_on_for = 0;
  bool is_address = false;  ///< listener option "client": "address": a host, with all its connections
  /// Of a DDS writer: OWNERSHIP_STRENGTH (DDS 1.4, 2.2.3.10). A stronger one takes an axis from a weaker one.
  std::optional<std::int32_t> strength{};
  /// Its leases are no longer than this, whatever their rules say: it has asked for a shorter one.
  std::optional<Duration> lease_limit{};
  /// Nobody can hear it from `since` on, and that is not its fault: its signs of life of until then count for longer.
  struct Grace {
    Duration length{};
    Instant since = kLongAgo;
  };
  Grace grace{};
};

/// The same program, as far as anybody can tell: a connection that goes on where another one of it has ended.
[[nodiscard]] inline bool same_origin_and_role(const ClientLife& a, const ClientLife& b) {
  return a.origin == b.origin && a.role == b.role;
}

/// It can be the gone owner's program, come back. One that was connected while the owner still asked is another program
/// at its address.
[[nodiscard]] inline bool may_be_back_as(const ClientLife& client, const ClientLife& owner) {
  if (client.goes_on_for != 0 && client.goes_on_for == owner.id) return true;
  return same_origin_and_role(client, owner) && !owner.connected &&
         (!client.opened || *client.opened >= owner.last_request);
}

/// What keeps a lease alive.
enum class LeaseRenewal : std::uint8_t {
  any,        ///< any request of the owner
  write,      ///< a write to this axis
  heartbeat,  ///< a changed value in register 56 of the axis or 8 of the gateway
};

/// What is done to an enabled axis whose lease has run out.
enum class LeaseAction : std::uint8_t { none, quick_stop, halt, disable };

/// Configuration key "lease" of an axis.
struct LeaseRules {
  bool on = true;  ///< false ("lease": null): nobody owns the axis, nobody is refused, nothing runs out
  Duration timeout = std::chrono::milliseconds(2000);
  LeaseAction on_expiry = LeaseAction::quick_stop;
  LeaseRenewal renew = LeaseRenewal::any;
  friend bool operator==(const LeaseRules&, const LeaseRules&) = default;
};

/// The lease of one axis as the image shows it.
struct Lease {
  std::shared_ptr<const ClientLife> owner{};  ///< none: nobody owns the axis
  bool running = false;        ///< without an owner: open to every operator, and on_expiry waits at its end
  bool any_sign = false;       ///< the axis may hold torque: its owner's signs of life count, not what it asks alone
  Instant renewed = kLongAgo;  ///< taken, or renewed by what was asked of this axis
  LeaseRules rules{};
  /// When it runs out as things stand; kNever where nothing does.
  [[nodiscard]] Instant until() const {
    if (!running) return kNever;
    const Instant sign = last_sign();
    return sign + timeout() + (owner && sign <= owner->grace.since ? owner->grace.length : Duration{});
  }
  [[nodiscard]] Duration timeout() const {
    return owner && owner->lease_limit ? std::min(rules.timeout, *owner->lease_limit) : rules.timeout;
  }
  /// The owner's newest sign of life that counts: while the axis is disabled, only what asks for something does, so
  /// that an idle program that scans and a panel share it.
  [[nodiscard]] Instant last_sign() const {
    if (!owner || !any_sign) return renewed;
    if (rules.renew == LeaseRenewal::any) return std::max(renewed, owner->last_request);
    return rules.renew == LeaseRenewal::heartbeat ? std::max(renewed, owner->heartbeat) : renewed;
  }
  [[nodiscard]] bool owned_by(ClientId client) const { return owner && owner->id == client; }
};

}  // namespace axisgate
