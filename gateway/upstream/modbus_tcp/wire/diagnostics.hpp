// SPDX-License-Identifier: Apache-2.0
// Diagnostics (function 8): the counters of the Modbus-TCP server and the sub-functions that show them.
// Promises that each request received is counted once as a message and, where it got none, once as not answered.
// Never touches a drive: the serial-line sub-functions do not exist here.
#pragma once

#include <cstdint>

#include "gateway/image/command.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

namespace axisgate::modbus_tcp {

/// MODBUS Application Protocol V1.1b3 6.8, sub-functions 11 to 15. 32 bits here; a reply shows the low 16.
struct DiagnosticCounters {
  std::uint32_t messages = 0;         ///< 11: well-formed frames received
  std::uint32_t malformed = 0;        ///< 12: connections closed because of bytes that are no frame
  std::uint32_t exceptions = 0;       ///< 13: exception replies
  std::uint32_t server_messages = 0;  ///< 14: requests processed, whatever the answer
  std::uint32_t unanswered = 0;       ///< 15: requests whose connection ended before their reply
};

/// Sub-functions 0 (return the data), 10 (clear counters; engineer) and 11 to 15 (viewer and above).
[[nodiscard]] Pdu answer_diagnostics(const Request& request, Role role, DiagnosticCounters& counters);

}  // namespace axisgate::modbus_tcp
