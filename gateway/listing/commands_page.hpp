// SPDX-License-Identifier: Apache-2.0
// The chapter on commands of schemas/register-map.md: when a command acts, and four clients cycle by cycle.
// Promises that its tables of cycles are data, so that a test replays them against the gateway as they stand.
// Never decides anything: the rules are in upstream/modbus_tcp (edges) and drive (motion).
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace axisgate::listing {

/// What the motor does when the answer is there, and until the next cycle.
enum class MotorDoes : std::uint8_t {
  stands,
  starts,   ///< it stood, and turns now
  arrives,  ///< it turned, and stands at the target that was accepted last
  stops,    ///< it turned, and stands before its target
};

/// A result that this request does not change.
inline constexpr std::uint16_t kAsBefore = 0xFFFF;

struct Cycle {
  std::string_view client;  ///< "PLC" or "panel"
  /// Rows or coils that change, "name value" with ", " between; the others of a scanner's image keep their values.
  /// Empty: the same once more.
  std::string_view writes;
  std::uint8_t exception = 0;  ///< of the answer; 0: none
  std::uint16_t result = 0;    ///< register 25 afterwards, as this client reads it, or kAsBefore
  std::uint16_t state = 0;     ///< register 31 afterwards
  MotorDoes motor = MotorDoes::stands;
  std::string_view why;
};

struct CycleTable {
  enum class How : std::uint8_t {
    scanner,  ///< each request is one block, registers 40 to 55, sent again and again
    single    ///< each request is one row or one coil
  };
  std::string_view title;
  std::string_view text;
  How plc = How::scanner;  ///< a panel writes single rows and coils
  bool new_connection_each = false;
  bool leases = true;
  std::span<const Cycle> cycles;
};
[[nodiscard]] std::span<const CycleTable> cycle_tables();

[[nodiscard]] std::string commands_page();

}  // namespace axisgate::listing
