// SPDX-License-Identifier: Apache-2.0
// Opens and configures a serial device: one system call after another, blocking ones none.
// Promises a descriptor that is raw, non-blocking, closed on exec and ours alone, or a text that names the device and
// the reason. Never touches the settings of a port that another process has.
#pragma once

#include <string>
#include <vector>

#include "adapters/serial/serial_settings.hpp"

namespace axisgate::serial {

struct OpenedPort {
  int descriptor = -1;             ///< the caller's to close; -1: not opened
  std::string error;               ///< where not opened
  std::vector<std::string> notes;  ///< what the driver did not do as asked, for the log
};

[[nodiscard]] OpenedPort open_port(const SerialSettings& settings);

}  // namespace axisgate::serial
