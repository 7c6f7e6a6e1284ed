// P2 against a drive that answers at once: what the gateway adds to the time of a bare exchange on the same port.
// Promises bare loop and gateway in turns in one run, each placed on the same processors. Never counts a failed write.
// Never judges: the goal (150 us at the median on a host, 300 us in a guest) stands in the output.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/line_protocol.hpp"

namespace axisgate::bench {

void immediate_drive(const BenchOptions& options, LineProtocol protocol);

}  // namespace axisgate::bench
