// P3: what a drive that has gone mute costs the commands of a live one on the same line, in the first minute and after.
// Promises the live drive's own figures without the dead one, from the same run. Never measures beside another load.
// Never judges: the goals stand in the output.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/line_protocol.hpp"

namespace axisgate::bench {

void mute_neighbour(const BenchOptions& options, LineProtocol protocol);

}  // namespace axisgate::bench
