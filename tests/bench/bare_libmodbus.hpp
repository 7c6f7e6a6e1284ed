// What the gateway is measured against on Modbus RTU: the same requests by libmodbus's own client in a loop, and
// nothing else. Promises one exchange at a time, timed from the call to its return, and if asked the silence before
// each that the standard wants and libmodbus does not keep. Never checks more of a reply than libmodbus does.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace axisgate::bench {

/// Between two frames, above 19200 baud (Modbus over serial line V1.02, 2.5.1.1).
inline constexpr std::chrono::microseconds kFrameSilence{1750};

/// As bare_exchanges() of bare_loop.hpp. `silence`: waited for before each exchange and part of its time.
[[nodiscard]] std::vector<double> bare_rtu_exchanges(const std::string& device, std::chrono::microseconds silence,
                                                     std::chrono::milliseconds lasting);

}  // namespace axisgate::bench
