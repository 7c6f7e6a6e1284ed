// How long after a client's death its motor is told to stop, on every protocol, against the lease.
// Promises the time of the first stop frame on the wire, as the drive's end of the line sees it.
// Never judges: the goal stands beside the figures.
#pragma once

#include "tests/bench/bench_options.hpp"

namespace axisgate::bench {

void lease_expiry(const BenchOptions& options);

}  // namespace axisgate::bench
