// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <vector>

#include "tests/bench/benches.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/modbus_client.hpp"

namespace axisgate::bench {
namespace {

constexpr std::uint16_t kPosition = 102;  // of axis 1
constexpr std::uint32_t kUnitsPerTurn = 10'000;

struct Seen {
  std::map<std::uint32_t, std::int64_t> first;  ///< when a turn was first seen
  std::vector<double> reads;                    ///< microseconds
};

Seen watch(std::uint16_t port, std::chrono::milliseconds lasting) {
  ModbusClient client(port);
  Seen seen;
  const auto end = SteadyClock::now() + lasting;
  for (auto began = SteadyClock::now(); began < end;) {
    const auto words = client.read(kPosition, 2);
    const auto now = SteadyClock::now();
    const std::uint32_t position = std::uint32_t{words[0]} << 16 | words[1];
    seen.first.emplace(position / kUnitsPerTurn, now.time_since_epoch().count());
    seen.reads.push_back(std::chrono::duration<double, std::micro>(now - began).count());
    began = now;
  }
  return seen;
}

}  // namespace

void change_latency(const BenchOptions& options, LineProtocol protocol) {
  DriveLines shape;
  shape.protocol = protocol;
  shape.turn_every = std::chrono::milliseconds(23);
  const DriveProcess drives(shape, options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, kHardlyPolled);
  stay_on_processor(1);
  const std::uint64_t before = drives.tap().recorded();
  const Seen seen = watch(gateway.port(), options.lasting(std::chrono::milliseconds(10'000)));
  std::vector<double> latencies;
  for (const TappedExchange& turn : drives.tap().since(before)) {
    if (turn.asked_at != turn.answered_at) continue;  // an SDO exchange
    const auto found = seen.first.find(turn.object);
    if (found != seen.first.end() && found->second > turn.asked_at)
      latencies.push_back(static_cast<double>(found->second - turn.asked_at) / 1000);
  }
  options.report.rows("TPDO sent to register seen, us", latencies, "one read", seen.reads);
}

}  // namespace axisgate::bench
