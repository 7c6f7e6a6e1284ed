// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <stdexcept>
#include <thread>

#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/gateway_process.hpp"

namespace axisgate::bench {
namespace {

constexpr std::uint16_t kQuickStop = 102;  // coil of axis 1

struct Stops {
  /// Exchanges that reached the drive after the client sent its stop and before the stop's frame. None is the goal met
  /// too: the stop went out before the one on the wire.
  Samples before;
  Samples waits_ms;    ///< from the client's send to the drive
  Samples answers_ms;  ///< to the client's reply
};

void one_stop(ModbusClient& client, const ExchangeTap& tap, std::uint16_t controlword, Stops& stops) {
  const std::uint64_t first = tap.recorded();
  const std::int64_t sent_at = SteadyClock::now().time_since_epoch().count();
  if (client.write_coil(kQuickStop, true) != 0) throw std::runtime_error("a stop was refused");
  const std::int64_t answered_at = SteadyClock::now().time_since_epoch().count();
  auto tapped = tap.since(first);
  // The one on the wire: asked before, answered after.
  std::erase_if(tapped, [&](const TappedExchange& e) { return e.asked_at < sent_at; });
  const auto stop = std::find_if(tapped.begin(), tapped.end(),
                                 [&](const TappedExchange& e) { return e.write && e.object == controlword; });
  if (stop == tapped.end()) throw std::runtime_error("a stop did not reach the drive");
  stops.before.push_back(static_cast<double>(stop - tapped.begin()));
  stops.waits_ms.push_back(static_cast<double>(stop->asked_at - sent_at) / 1e6);
  stops.answers_ms.push_back(static_cast<double>(answered_at - sent_at) / 1e6);
  if (client.write_coil(kQuickStop, false) != 0) throw std::runtime_error("a coil was refused");
}

void measure(const BenchOptions& options, LineProtocol protocol, std::chrono::nanoseconds reply_after, int count) {
  DriveLines shape;
  shape.reply_after = reply_after;
  shape.protocol = protocol;
  const DriveProcess drives(shape, options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, {});
  BusyClients clients(gateway.port());
  for (const auto& turn : readers_and_writers(kBusyClients, ParameterWriter::kParameters, protocol)) clients.add(turn);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  ModbusClient client(gateway.port());
  Stops stops;
  std::minstd_rand random(1);
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(20'000 + random() % 20'000));
    one_stop(client, drives.tap(), jd_addresses(protocol).controlword, stops);
  }
  clients.stop();
  // Where a drive answers at once more may go before: an exchange is over sooner than a request is at the gateway.
  const double delay = std::chrono::duration<double, std::milli>(reply_after).count();
  const std::string when = fmt::format("drive answers after {} ms: ", delay);
  options.report.row(when + "exchanges before a stop, median", median(stops.before), goal(1));
  options.report.row(when + "exchanges before a stop, worst", worst(stops.before), goal(1));
  const auto exchange = delay > 0 ? std::optional(Beside{"one exchange", delay}) : std::nullopt;
  options.report.row(when + "stop at the drive, median ms", median(stops.waits_ms), exchange);
  options.report.row(when + "stop at the drive, p99 ms", quantile(stops.waits_ms, 0.99), exchange);
  options.report.row(when + "stop answered, median ms", median(stops.answers_ms), exchange);
}

}  // namespace

void stop_latency(const BenchOptions& options, LineProtocol protocol) {
  stay_on_processor(1);
  measure(options, protocol, std::chrono::milliseconds(5), options.times(500));
  measure(options, protocol, std::chrono::milliseconds(20), options.times(200));
  measure(options, protocol, {}, options.times(500));
}

}  // namespace axisgate::bench
