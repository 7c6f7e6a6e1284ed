// SPDX-License-Identifier: Apache-2.0
// What one axis has done and met since the gateway's start. Counted where it happens, so that nothing is missed between
// two looks. Promises that each of it only grows, over reloads too. Never used to decide anything.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "gateway/core/clock.hpp"
#include "gateway/core/error.hpp"

namespace axisgate {

enum class Command : std::uint8_t;

struct AxisCounts {
  std::uint32_t faults = 0;             ///< a fault that lasts is one, over a loss of its link too
  std::uint32_t lease_expiries = 0;     ///< leases that have run out
  Duration enabled{};                   ///< how long the drive has shown torque
  std::uint64_t travel_microturns = 0;  ///< the way of the motor, to and fro, 1e-6 turns
  /// Clients' commands by how they ended: as many rows as there are commands and results.
  std::map<std::pair<Command, CommandResult>, std::uint32_t> commands{};
};

}  // namespace axisgate
