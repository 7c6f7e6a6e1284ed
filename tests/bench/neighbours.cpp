// SPDX-License-Identifier: Apache-2.0
// What a drive costs its neighbour: a dead one on the same line, and one that babbles on another.
#include <algorithm>
#include <thread>

#include "tests/axisgate_sim/can_socket.hpp"
#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/simulated/socket_can_line.hpp"

namespace axisgate::bench {
namespace {

using std::chrono::milliseconds;

constexpr std::uint8_t kDeadStation = 2;
constexpr milliseconds kBackOffGrows{60'000};
/// Half of what a 500 kbit/s bus can carry: the node that hears all of it runs on the same processors.
constexpr std::chrono::microseconds kEachFrame{500};

DriveLines shape_of(int drives, LineProtocol protocol) {
  DriveLines shape;
  shape.drives_per_line = drives;
  shape.reply_after = milliseconds(5);
  shape.protocol = protocol;
  return shape;
}

/// A node on vcan1 that sends nothing but its process data, frame after frame.
[[noreturn]] void babble(const ServerProcess::Ready& begun) {
  simulated::CanSocket socket("vcan1");
  const auto frame =
      simulated::socket_frame_of(simulated::bus_frame(simulated::cob::first_tpdo + 1, {0, 0, 0, 0, 0, 0}));
  begun(1);
  for (auto next = std::chrono::steady_clock::now();; next += kEachFrame) {
    std::this_thread::sleep_until(next);
    socket.write(frame);
    static_cast<void>(socket.read());
  }
}

struct BesideBabble {
  Samples writes;
  double exchanges = 0;  ///< per second, on the bus that is measured
  double processor = 0;  ///< share of it that the gateway takes
};

BesideBabble measure(const GatewayProcess& gateway, const DriveProcess& drives, milliseconds lasting) {
  BesideBabble seen;
  const std::uint64_t before = drives.tap().recorded();
  const ExchangeRate rate(drives.tap());
  const auto processor_before = gateway.processor_time();
  seen.writes = write_times(gateway.port(), lasting, milliseconds(10));
  const double seconds = rate.seconds();
  const auto tapped = drives.tap().since(before);
  seen.exchanges = static_cast<double>(std::ranges::count(tapped, 0, &TappedExchange::line)) / seconds;
  seen.processor = std::chrono::duration<double>(gateway.processor_time() - processor_before).count() / seconds;
  return seen;
}

}  // namespace

void dead_neighbour(const BenchOptions& options, LineProtocol protocol) {
  constexpr milliseconds kPause{20};
  constexpr PollPeriods kPolled{100, 500, 5000};
  stay_on_processor(1);
  const auto minute = options.lasting(kBackOffGrows);
  Samples alone;
  {
    const DriveProcess drives(shape_of(1, protocol), options.folder);
    const GatewayProcess gateway(options.program, options.folder, drives, kPolled);
    alone = write_times(gateway.port(), minute / 2, kPause);
  }
  DriveProcess drives(shape_of(2, protocol), options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, kPolled);
  const auto rows = [&](const std::string& what, milliseconds lasting) {
    const Samples samples = write_times(gateway.port(), lasting, kPause);
    options.report.row(what + ", median ms", median(samples), Beside{"alone", median(alone)});
    options.report.row(what + ", p95 ms", quantile(samples, 0.95), Beside{"alone", quantile(alone, 0.95)});
    options.report.row(what + ", worst ms", worst(samples), Beside{"alone", worst(alone)});
  };
  rows("writes beside another that lives", minute / 2);
  drives.mute(kDeadStation);
  rows("the other dead: first minute", minute);
  rows("the other dead: second minute", minute);
}

void babbling_bus(const BenchOptions& options) {
  DriveLines shape;
  shape.protocol = LineProtocol::vcan;
  shape.lines = 2;
  shape.reply_after = milliseconds(1);
  const DriveProcess drives(shape, options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, {20, 100, 1000});
  stay_on_processor(1);
  const auto lasting = options.lasting(milliseconds(10'000));
  const BesideBabble quiet = measure(gateway, drives, lasting);
  const ServerProcess babbler(babble);
  const BesideBabble babbling = measure(gateway, drives, lasting);
  options.report.row("writes beside a babbling bus, median ms", median(babbling.writes),
                     Beside{"quiet", median(quiet.writes)});
  options.report.row("writes beside a babbling bus, worst ms", worst(babbling.writes),
                     Beside{"quiet", worst(quiet.writes)});
  options.report.row("exchanges on the quiet bus, 1/s", babbling.exchanges, Beside{"quiet", quiet.exchanges});
  options.report.row("processor, %", 100 * babbling.processor, Beside{"quiet", 100 * quiet.processor});
}

}  // namespace axisgate::bench
