// SPDX-License-Identifier: Apache-2.0
// `axisgate top [HOST:PORT]`: a live table of all axes of a running gateway, over Modbus-TCP.
// Promises to come back by itself when the gateway restarts, and to say so meanwhile; Ctrl-C ends it with status 0.
// Never writes a register.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace axisgate::commands {

struct TopOptions {
  /// "HOST:PORT", HOST a name or an address, IPv6 in brackets; empty: the gateway of this computer, with the names that
  /// it tells.
  std::string endpoint;
  std::uint32_t interval_ms = 500;  ///< from one table to the next
  std::uint32_t seconds = 0;        ///< end after so long; 0: until Ctrl-C
  std::uint32_t count = 0;          ///< end after so many tables; 0: no such end
  bool plain = false;               ///< one table after the other, also on a terminal
  /// The gateway's configuration file, for the axes' names and turns (empty: numbers alone), and without an endpoint
  /// for the place where it listens (empty: that of the service).
  std::string config{};
  std::vector<std::string> notes{};  ///< lines below the table, on a terminal
  std::vector<std::string> profile_folders{};
};

/// Exit status: 0 after Ctrl-C, the last table or the last second; 1 where no table could be shown by then, or where
/// one single table was asked for and the gateway did not answer; 2 for an endpoint that is none.
[[nodiscard]] int run(const TopOptions& options);

}  // namespace axisgate::commands
