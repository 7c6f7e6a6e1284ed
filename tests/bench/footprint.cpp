#include "tests/bench/footprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <thread>
#include <vector>

#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/bare_loop.hpp"
#include "tests/bench/busy_clients.hpp"
#include "tests/bench/figures.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/server_process.hpp"

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr int kClients = 8;

/// Reads every axis, writes to one and reads an object, ten times a second.
BusyClients::Turn everyday(int client, int axes) {
  return [client, axes](ModbusClient& to) {
    for (int axis = 1; axis <= axes; ++axis) static_cast<void>(to.read(static_cast<std::uint16_t>(100 * axis), 39));
    const int axis = 1 + client % axes;
    static_cast<void>(ParameterWriter(axis, client).write(to));
    static_cast<void>(read_object(to, axis, readable_object(client), std::chrono::milliseconds(5)));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  };
}

void print_memory(const char* what, const GatewayProcess::Memory& memory) {
  fmt::print("{:<62} {:>8.1f} {:>10.1f}\n", what, static_cast<double>(memory.resident) / 1024,
             static_cast<double>(memory.anonymous) / 1024);
  std::fflush(stdout);
}

void measure_memory(const BenchOptions& options, int lines, int drives_per_line) {
  const DriveProcess drives({lines, drives_per_line, std::chrono::milliseconds(1), 1}, options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, {});
  const int axes = gateway.axes();
  print_memory(fmt::format("{} drives on {} lines, online, no clients", axes, lines).c_str(), gateway.memory());
  BusyClients clients(gateway.port());
  for (int i = 0; i < kClients; ++i) clients.add(everyday(i, axes));
  std::this_thread::sleep_for(options.lasting(std::chrono::milliseconds(5000)));
  print_memory(fmt::format("{} drives on {} lines, with {} clients", axes, lines, kClients).c_str(), gateway.memory());
  clients.stop();
}

void measure_processor(const BenchOptions& options, const char* what, const PollPeriods& periods) {
  const DriveProcess drives({4, 8, std::chrono::milliseconds(1), 1}, options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, periods);
  std::this_thread::sleep_for(options.lasting(std::chrono::milliseconds(2000)));
  const std::uint64_t exchanges_before = drives.tap().recorded();
  const auto used_before = gateway.processor_time();
  const auto began = SteadyClock::now();
  std::this_thread::sleep_for(options.quick ? std::chrono::milliseconds(1200) : std::chrono::milliseconds(20'000));
  const auto used = std::chrono::duration<double>(gateway.processor_time() - used_before).count();
  const auto seconds = std::chrono::duration<double>(SteadyClock::now() - began).count();
  const auto exchanges = static_cast<double>(drives.tap().recorded() - exchanges_before);
  fmt::print("{:<62} {:>8.1f} {:>9.2f} % {:>8.1f}\n", what, exchanges / seconds, 100 * used / seconds,
             1e6 * used / std::max(exchanges, 1.0));
  std::fflush(stdout);
}

/// What such an exchange costs a loop that does nothing else: its system calls.
void measure_bare(const BenchOptions& options) {
  const DriveProcess drives({1, 1, std::chrono::milliseconds(1), 1}, options.folder);
  stay_on_processor(0);
  const auto used = [] {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) / 1e9;
  };
  const double before = used();
  const auto exchanges = bare_exchanges(drives.device(), options.lasting(std::chrono::milliseconds(3000)));
  fmt::print("{:<62} {:>8} {:>11} {:>8.1f}\n", "bare loop: write, poll, read, against the same drives", "", "",
             1e6 * (used() - before) / static_cast<double>(exchanges.size()));
  stay_on_processor(1);
}

}  // namespace

void footprint(const BenchOptions& options) {
  stay_on_processor(1);
  fmt::print("P8, resident memory of the gateway in MiB (goal: 24 with 32 drives and 8 clients)\n{:<62} {:>8} {:>10}\n",
             "", "resident", "anonymous");
  measure_memory(options, 2, 4);
  measure_memory(options, 4, 8);
  fmt::print(
      "P8, processor time of the gateway, 32 drives on 4 lines, no clients (goal: under 1 % of a core, polled once a "
      "second)\n{:<62} {:>8} {:>11} {:>8}\n",
      "", "exch./s", "of a core", "us each");
  measure_bare(options);
  measure_processor(options, "fast class each second, others not (state and position)", {1000, 60'000, 600'000});
  measure_processor(options, "each second, others in proportion (1 s, 5 s, 50 s)", {1000, 5000, 50'000});
  measure_processor(options, "every value each second (all classes 1 s)", {1000, 1000, 1000});
}

}  // namespace axisgate::bench
