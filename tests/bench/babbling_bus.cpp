#include "tests/bench/babbling_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/axisgate_sim/can_socket.hpp"
#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/figures.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/server_process.hpp"
#include "tests/simulated/socket_can_line.hpp"

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Samples = std::vector<double>;

/// Half of what a 500 kbit/s bus can carry: the node that hears all of it runs on the same processors.
constexpr std::chrono::microseconds kEach{500};

/// A node on vcan1 that sends nothing but its process data, frame after frame.
[[noreturn]] void babble(const std::function<void(std::uint16_t)>& begun) {
  simulated::CanSocket socket("vcan1");
  const auto frame =
      simulated::socket_frame_of(simulated::bus_frame(simulated::cob::first_tpdo + 1, {0, 0, 0, 0, 0, 0}));
  begun(1);
  for (auto next = SteadyClock::now();; next += kEach) {
    std::this_thread::sleep_until(next);
    socket.write(frame);
    static_cast<void>(socket.read());
  }
}

/// Milliseconds of each parameter write of axis 1, at times that keep no step with the polls.
Samples write_times(const GatewayProcess& gateway, std::chrono::milliseconds lasting) {
  ModbusClient client(gateway.port());
  ParameterWriter writer(1, 0);
  std::minstd_rand random(1);
  Samples milliseconds;
  for (const auto end = SteadyClock::now() + lasting; SteadyClock::now() < end;) {
    std::this_thread::sleep_for(std::chrono::microseconds(10'000 + random() % 10'000));
    const auto began = SteadyClock::now();
    if (writer.write(client) != 0) throw std::runtime_error("a write was refused");
    milliseconds.push_back(std::chrono::duration<double, std::milli>(SteadyClock::now() - began).count());
  }
  return milliseconds;
}

struct Seen {
  Samples writes;
  double exchanges = 0;  ///< per second, on the bus that is measured
  double processor = 0;  ///< share of it that the gateway takes
  std::uint16_t cycle_ms = 0;
};

Seen measure(const GatewayProcess& gateway, const DriveProcess& drives, std::chrono::milliseconds lasting) {
  const auto of_first_bus = [&](std::uint64_t from) {
    const auto tapped = drives.tap().since(from);
    return std::count_if(tapped.begin(), tapped.end(), [](const TappedExchange& e) { return e.line == 0; });
  };
  Seen seen;
  const std::uint64_t before = drives.tap().recorded();
  const auto processor_before = gateway.processor_time();
  const auto began = SteadyClock::now();
  seen.writes = write_times(gateway, lasting);
  const double seconds = std::chrono::duration<double>(SteadyClock::now() - began).count();
  seen.exchanges = static_cast<double>(of_first_bus(before)) / seconds;
  seen.processor = std::chrono::duration<double>(gateway.processor_time() - processor_before).count() / seconds;
  ModbusClient client(gateway.port());
  seen.cycle_ms = client.read(50'002, 1).front();
  return seen;
}

void print(const char* what, const Seen& seen, const Seen& quiet) {
  fmt::print("{:<22} {:>7} {:>8} {:>8} {:>8} {:>9.2f} {:>12.1f} {:>9} {:>11.1f}\n", what, seen.writes.size(),
             shown(median(seen.writes)), shown(quantile(seen.writes, 0.95)), shown(quantile(seen.writes, 1)),
             median(seen.writes) / median(quiet.writes), seen.exchanges, seen.cycle_ms, 100 * seen.processor);
  std::fflush(stdout);
}

}  // namespace

void babbling_bus(const BenchOptions& options) {
  fmt::print(
      "Two CAN buses, nodes that answer after 1 ms; parameter writes to the node of the first, milliseconds, while a\n"
      "node of the second sends a TPDO each {} us (where processors allow it)\n"
      "{:<22} {:>7} {:>8} {:>8} {:>8} {:>9} {:>12} {:>9} {:>11}\n",
      kEach.count(), "the other bus is", "writes", "median", "p95", "worst", "x median", "exchanges/s", "cycle ms",
      "processor %");
  DriveLines shape;
  shape.protocol = LineProtocol::vcan;
  shape.lines = 2;
  shape.reply_after = std::chrono::milliseconds(1);
  const DriveProcess drives(shape, options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, {20, 100, 1000});
  stay_on_processor(1);
  const auto lasting = options.lasting(std::chrono::milliseconds(10'000));
  const Seen quiet = measure(gateway, drives, lasting);
  print("quiet", quiet, quiet);
  std::optional<ServerProcess> babbler(std::in_place, babble);
  print("babbling", measure(gateway, drives, lasting), quiet);
  babbler.reset();
  print("quiet again", measure(gateway, drives, lasting), quiet);
}

}  // namespace axisgate::bench
