// SPDX-License-Identifier: Apache-2.0
// What requests the Modbus-TCP server was asked and how they ended, of all sessions together.
// Promises that each only grows: no client can clear it, as function 8 clears DiagnosticCounters. Never used to decide
// anything.
#pragma once

#include <array>
#include <cstdint>

#include "gateway/core/error.hpp"
#include "gateway/core/time_counts.hpp"

namespace axisgate::modbus_tcp {

struct RequestFigures {
  std::uint64_t requests = 0;  ///< well-formed frames received
  /// Exception answers by their code.
  std::array<std::uint64_t, static_cast<std::size_t>(ModbusException::gateway_target_failed) + 1> exceptions{};
  TimeCounts took{};  ///< from its arrival to its answer: of a read, which is answered at once, nothing
};

}  // namespace axisgate::modbus_tcp
