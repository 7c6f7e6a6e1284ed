// The bare loop that belongs to a line's protocol.
// Promises the same exchanges on each: a parameter is written, the statusword read, and so on.
// Never runs beside anything else on the line.
#pragma once

#include "tests/bench/drive_process.hpp"

namespace axisgate::bench {

/// Microseconds of each exchange in `lasting`. `silence`: between frames, on Modbus RTU alone.
[[nodiscard]] std::vector<double> bare_exchanges_of(const DriveProcess& drives, std::chrono::microseconds silence,
                                                    std::chrono::milliseconds lasting);

}  // namespace axisgate::bench
