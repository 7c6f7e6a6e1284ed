// SPDX-License-Identifier: Apache-2.0
// What a gateway's frames ask of motors, read from the bytes of a line: which are control commands, which are stops.
// Promises the frames of the makers' manuals and nothing of the gateway's own codecs. Never looks at a clock, and never
// reads what a drive says.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "tests/simulated/time.hpp"

namespace axisgate::bench {

/// CANopen and Keya's CAN protocol are those of a Lawicel adapter on a serial port, its lines of text.
enum class MotionProtocol : std::uint8_t {
  kinco_serial,
  id286pro_rtu,
  jd_canopen,
  keya_rs232,
  keya_rs485,
  keya_can,
  keya_canopen
};

/// Of the drive with station, unit or node 1. Motors: bit 0 the first (A), bit 1 the second (B).
struct HostCommand {
  std::uint8_t motors = 0;   ///< those it commands
  std::uint8_t stopped = 0;  ///< those of them that it lets stand or takes the torque from
};
inline constexpr std::uint8_t kFirstMotor = 1;
inline constexpr std::uint8_t kSecondMotor = 2;

class HostCommands {
 public:
  virtual ~HostCommands() = default;
  /// A command when this byte was its last. Reads and what else is no command are nothing.
  virtual std::optional<HostCommand> take(std::uint8_t byte, simulated::Time now) = 0;
};

[[nodiscard]] std::unique_ptr<HostCommands> make_host_commands(MotionProtocol protocol);

}  // namespace axisgate::bench
