// SPDX-License-Identifier: Apache-2.0
// The two servers of the read benches, each the body of a ServerProcess: axisgate's over an image filled by hand, and
// a bare echo server. Promises to serve until the process is killed. Never reaches a drive.
#pragma once

#include <cstddef>

#include "tests/bench/process.hpp"

namespace axisgate::bench {

void serve_axisgate(const ServerProcess::Ready& listening);
void serve_echo(std::size_t request_size, std::size_t reply_size, const ServerProcess::Ready& listening);

}  // namespace axisgate::bench
