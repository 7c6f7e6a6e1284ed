#include "tests/bench/delayed_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "tests/bench/axis_traffic.hpp"
#include "tests/bench/bare_libmodbus.hpp"
#include "tests/bench/bare_of.hpp"
#include "tests/bench/busy_clients.hpp"
#include "tests/bench/figures.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/server_process.hpp"

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// A mailbox asks again after this: 32 clients that ask without a pause would measure the Modbus server instead.
constexpr std::chrono::milliseconds kAskAgain{20};

BusyClients::Turn writing(int parameter) {
  return [writer = std::make_shared<ParameterWriter>(1, parameter)](ModbusClient& client) {
    static_cast<void>(writer->write(client));
  };
}

BusyClients::Turn reading(int number, LineProtocol protocol, std::chrono::microseconds pause) {
  return [object = readable_object(number, protocol), pause](ModbusClient& client) {
    static_cast<void>(read_object(client, 1, object, pause));
  };
}

struct Load {
  const char* what;
  std::vector<BusyClients::Turn> clients;
};

std::vector<Load> loads(LineProtocol protocol) {
  std::vector<Load> all;
  all.push_back({"1 client writes parameters", {writing(0)}});
  all.push_back({"1 client reads objects", {reading(1, protocol, {})}});
  all.push_back({"32 clients read objects", {}});
  for (int i = 0; i < 32; ++i) all.back().clients.push_back(reading(i, protocol, kAskAgain));
  all.push_back({"32 clients: 6 write parameters, 26 read objects", {}});
  for (int i = 0; i < 32; ++i)
    all.back().clients.push_back(i < ParameterWriter::kParameters ? writing(i) : reading(i, protocol, kAskAgain));
  return all;
}

struct Rates {
  std::vector<double> gateway, drive, bare, share;
};

double bare_rate(const DriveProcess& drives, std::chrono::microseconds silence, std::chrono::milliseconds lasting) {
  stay_on_processor(0);
  const auto began = SteadyClock::now();
  const auto exchanges = static_cast<double>(bare_exchanges_of(drives, silence, lasting).size());
  const auto took = SteadyClock::now() - began;
  stay_on_processor(1);
  return exchanges / std::chrono::duration<double>(took).count();
}

void measure_gateway(const Load& load, const BenchOptions& options, const DriveProcess& drives,
                     std::chrono::milliseconds lasting, Rates& rates) {
  const GatewayProcess gateway(options.program, options.folder, drives, {});
  BusyClients clients(gateway.port());
  for (const BusyClients::Turn& turn : load.clients) clients.add(turn);
  ModbusClient observer(gateway.port());
  const auto requests = [&] {
    const auto words = observer.read(50'004, 2);
    return (static_cast<std::uint32_t>(words[0]) << 16) | words[1];
  };
  std::this_thread::sleep_for(lasting / 10);
  const std::uint64_t tapped_before = drives.tap().recorded();
  const auto began = SteadyClock::now();
  const std::uint32_t before = requests();
  std::this_thread::sleep_for(lasting);
  const std::uint32_t after = requests();
  const double seconds = std::chrono::duration<double>(SteadyClock::now() - began).count();
  const std::uint64_t tapped = drives.tap().recorded() - tapped_before;
  clients.stop();
  rates.gateway.push_back((after - before) / seconds);
  rates.drive.push_back(static_cast<double>(tapped) / seconds);
}

/// The bare loop before and after the gateway, never beside it: they would take each other's replies.
void measure(const Load& load, const BenchOptions& options, const DriveProcess& drives, Rates& rates) {
  const bool can = is_can(drives.shape().protocol);
  const auto lasting = options.lasting(std::chrono::milliseconds(can ? 1000 : 3000));
  const double bare_before = bare_rate(drives, kFrameSilence, lasting / 2);
  measure_gateway(load, options, drives, lasting, rates);
  rates.bare.push_back((bare_before + bare_rate(drives, kFrameSilence, lasting / 2)) / 2);
  rates.share.push_back(rates.gateway.back() / rates.bare.back());
}

void measure_loads(const BenchOptions& options, LineProtocol protocol, std::chrono::milliseconds reply_after) {
  DriveLines shape;
  shape.reply_after = reply_after;
  shape.protocol = protocol;
  const DriveProcess drives(shape, options.folder);
  if (protocol == LineProtocol::modbus_rtu)
    fmt::print("answers after {} ms; libmodbus in a loop without silence between frames: {:.1f} exchanges/s\n",
               reply_after.count(), bare_rate(drives, {}, options.lasting(std::chrono::milliseconds(2000))));
  if (is_can(protocol)) fmt::print("answers after {} ms:\n", reply_after.count());
  for (const Load& load : loads(protocol)) {
    Rates rates;
    // Two nodes one after the other, so each for less long.
    for (int round = 0; round < options.times(is_can(protocol) ? 3 : 5); ++round) measure(load, options, drives, rates);
    const auto [least, most] = std::minmax_element(rates.share.begin(), rates.share.end());
    fmt::print("{:<50} {:>9.1f} {:>9.1f} {:>9.1f} {:>6.1f} % {:>6.1f}..{:.1f} %\n", load.what, median(rates.gateway),
               median(rates.drive), median(rates.bare), 100 * median(rates.share), 100 * *least, 100 * *most);
    std::fflush(stdout);
  }
}

}  // namespace

void delayed_drive(const BenchOptions& options, LineProtocol protocol) {
  constexpr std::chrono::milliseconds kAtOnce{0}, kDelayed{5};
  const bool rtu = protocol == LineProtocol::modbus_rtu;
  const bool at_once_too = rtu || is_can(protocol);
  fmt::print(
      "P2, a drive that answers {}, exchanges per second (goal: 95 % of the bare loop), polled as by default\n"
      "{:<50} {:>9} {:>9} {:>9} {:>8} {:>14}\n",
      at_once_too ? "at once and after 5 ms" : "after 5 ms", "load", "gateway", "at drive", rtu ? "bare+1.75" : "bare",
      "share", "of the rounds");
  if (at_once_too) measure_loads(options, protocol, kAtOnce);
  measure_loads(options, protocol, kDelayed);
}

}  // namespace axisgate::bench
