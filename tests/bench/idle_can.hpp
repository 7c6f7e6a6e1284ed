// What drives that stand cost a CAN bus: SDO requests per second with process data mapped, beside what polling would
// be. Promises requests counted by the gateway's own bus block. Never enables a drive. Never judges: the figures stand
// side by side.
#pragma once

#include "tests/bench/bench_options.hpp"

namespace axisgate::bench {

void idle_can(const BenchOptions& options);

}  // namespace axisgate::bench
