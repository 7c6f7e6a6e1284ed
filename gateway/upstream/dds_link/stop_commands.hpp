// SPDX-License-Identifier: Apache-2.0
// Which numbers of AxisCommand.command are stops (schemas/axisgate.idl): they pass what waits, in both programs.
// Promises the gateway's own numbers: the gateway, which knows both, does not compile where one differs.
// Never says what a stop does.
#pragma once

#include <cstdint>

namespace axisgate::dds {

inline constexpr std::uint8_t kFirstStopCommand = 2, kLastStopCommand = 4;  ///< disable, quick_stop, halt
inline constexpr std::uint8_t kJogEndCommand = 33;

[[nodiscard]] constexpr bool is_stop_command(std::uint8_t command) {
  return (command >= kFirstStopCommand && command <= kLastStopCommand) || command == kJogEndCommand;
}

}  // namespace axisgate::dds
