// P2 against a drive that answers after 5 ms: the share of a bare loop's exchange rate that the gateway reaches.
// Promises exchanges counted by the gateway's own bus block, beside the drive's count. Never pauses a client by itself.
// Never judges: the goal (95 %) stands in the output.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/line_protocol.hpp"

namespace axisgate::bench {

void delayed_drive(const BenchOptions& options, LineProtocol protocol);

}  // namespace axisgate::bench
