// SPDX-License-Identifier: Apache-2.0
// `axisgate scan DEVICE`: which nodes answer on a CANopen bus, who they say they are, and which profile fits them; of a
// serial port which stations answer (serial_scan).
// Promises to end: with what was found, or with the reason for which the bus cannot be used and what to do about it.
// Never sends anything but reads: nothing is written, started, stopped or reset.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/commands/scan/plan/scan_plan.hpp"
#include "gateway/commands/scan/plan/serial_scan_plan.hpp"

namespace axisgate::commands {

struct ScanOptions {
  std::string device;  ///< "can0", "slcan:PATH", or the path of a serial port
  std::uint32_t bitrate = 500'000;
  std::uint32_t timeout_ms = 100;  ///< for each answer
  ScanRange nodes;
  SerialScanSettings serial{};  ///< of a serial port
  std::string parity = "none";  ///< the same
  std::vector<std::string> profile_folders;
};

/// Exit status: 0 where a node was found; 1 where nobody answered, the bus cannot be used or was lost meanwhile; 2 for
/// a device or a bit rate that is none.
[[nodiscard]] int run(const ScanOptions& options);

}  // namespace axisgate::commands
