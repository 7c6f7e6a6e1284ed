// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <thread>

#include "tests/bench/benches.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/modbus_client.hpp"
#include "tests/bench/simulator_process.hpp"

namespace axisgate::bench {
namespace {

struct Setting {
  const char* what;
  std::string simulated;
  std::string configured;
  int axes;
};

std::string entry(const char* profile, int node) {
  return fmt::format(R"({{"profile": "{}", "node": {}, "axes": [{{"axis": {}}}]}})", profile, node, node);
}

std::uint32_t counter(ModbusClient& client, std::uint16_t offset) {
  const auto words = client.read(static_cast<std::uint16_t>(50'000 + offset), 2);
  return std::uint32_t{words[0]} << 16 | words[1];
}

void measure(const Setting& setting, const BenchOptions& options) {
  constexpr std::uint16_t kRequests = 4;
  constexpr std::chrono::seconds kSettled{4};  // values of class once are read, set-points found
  const std::string path = options.folder + "/can";
  const SimulatorProcess simulator({path + ":lawicel:" + setting.simulated});
  const GatewayProcess gateway(
      options.program, options.folder,
      fmt::format(R"({{"name": "can", "adapter": "canopen", "device": "slcan:{}", "bitrate": {}, "drives": [{}]}})",
                  path, kBitRate, setting.configured),
      setting.axes);
  ModbusClient client(gateway.port());
  std::this_thread::sleep_for(options.lasting(kSettled));
  const auto began = SteadyClock::now();
  const std::uint32_t before = counter(client, kRequests);
  const auto processor_before = gateway.processor_time();
  std::this_thread::sleep_for(options.lasting(std::chrono::milliseconds(10'000)));
  const double seconds = std::chrono::duration<double>(SteadyClock::now() - began).count();
  const double busy = std::chrono::duration<double>(gateway.processor_time() - processor_before).count();
  const auto load = client.read(50'001, 1).front();
  options.report.row(fmt::format("{}: SDO requests/s", setting.what), (counter(client, kRequests) - before) / seconds);
  options.report.row(fmt::format("{}: bus load, %", setting.what), static_cast<double>(load) / 10);
  options.report.row(fmt::format("{}: processor, %", setting.what), 100 * busy / seconds);
}

}  // namespace

void idle_can(const BenchOptions& options) {
  const std::string ld2 = entry("leadshine-ld2-can", 1), jd = entry("kinco-jd", 2), md = entry("kinco-md", 3);
  const std::array settings{Setting{"a Leadshine LD2-CAN", "ld2@1", ld2, 1},
                            Setting{"an LD2-CAN, a JD, an MD", "ld2@1,jd@2,md@3", ld2 + ", " + jd + ", " + md, 3}};
  for (const Setting& setting : settings) measure(setting, options);
}

}  // namespace axisgate::bench
