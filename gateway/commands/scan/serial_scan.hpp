// SPDX-License-Identifier: Apache-2.0
// `axisgate scan DEVICE` on a serial port: who answers there, in which protocol, at which rate and station.
// Promises to say before how long it takes at most, and to end: with what was found, or with the reason for which the
// port cannot be used. Never sends anything but reads.
#pragma once

#include "gateway/commands/scan/scan_command.hpp"

namespace axisgate::commands {

/// As run(ScanOptions), of a device that is a serial port.
[[nodiscard]] int run_serial_scan(const ScanOptions& options);

}  // namespace axisgate::commands
