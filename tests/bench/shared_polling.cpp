// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <thread>

#include "tests/bench/benches.hpp"
#include "tests/bench/closed_loop_clients.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/modbus_client.hpp"

namespace axisgate::bench {

void shared_polling(const BenchOptions& options, LineProtocol protocol) {
  constexpr std::uint16_t kAxis = 100;
  stay_on_processor(1);
  DriveLines shape;
  shape.reply_after = std::chrono::milliseconds(1);
  shape.protocol = protocol;
  const DriveProcess drives(shape, options.folder);
  const GatewayProcess gateway(options.program, options.folder, drives, {});
  const auto lasting = options.lasting(std::chrono::milliseconds(5000));
  double without = 0;
  for (const int clients : {0, 1, 32}) {
    Samples exchanges;
    for (int round = 0; round < options.times(4); ++round) {
      const ExchangeRate rate(drives.tap());
      if (clients == 0)
        std::this_thread::sleep_for(lasting);
      else
        static_cast<void>(replies_per_second(gateway.port(), ReadRequest(kAxis, kRegisters), clients, lasting));
      exchanges.push_back(rate.per_second());
    }
    if (clients == 0)
      without = median(exchanges);
    else
      options.report.row(fmt::format("exchanges while {} read without a pause, 1/s", clients), median(exchanges),
                         Beside{"no client", without});
  }
}

}  // namespace axisgate::bench
