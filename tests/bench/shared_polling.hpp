// P6: what readers cost the bus: exchanges per second with 0, 1 and 32 clients that read one axis without a pause.
// Promises the clients' reads per second beside it, so that the load is seen. Never writes.
// Never judges: the goal (equal) stands in the output.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/line_protocol.hpp"

namespace axisgate::bench {

void shared_polling(const BenchOptions& options, LineProtocol protocol);

}  // namespace axisgate::bench
