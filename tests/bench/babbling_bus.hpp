// What a node that babbles on one bus costs the commands of a drive on the other.
// Promises the same writes without and with it in one run, and the frames that it really sent.
// Never puts a frame on the bus that is measured.
#pragma once

#include "tests/bench/bench_options.hpp"

namespace axisgate::bench {

void babbling_bus(const BenchOptions& options);

}  // namespace axisgate::bench
