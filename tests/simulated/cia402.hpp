// SPDX-License-Identifier: Apache-2.0
// The CiA 402 state machine as the Kinco drives run it: states, the command in a controlword, one table of transitions.
// Promises that 0x06, 0x0B and 0x0F do what JD 6.1 and MD 8.1 print for them.
// Never waits, ramps or looks at a motor: the drive asks and obeys.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace axisgate::simulated {

enum class Cia402State : std::uint8_t {
  not_ready_to_switch_on,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault,
};

enum class Cia402Command : std::uint8_t { disable_voltage, quick_stop, shutdown, switch_on, enable_operation };

std::string_view name_of(Cia402State state);

// The command in bits 0 to 3, bit 7 aside (JD 6.1: bits as CiA 402 has them).
Cia402Command command_in(std::uint16_t controlword);

// Where the command leads from here; nothing if it has no effect. `only_from_ready`: 0x0F is refused before a first
// 0x06 (printed for CANopen only, JD 2.3 "first control word"; the RS232 sequences start with 0x0F at once).
std::optional<Cia402State> next_state(Cia402State from, Cia402Command command, bool only_from_ready);

// Bits 0 to 6 of the statusword in this state; bit 4 is "voltage enabled" (JD K27, MD C16).
std::uint16_t state_bits(Cia402State state);

}  // namespace axisgate::simulated
