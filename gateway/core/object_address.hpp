// SPDX-License-Identifier: Apache-2.0
// The address of an object inside a drive. Promises to hold for every protocol, and to be ordered. Never says what the
// object means: profiles do.
#pragma once

#include <compare>
#include <cstdint>

namespace axisgate {

/// Modbus RTU: the table that a number is of, as ObjectAddress::sub has it.
enum class ModbusTable : std::uint8_t { holding, input, coil, discrete };

/// CiA 301 index and sub-index on CANopen and Kinco's serial protocol; the register and its table on Modbus RTU; index
/// and sub on Keya's CAN; on Keya's serial protocols 0x2100 + query code and 0 for what is asked, 0x200D (on) and
/// 0x2000 (value) with the motor's number 1 or 2 for what is commanded.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::uint8_t byte = 0;  ///< Keya: one answer holds several objects; this one begins here, from 0, in its data
  friend auto operator<=>(const ObjectAddress&, const ObjectAddress&) = default;
};

}  // namespace axisgate
