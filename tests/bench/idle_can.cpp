#include "tests/bench/idle_can.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <thread>

#include "tests/bench/gateway_process.hpp"
#include "tests/bench/line_protocol.hpp"
#include "tests/bench/modbus_client.hpp"
#include "tests/bench/simulator_process.hpp"

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;

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
  fmt::print("{:<44} {:>14.1f} {:>12.1f} {:>14.1f}\n", setting.what, (counter(client, kRequests) - before) / seconds,
             static_cast<double>(load) / 10, 100 * busy / seconds);
  std::fflush(stdout);
}

}  // namespace

void idle_can(const BenchOptions& options) {
  fmt::print(
      "Drives online, disabled, standing, polled as by default (20, 100, 1000 ms), 500 kbit/s; TPDOs carry the state\n"
      "{:<44} {:>14} {:>12} {:>14}\n",
      "", "SDO requests/s", "bus load %", "processor %");
  const std::string ld2 = entry("leadshine-ld2-can", 1), jd = entry("kinco-jd", 2), md = entry("kinco-md", 3);
  const std::array settings{
      Setting{"a Leadshine LD2-CAN", "ld2@1", ld2, 1},
      Setting{"a Leadshine LD2-CAN, a Kinco JD, a Kinco MD", "ld2@1,jd@2,md@3", ld2 + ", " + jd + ", " + md, 3}};
  for (const Setting& setting : settings) measure(setting, options);
}

}  // namespace axisgate::bench
