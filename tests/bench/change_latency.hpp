// From process data to the client: a node sends a TPDO with another position, and a client reads the axis until it
// shows. Promises times of one clock, from just before the frame is written to the reply that has its value. Never
// counts a turn that the client did not see before the next one.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/line_protocol.hpp"

namespace axisgate::bench {

void change_latency(const BenchOptions& options, LineProtocol protocol);

}  // namespace axisgate::bench
