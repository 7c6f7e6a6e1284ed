// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <ctime>
#include <thread>

#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/bare_loops.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/busy_clients.hpp"
#include "tests/bench/gateway_process.hpp"

namespace axisgate::bench {
namespace {

constexpr int kEverydayClients = 8;

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

double resident_mib(const GatewayProcess& gateway) { return static_cast<double>(gateway.memory().resident) / 1024; }

DriveLines shape_of(int lines, int drives_per_line) {
  return {.lines = lines, .drives_per_line = drives_per_line, .reply_after = std::chrono::milliseconds(1)};
}

void measure_memory(const BenchOptions& options, int lines, int drives_per_line) {
  constexpr double kGoalMib = 24;
  const DriveProcess drives(shape_of(lines, drives_per_line), options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, {});
  const int axes = gateway.axes();
  options.report.row(fmt::format("{} drives on {} lines, no clients, resident MiB", axes, lines), resident_mib(gateway),
                     goal(kGoalMib));
  BusyClients clients(gateway.port());
  for (int i = 0; i < kEverydayClients; ++i) clients.add(everyday(i, axes));
  std::this_thread::sleep_for(options.lasting(std::chrono::milliseconds(5000)));
  options.report.row(fmt::format("{} drives on {} lines, {} clients, resident MiB", axes, lines, kEverydayClients),
                     resident_mib(gateway), goal(kGoalMib));
  clients.stop();
}

/// Microseconds that such an exchange costs a loop that does nothing else: its system calls.
double bare_cost(const BenchOptions& options) {
  const DriveProcess drives(shape_of(1, 1), options.folder);
  stay_on_processor(0);
  const auto used = [] {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) / 1e9;
  };
  const double before = used();
  const Samples exchanges = bare_exchanges(drives, options.lasting(std::chrono::milliseconds(3000)));
  const double each = 1e6 * (used() - before) / static_cast<double>(exchanges.size());
  stay_on_processor(1);
  return each;
}

void measure_processor(const BenchOptions& options, const std::string& what, const PollPeriods& periods,
                       double bare_us) {
  constexpr double kGoalPercent = 1;
  const DriveProcess drives(shape_of(4, 8), options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, periods);
  std::this_thread::sleep_for(options.lasting(std::chrono::milliseconds(2000)));
  const ExchangeRate rate(drives.tap());
  const auto used_before = gateway.processor_time();
  std::this_thread::sleep_for(options.quick ? std::chrono::milliseconds(1200) : std::chrono::milliseconds(20'000));
  const double used = std::chrono::duration<double>(gateway.processor_time() - used_before).count();
  options.report.row(what + ", % of a core", 100 * used / rate.seconds(), goal(kGoalPercent));
  options.report.row(what + ", us each", 1e6 * used / rate.exchanges(), bare(bare_us));
}

}  // namespace

void footprint(const BenchOptions& options) {
  stay_on_processor(1);
  measure_memory(options, 2, 4);
  measure_memory(options, 4, 8);
  // 32 drives on 4 lines, no clients; what is named is polled once a second.
  const double bare_us = bare_cost(options);
  measure_processor(options, "state and position each second", {1000, 60'000, 600'000}, bare_us);
  measure_processor(options, "classes each 1 s, 5 s, 50 s", {1000, 5000, 50'000}, bare_us);
  measure_processor(options, "every value each second", {1000, 1000, 1000}, bare_us);
}

}  // namespace axisgate::bench
