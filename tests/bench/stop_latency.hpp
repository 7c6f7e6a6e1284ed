// P4: how many exchanges go out between a client's stop and the stop's own frame, behind 32 busy clients.
// Promises to count at the drive, from before the client sends: what it counts can only be more than what the gateway
// knew. Never counts a stop that was already on its way.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/line_protocol.hpp"

namespace axisgate::bench {

void stop_latency(const BenchOptions& options, LineProtocol protocol);

}  // namespace axisgate::bench
