#include "tests/bench/mute_neighbour.hpp"

#include <fmt/format.h>

#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/figures.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/server_process.hpp"

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Samples = std::vector<double>;
constexpr std::uint8_t kDeadStation = 2;
constexpr std::chrono::seconds kBackOffGrows{60};

DriveLines line_of(int drives, LineProtocol protocol) {
  DriveLines shape;
  shape.drives_per_line = drives;
  shape.reply_after = std::chrono::milliseconds(5);
  shape.protocol = protocol;
  return shape;
}

/// Milliseconds of each parameter write of axis 1, at times that keep no step with the polls or the probes.
Samples write_times(const GatewayProcess& gateway, std::chrono::milliseconds lasting) {
  ModbusClient client(gateway.port());
  ParameterWriter writer(1, 0);
  std::minstd_rand random(1);
  Samples milliseconds;
  for (const auto end = SteadyClock::now() + lasting; SteadyClock::now() < end;) {
    std::this_thread::sleep_for(std::chrono::microseconds(20'000 + random() % 20'000));
    const auto began = SteadyClock::now();
    if (writer.write(client) != 0) throw std::runtime_error("a write to the live drive was refused");
    milliseconds.push_back(std::chrono::duration<double, std::milli>(SteadyClock::now() - began).count());
  }
  return milliseconds;
}

void print(const char* what, const Samples& samples, const Samples& alone) {
  fmt::print("{:<46} {:>7} {:>8} {:>8} {:>8} {:>8.2f} {:>7.2f} {:>+9.1f}\n", what, samples.size(),
             shown(median(samples)), shown(quantile(samples, 0.95)), shown(quantile(samples, 1)),
             median(samples) / median(alone), quantile(samples, 0.95) / quantile(alone, 0.95),
             quantile(samples, 1) - quantile(alone, 1));
  std::fflush(stdout);
}

}  // namespace

void mute_neighbour(const BenchOptions& options, LineProtocol protocol) {
  stay_on_processor(1);
  fmt::print(
      "P3, parameter writes to a live drive beside a dead one, both answer after 5 ms while they live; milliseconds\n"
      "(goals: at once, worst at most its own and one timeout per back-off step; after 60 s median 1.1, p95 2.0, worst "
      "its own and one probe)\n"
      "{:<46} {:>7} {:>8} {:>8} {:>8} {:>8} {:>7} {:>9}\n",
      "", "writes", "median", "p95", "worst", "x median", "x p95", "+ worst");
  const auto minute = options.lasting(kBackOffGrows);
  Samples alone;
  {
    const DriveProcess drives(line_of(1, protocol), options.folder);
    const GatewayProcess gateway(options.program, options.folder, drives, {100, 500, 5000});
    alone = write_times(gateway, minute / 2);
    print("alone on the line", alone, alone);
  }
  DriveProcess drives(line_of(2, protocol), options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, {100, 500, 5000});
  print("beside another that lives", write_times(gateway, minute / 2), alone);
  drives.mute(kDeadStation);
  print("the other is dead: the first minute", write_times(gateway, minute), alone);
  print("the other is dead: the second minute", write_times(gateway, minute), alone);
}

}  // namespace axisgate::bench
