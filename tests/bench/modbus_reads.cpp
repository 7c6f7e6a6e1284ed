// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tests/bench/benches.hpp"
#include "tests/bench/closed_loop_clients.hpp"
#include "tests/bench/process.hpp"
#include "tests/bench/servers.hpp"

namespace axisgate::bench {
namespace {

void compare(const char* what, const ReadRequest& request, int clients, const BenchOptions& options) {
  const ServerProcess ours(serve_axisgate);
  const ServerProcess echo(
      [&](const ServerProcess::Ready& listening) { serve_echo(request.bytes.size(), request.reply_size, listening); });
  const std::chrono::milliseconds lasting(options.quick ? 100 : 200);
  Samples rates, echo_rates;
  for (int round = 0; round < (options.quick ? 3 : 25); ++round) {
    const auto measure = [&](const ServerProcess& server, Samples& to) {
      to.push_back(replies_per_second(server.port(), request, clients, lasting));
    };
    // In turns, and each first every other time: what else the machine does meets both alike.
    if (round % 2 == 0) measure(ours, rates);
    measure(echo, echo_rates);
    if (round % 2 != 0) measure(ours, rates);
  }
  options.report.row(fmt::format("{}, {} clients, reads/s", what, clients), median(rates), bare(median(echo_rates)));
}

}  // namespace

void modbus_reads(const BenchOptions& options) {
  stay_on_processor(1);  // the servers are on processor 0, one at a time under load
  for (const int clients : {1, 100}) {
    compare("one axis, 39 registers", {100, 39}, clients, options);
    compare("overview of 12 axes, 120 registers", {60010, 120}, clients, options);
  }
}

}  // namespace axisgate::bench
