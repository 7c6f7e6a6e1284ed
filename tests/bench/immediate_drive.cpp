#include "tests/bench/immediate_drive.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/bare_libmodbus.hpp"
#include "tests/bench/bare_of.hpp"
#include "tests/bench/figures.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/server_process.hpp"

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Samples = std::vector<double>;

constexpr unsigned kHostProcessor = 0;  // gateway and bare loop; drive and clients are on the other

/// Microseconds of each `action` in the time given.
template <typename Action>
void time_each(std::chrono::milliseconds lasting, Samples& samples, Action action) {
  const auto end = SteadyClock::now() + lasting;
  for (auto now = SteadyClock::now(); now < end;) {
    action();
    const auto after = SteadyClock::now();
    samples.push_back(std::chrono::duration<double, std::micro>(after - now).count());
    now = after;
  }
}

/// From a reply's departure to the next request's arrival: the host's part of an exchange. `writes_only`: after a
/// write.
void add_turnarounds(const std::vector<TappedExchange>& tapped, bool writes_only, Samples& turnarounds) {
  for (std::size_t i = 0; i + 1 < tapped.size(); ++i) {
    if (writes_only && !tapped[i].write) continue;
    turnarounds.push_back(static_cast<double>(tapped[i + 1].asked_at - tapped[i].answered_at) / 1000);
  }
}

struct Measured {
  Samples bare, bare_hasty, bare_pair, bare_turn, read, write, write_turn, exchanges_per_write, mailbox,
      write_between_polls;
};

void measure_bare(const DriveProcess& drives, std::chrono::milliseconds lasting, Measured& to) {
  stay_on_processor(kHostProcessor);
  const std::uint64_t before = drives.tap().recorded();
  const bool rtu = drives.shape().protocol == LineProtocol::modbus_rtu;
  const Samples exchanges = bare_exchanges_of(drives, kFrameSilence, lasting);
  add_turnarounds(drives.tap().since(before), false, to.bare_turn);
  if (rtu) {
    const Samples hasty = bare_rtu_exchanges(drives.device(), {}, lasting / 4);
    to.bare_hasty.insert(to.bare_hasty.end(), hasty.begin(), hasty.end());
  }
  to.bare.insert(to.bare.end(), exchanges.begin(), exchanges.end());
  for (std::size_t i = 0; i + 1 < exchanges.size(); i += 2) to.bare_pair.push_back(exchanges[i] + exchanges[i + 1]);
  stay_on_processor(1 - kHostProcessor);
}

void measure_writes(const GatewayProcess& gateway, std::chrono::milliseconds lasting, Samples& to) {
  ModbusClient client(gateway.port());
  ParameterWriter writer(1, 0);
  time_each(lasting, to, [&] {
    if (writer.write(client) != 0) throw std::runtime_error("a write was refused");
  });
}

void measure_hardly_polled(const BenchOptions& options, const DriveProcess& drives, std::chrono::milliseconds lasting,
                           Measured& to) {
  const GatewayProcess gateway(options.program, options.folder, drives, kHardlyPolled, kHostProcessor);
  const std::uint64_t before = drives.tap().recorded();
  const std::size_t writes_before = to.write.size();
  measure_writes(gateway, lasting, to.write);
  const auto tapped = drives.tap().since(before);
  to.exchanges_per_write.push_back(static_cast<double>(tapped.size()) /
                                   static_cast<double>(to.write.size() - writes_before));
  add_turnarounds(tapped, true, to.write_turn);
  ModbusClient client(gateway.port());
  time_each(lasting, to.mailbox, [&] {
    if (!read_object(client, 1, readable_object(1, drives.shape().protocol)))
      throw std::runtime_error("an object was not read");
  });
  time_each(lasting / 2, to.read, [&] { static_cast<void>(client.read(100, 39)); });
}

/// `bare`: what it is compared with, as many exchanges each.
void print(const char* what, const Samples& samples, int exchanges, const Samples* bare) {
  const double middle = median(samples) / exchanges;
  const double worst = quantile(samples, 0.99) / exchanges;
  fmt::print("{:<58} {:>8} {:>9} {:>9}", what, samples.size(), shown(middle), shown(worst));
  if (bare != nullptr)
    fmt::print(" {:>9} {:>9} {:>7.2f}", shown(middle - median(*bare) / exchanges),
               shown(worst - quantile(*bare, 0.99) / exchanges), middle / (median(*bare) / exchanges));
  fmt::print("\n");
}

}  // namespace

void immediate_drive(const BenchOptions& options, LineProtocol protocol) {
  fmt::print(
      "P2, a drive that answers at once, microseconds per exchange (goal: 150 added at the median, 300 in a guest)\n"
      "A write through Modbus is timed at the client, TCP included, and counts as two exchanges: the write and the\n"
      "statusword read that its reply waits for. `added` is the difference to the bare loop's same exchanges.\n");
  DriveLines shape;
  shape.processor = 1 - kHostProcessor;
  shape.protocol = protocol;
  const DriveProcess drives(shape, options.folder);
  const auto lasting = options.lasting(std::chrono::milliseconds(1000));
  Measured m;
  for (int round = 0; round < options.times(7); ++round) {
    measure_bare(drives, lasting, m);
    measure_hardly_polled(options, drives, lasting, m);
    const GatewayProcess gateway(options.program, options.folder, drives, {}, kHostProcessor);
    measure_writes(gateway, lasting, m.write_between_polls);
  }
  fmt::print("{:<58} {:>8} {:>9} {:>9} {:>9} {:>9} {:>7}\n", "", "samples", "median", "p99", "added", "added p99",
             "ratio");
  if (protocol == LineProtocol::modbus_rtu) {
    print("libmodbus in a loop, without silence between frames", m.bare_hasty, 1, nullptr);
    print("bare loop: the same with the standard's 1.75 ms", m.bare, 1, nullptr);
  } else {
    print("bare loop: write, poll, read", m.bare, 1, nullptr);
  }
  print("bare loop: parameter write and statusword read, / 2", m.bare_pair, 2, nullptr);
  print("parameter write / 2, polling off", m.write, 2, &m.bare_pair);
  print("parameter write / 2, polled as by default", m.write_between_polls, 2, &m.bare_pair);
  print("mailbox read, polling off: request and result, 2+ Modbus", m.mailbox, 1, &m.bare);
  fmt::print("of these:\n  exchanges at the drive for each parameter write, polling off: {:.2f} (polls keep a fifth)\n",
             median(m.exchanges_per_write));
  print("  Modbus read of 39 registers, no exchange", m.read, 1, nullptr);
  print("  at the drive, reply to next request: bare loop", m.bare_turn, 1, nullptr);
  print("  at the drive, reply to next request: inside a write", m.write_turn, 1, &m.bare_turn);
}

}  // namespace axisgate::bench
