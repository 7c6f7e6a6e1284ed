// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/bare_loops.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/gateway_process.hpp"

namespace axisgate::bench {
namespace {

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
  Samples bare, bare_hasty, bare_pair, bare_turn, write, write_turn, write_between_polls, mailbox;
};

void measure_bare(const DriveProcess& drives, std::chrono::milliseconds lasting, Measured& to) {
  stay_on_processor(kHostProcessor);
  const std::uint64_t before = drives.tap().recorded();
  const Samples exchanges = bare_exchanges(drives, lasting);
  add_turnarounds(drives.tap().since(before), false, to.bare_turn);
  if (drives.shape().protocol == LineProtocol::modbus_rtu)
    append(to.bare_hasty, bare_exchanges(drives, lasting / 4, {}));
  append(to.bare, exchanges);
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
  measure_writes(gateway, lasting, to.write);
  add_turnarounds(drives.tap().since(before), true, to.write_turn);
  ModbusClient client(gateway.port());
  time_each(lasting, to.mailbox, [&] {
    if (!read_object(client, 1, readable_object(1, drives.shape().protocol)))
      throw std::runtime_error("an object was not read");
  });
}

}  // namespace

void immediate_drive(const BenchOptions& options, LineProtocol protocol) {
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
  Report& report = options.report;
  report.rows("parameter write / 2, polling off, us", m.write, "bare loop", m.bare_pair, 2);
  report.rows("parameter write / 2, polled as by default, us", m.write_between_polls, "bare loop", m.bare_pair, 2);
  report.rows("mailbox read, 2 or more Modbus requests, us", m.mailbox, "bare loop", m.bare);
  report.rows("at the drive, reply to next request, us", m.write_turn, "bare loop", m.bare_turn);
  if (!m.bare_hasty.empty())
    report.row("parameter write / 2, no silence in the loop, us", median(m.write) / 2, bare(median(m.bare_hasty)));
}

}  // namespace axisgate::bench
