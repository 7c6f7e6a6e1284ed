// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <numeric>
#include <thread>

#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/bare_loops.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/busy_clients.hpp"
#include "tests/bench/gateway_process.hpp"

namespace axisgate::bench {
namespace {

struct ClientMix {
  const char* what;
  std::vector<BusyClients::Turn> clients;
};

std::vector<ClientMix> loads(LineProtocol protocol) {
  return {{"1 client writes parameters", {writing(0)}},
          {"1 client reads objects", {reading(1, protocol, {})}},
          {"32 clients read objects", readers_and_writers(32, 0, protocol)},
          {"32 clients: 6 write parameters, 26 read objects",
           readers_and_writers(32, ParameterWriter::kParameters, protocol)}};
}

double bare_rate(const DriveProcess& drives, std::chrono::milliseconds lasting) {
  stay_on_processor(0);
  const Samples microseconds = bare_exchanges(drives, lasting);
  stay_on_processor(1);
  return 1e6 * static_cast<double>(microseconds.size()) /
         std::accumulate(microseconds.begin(), microseconds.end(), 0.0);
}

double gateway_rate(const ClientMix& load, const BenchOptions& options, const DriveProcess& drives,
                    std::chrono::milliseconds lasting) {
  const GatewayProcess gateway(options.program, options.folder, drives, {});
  BusyClients clients(gateway.port());
  for (const BusyClients::Turn& turn : load.clients) clients.add(turn);
  std::this_thread::sleep_for(lasting / 10);
  const ExchangeRate rate(drives.tap());
  std::this_thread::sleep_for(lasting);
  const double at_drive = rate.per_second();
  clients.stop();
  return at_drive;
}

void measure(const ClientMix& load, const BenchOptions& options, const DriveProcess& drives) {
  // On CAN two nodes one after the other, so each for less long.
  const bool can = is_can(drives.shape().protocol);
  const auto lasting = options.lasting(std::chrono::milliseconds(can ? 1000 : 3000));
  Samples gateway, alone;
  for (int round = 0; round < options.times(can ? 3 : 5); ++round) {
    // The bare loop before and after the gateway, never beside it: they would take each other's replies.
    const double before = bare_rate(drives, lasting / 2);
    gateway.push_back(gateway_rate(load, options, drives, lasting));
    alone.push_back((before + bare_rate(drives, lasting / 2)) / 2);
  }
  const auto delay = std::chrono::duration_cast<std::chrono::milliseconds>(drives.shape().reply_after);
  options.report.row(fmt::format("{} ms: {}, 1/s", delay.count(), load.what), median(gateway), bare(median(alone)));
}

}  // namespace

void delayed_drive(const BenchOptions& options, LineProtocol protocol) {
  for (const int delay_ms : {0, 5}) {
    if (delay_ms == 0 && protocol == LineProtocol::kinco_serial) continue;
    DriveLines shape;
    shape.reply_after = std::chrono::milliseconds(delay_ms);
    shape.protocol = protocol;
    const DriveProcess drives(shape, options.folder);
    for (const ClientMix& load : loads(protocol)) measure(load, options, drives);
  }
}

}  // namespace axisgate::bench
