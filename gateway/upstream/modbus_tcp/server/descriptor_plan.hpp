// SPDX-License-Identifier: Apache-2.0
// How many clients the limit on open files leaves room for, and where their sockets go.
// libmodbus waits for its serial port with select(), which breaks on descriptors of 1024 and more: those below belong
// to serial ports. Promises that no number of clients pushes a port above 1023, also one that is reopened while all of
// them are connected. Never looks at the system: limits in, plan out.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate::modbus_tcp {

inline constexpr std::uint64_t kSelectLimit = 1024;  ///< FD_SETSIZE of the libmodbus we link

/// Kept free of clients: standard streams, event loop, timers, signals, the log, a socket between accept and its move,
/// files read at start, what a starting program has left open.
inline constexpr std::uint64_t kBaseDescriptors = 64;
/// A port, the watch on its path, and what a protocol's library opens beside it.
inline constexpr std::uint64_t kDescriptorsPerBus = 4;

struct DescriptorLimits {
  std::uint64_t soft = 0;  ///< in force: every descriptor is below it
  std::uint64_t hard = 0;  ///< how far this process may raise it
};

struct DescriptorNeeds {
  std::uint32_t clients = 0;  ///< max_clients of all listeners
  std::uint64_t listeners = 1;
  std::uint64_t buses = 0;
  std::uint64_t others = 0;  ///< of other servers
  /// All but the clients.
  [[nodiscard]] std::uint64_t reserve() const {
    return kBaseDescriptors + kDescriptorsPerBus * buses + listeners + others;
  }
  /// The limit under which every client finds room above 1023.
  [[nodiscard]] std::uint64_t limit() const { return kSelectLimit + clients + reserve(); }
};

struct DescriptorPlan {
  std::uint64_t soft_limit = 0;   ///< to be set; never below the one in force, never more than is needed
  bool move_up = false;           ///< accepted sockets go to 1024 and above; without it all stays below 1024
  std::uint32_t max_clients = 0;  ///< of all listeners together
  DescriptorNeeds needs;
  /// Fewer clients than the configuration allows.
  [[nodiscard]] bool limited() const { return max_clients < needs.clients; }
};

[[nodiscard]] DescriptorPlan plan_descriptors(const DescriptorLimits& limits, const DescriptorNeeds& needs);

/// For log, event and `check`, where a plan is limited: what follows and what to change. Empty otherwise.
[[nodiscard]] std::string text(const DescriptorPlan& plan);

}  // namespace axisgate::modbus_tcp
