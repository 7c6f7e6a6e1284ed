// SPDX-License-Identifier: Apache-2.0
// The numbers by which an axis is named: 1..499 in a gateway, its place in its drive, its drive's place on its bus.
// Promises that all rooms count alike. Never a place in the register map, nor a node of a bus.
#pragma once

#include <cstdint>

namespace axisgate {

/// 1..kMaxAxisNumber, as the configuration says; 0: none.
using AxisNumber = std::uint16_t;
inline constexpr AxisNumber kMaxAxisNumber = 499;

/// Position of a drive in the configuration of its bus.
using DriveSlot = std::uint8_t;
/// Position of an axis in its drive; kNoAxis where something is the whole drive's.
using AxisSlot = std::uint8_t;
inline constexpr AxisSlot kNoAxis = 0xFF;

}  // namespace axisgate
