#include "tests/bench/shared_polling.hpp"

#include <fmt/format.h>

#include <thread>
#include <vector>

#include "tests/bench/closed_loop_clients.hpp"
#include "tests/bench/figures.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/server_process.hpp"

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr std::uint16_t kRegisters = 39;

}  // namespace

void shared_polling(const BenchOptions& options, LineProtocol protocol) {
  stay_on_processor(1);
  fmt::print(
      "P6, clients that read one axis without a pause, drive answers after 1 ms, polled as by default\n"
      "(goal: as many exchanges on the bus as without clients)\n"
      "{:<8} {:>14} {:>16} {:>8} {:>16}\n",
      "clients", "reads/s", "exchanges/s", "ratio", "of the rounds");
  std::array<Byte, 12> request{0, 1, 0, 0, 0, 6, 0xFF, 3};
  store_be16(request, 8, 100);
  store_be16(request, 10, kRegisters);
  DriveLines shape;
  shape.reply_after = std::chrono::milliseconds(1);
  shape.protocol = protocol;
  const DriveProcess drives(shape, options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, {});
  const auto lasting = options.lasting(std::chrono::milliseconds(5000));
  double without = 0;
  for (const int clients : {0, 1, 32}) {
    std::vector<double> reads;
    std::vector<double> exchanges;
    for (int round = 0; round < options.times(4); ++round) {
      const std::uint64_t before = drives.tap().recorded();
      const auto began = SteadyClock::now();
      if (clients == 0) {
        std::this_thread::sleep_for(lasting);
      } else {
        reads.push_back(replies_per_second({gateway.port(), request, 9U + 2U * kRegisters, clients, lasting}));
      }
      const double seconds = std::chrono::duration<double>(SteadyClock::now() - began).count();
      exchanges.push_back(static_cast<double>(drives.tap().recorded() - before) / seconds);
    }
    if (clients == 0) without = median(exchanges);
    fmt::print("{:<8} {:>14.0f} {:>16.1f} {:>8.3f} {:>8.1f}..{:.1f}\n", clients, clients == 0 ? 0 : median(reads),
               median(exchanges), median(exchanges) / without, quantile(exchanges, 0), quantile(exchanges, 1));
    std::fflush(stdout);
  }
}

}  // namespace axisgate::bench
