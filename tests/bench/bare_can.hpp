// What the gateway is measured against on CANopen: the same expedited SDO requests by a loop of write, poll and read,
// on a raw CAN socket or in a Lawicel adapter's text, and nothing else.
// Promises one exchange at a time, timed from before the write to the reply's last byte. Never checks more of a reply
// than its identifier.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "tests/bench/line_protocol.hpp"

namespace axisgate::bench {

/// As bare_exchanges() of bare_loop.hpp.
[[nodiscard]] std::vector<double> bare_can_exchanges(const std::string& device, LineProtocol protocol,
                                                     std::chrono::milliseconds lasting);

}  // namespace axisgate::bench
