// Simulated Kinco JD nodes on one CAN bus, behind a Lawicel adapter or a CAN interface, without a bus's own time.
// Promises each SDO reply as the answer, and that nodes look at their clock a few times a second alone: heartbeats are
// kept, and nothing wakes between two exchanges. Never loses or delays a frame.
#pragma once

#include "tests/bench/answering_line.hpp"

namespace axisgate::bench {

/// Nodes 1 to `drives`.
[[nodiscard]] std::unique_ptr<AnsweringLine> make_answering_can(LineProtocol protocol, int drives, simulated::Time now);

}  // namespace axisgate::bench
