// P8: what the gateway takes of the machine: resident memory, and processor time with 32 drives polled once a second.
// Promises figures of the process that users run, as the kernel counts them. Never counts the drives or the clients.
// Never judges: the goals (24 MiB, 1 % of a core) stand in the output.
#pragma once

#include "tests/bench/bench_options.hpp"

namespace axisgate::bench {

void footprint(const BenchOptions& options);

}  // namespace axisgate::bench
