// SPDX-License-Identifier: Apache-2.0
// What the gateway is measured against: the same exchanges by a loop of write, poll and read, and nothing else; on
// Modbus RTU by libmodbus's own client. Promises one exchange at a time, from the end of the one before it to the
// reply's last byte: a parameter is written, the statusword read, and so on.
// Never checks more of a reply than tells it from others, and never runs beside anything else on the line.
#pragma once

#include "tests/bench/drive_process.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {

/// Between two frames on Modbus RTU, above 19200 baud (Modbus over serial line V1.02, 2.5.1.1).
inline constexpr std::chrono::microseconds kFrameSilence{1750};

/// Microseconds of each exchange in `lasting`. `silence`: on Modbus RTU, before each and part of its time, since the
/// standard wants it and libmodbus does not keep it.
[[nodiscard]] Samples bare_exchanges(const DriveProcess& drives, std::chrono::milliseconds lasting,
                                     std::chrono::microseconds silence = kFrameSilence);

}  // namespace axisgate::bench
