// SPDX-License-Identifier: Apache-2.0
// What a configuration says about a serial port.
// Promises defaults that suit the Kinco drives: 38400 baud, 8 data bits, no parity, 1 stop bit (kinco-jd.md 2.0).
// Never says what is spoken on the line.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate::serial {

enum class Parity : std::uint8_t { none, even, odd };

/// Who turns the direction of a two-wire line. `off`: nobody, or the adapter by itself, as most USB ones do; the
/// driver's own setting is left alone. `automatic`: the driver by RTS, where it offers that.
enum class Rs485 : std::uint8_t { off, automatic };

struct SerialSettings {
  std::string device;          ///< a path, best a stable one: /dev/serial/by-id/... or by-path/...
  std::uint32_t baud = 38400;  ///< any rate the driver can make, not only the customary ones
  Parity parity = Parity::none;
  Rs485 rs485 = Rs485::off;
};

}  // namespace axisgate::serial
