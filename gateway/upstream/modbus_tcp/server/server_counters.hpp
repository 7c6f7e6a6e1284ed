// SPDX-License-Identifier: Apache-2.0
// What the Modbus-TCP server has done since its start, of all listeners together.
// Promises that every connection is counted once where it was accepted or refused, and once where it ended.
// Never reset while the gateway runs.
#pragma once

#include <cstdint>

namespace axisgate::modbus_tcp {

struct ServerCounters {
  std::uint64_t accepted = 0;
  std::uint64_t refused_not_allowed = 0;  ///< no `allow` entry names the address
  std::uint64_t refused_full = 0;         ///< a client limit, or no descriptor free for it
  std::uint64_t accept_pauses = 0;        ///< the system had no descriptor or memory: accepting waited
  std::uint64_t closed_by_peer = 0;       ///< ended by the client, or its link was lost
  std::uint64_t closed_malformed = 0;     ///< bytes that are no Modbus-TCP frame
  std::uint64_t closed_late = 0;          ///< slow request, reply not taken, idle
  std::uint32_t open = 0;
};

}  // namespace axisgate::modbus_tcp
