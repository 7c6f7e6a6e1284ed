// How regularly a drive with a watchdog gets its commands, with and without busy clients.
// Promises gaps as the drive's end of the line sees them, and what the drive's watchdog made of them.
// Never judges: the bounds stand beside the figures.
#pragma once

#include "tests/bench/bench_options.hpp"

namespace axisgate::bench {

void keepalive(const BenchOptions& options);

}  // namespace axisgate::bench
