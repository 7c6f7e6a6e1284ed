#include "tests/bench/stop_latency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/busy_clients.hpp"
#include "tests/bench/figures.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/server_process.hpp"

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr int kClients = 32;
constexpr std::uint16_t kQuickStop = 102;  // coil of axis 1

struct Stops {
  std::map<std::size_t, int> before;  // how many stops had so many exchanges before their frame
  std::vector<double> waits_ms;       // from the client's send to the drive
  std::vector<double> answers_ms;     // to the client's reply
  std::vector<double> waiting;        // orders that waited for the bus just before
};

void one_stop(ModbusClient& client, const ExchangeTap& tap, std::uint16_t controlword, Stops& stops) {
  stops.waiting.push_back(client.read(50'003, 1).front());
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
  ++stops.before[static_cast<std::size_t>(stop - tapped.begin())];
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
  for (int i = 0; i < kClients; ++i) {
    const auto writer = std::make_shared<ParameterWriter>(1, i);
    clients.add([i, writer, protocol](ModbusClient& client) {
      if (i < ParameterWriter::kParameters)
        static_cast<void>(writer->write(client));
      else
        static_cast<void>(read_object(client, 1, readable_object(i, protocol), std::chrono::milliseconds(20)));
    });
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  ModbusClient client(gateway.port());
  Stops stops;
  const std::uint64_t before = drives.tap().recorded();
  const auto began = SteadyClock::now();
  std::minstd_rand random(1);
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(20'000 + random() % 20'000));
    one_stop(client, drives.tap(), jd_addresses(protocol).controlword, stops);
  }
  const double seconds = std::chrono::duration<double>(SteadyClock::now() - began).count();
  const std::uint64_t after = drives.tap().recorded();
  const auto newest = drives.tap().since(std::max(before, after - std::min(after, ExchangeTap::kKept / 2)));
  clients.stop();
  const auto writes = std::count_if(newest.begin(), newest.end(), [](const TappedExchange& e) { return e.write; });

  fmt::print(
      "drive answers after {:>5} ms: {} stops in {:.0f} exchanges/s, {:.0f} % of them writes, {:.0f} orders waiting",
      shown(std::chrono::duration<double, std::milli>(reply_after).count()), count,
      static_cast<double>(after - before) / seconds,
      100 * static_cast<double>(writes) / static_cast<double>(newest.size()), median(stops.waiting));
  fmt::print("\n  exchanges sent first:");
  for (const auto& [number, times] : stops.before) fmt::print(" {} ({}x)", number, times);
  fmt::print(
      "\n  ms until the stop is at the drive: median {}, p99 {}, worst {}; until its answer: median {}, worst {}\n",
      shown(median(stops.waits_ms)), shown(quantile(stops.waits_ms, 0.99)), shown(quantile(stops.waits_ms, 1)),
      shown(median(stops.answers_ms)), shown(quantile(stops.answers_ms, 1)));
  std::fflush(stdout);
}

}  // namespace

void stop_latency(const BenchOptions& options, LineProtocol protocol) {
  stay_on_processor(1);
  fmt::print(
      "P4, quick stops behind {} busy clients (6 write parameters, 26 read objects), polled as by default\n"
      "(goal: none but the one on the wire). Counted at the drive: exchanges that reached it after the client sent "
      "its\n"
      "stop and before the stop's frame. 1 is the goal met too: it went out before the gateway had read the stop. "
      "With\n"
      "the drive that answers at once it may be more: an exchange is over sooner than a request has come to the "
      "gateway.\n",
      kClients);
  measure(options, protocol, std::chrono::milliseconds(5), options.times(500));
  measure(options, protocol, std::chrono::milliseconds(20), options.times(200));
  measure(options, protocol, {}, options.times(500));
}

}  // namespace axisgate::bench
