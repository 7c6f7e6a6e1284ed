// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/gateway_process.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "tests/bench/modbus_client.hpp"

namespace axisgate::bench {
namespace {

std::uint16_t free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof here;
  auto* address = reinterpret_cast<sockaddr*>(&here);
  const bool bound = ::bind(socket, address, size) == 0 && ::getsockname(socket, address, &size) == 0;
  ::close(socket);
  if (!bound) throw std::runtime_error("no free port");
  return ntohs(here.sin_port);
}

/// What a bus of this protocol must be told beside its name and adapter.
std::string device_keys(LineProtocol protocol, const std::string& device) {
  if (is_can(protocol))
    return fmt::format(R"("device": "{}{}", "bitrate": {})", protocol == LineProtocol::slcan ? "slcan:" : "", device,
                       kBitRate);
  return fmt::format(R"("device": "{}", "rs485": "off", "baud": {})", device, baud_of(protocol));
}

std::string buses_of(const DriveProcess& drives, const PollPeriods& periods) {
  const LineProtocol protocol = drives.shape().protocol;
  std::string buses;
  int axis = 0;
  for (int line = 0; line < drives.shape().lines; ++line) {
    std::string entries;
    for (int station = 1; station <= drives.shape().drives_per_line; ++station) {
      entries += fmt::format(
          R"({}{{"profile": "kinco-jd", "node": {}, "constants": {{"peak_current_a": 27.5}}, "axes": [{{"axis": {}}}]}})",
          station == 1 ? "" : ", ", station, ++axis);
    }
    buses += fmt::format(R"({}{{"name": "line{}", "adapter": "{}", {},)"
                         R"( "poll": {{"fast": {}, "normal": {}, "slow": {}}}, "drives": [{}]}})",
                         line == 0 ? "" : ",\n", line, adapter_of(protocol), device_keys(protocol, drives.device(line)),
                         periods.fast, periods.normal, periods.slow, entries);
  }
  return buses;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

GatewayProcess::GatewayProcess(const std::string& program, const std::string& folder, const DriveProcess& drives,
                               const PollPeriods& periods, unsigned processor)
    : GatewayProcess(program, folder, buses_of(drives, periods), drives.shape().lines * drives.shape().drives_per_line,
                     processor) {}

GatewayProcess::GatewayProcess(const std::string& program, const std::string& folder, const std::string& buses,
                               int axes, unsigned processor, const std::string& listener)
    : axes_(axes), port_(free_port()) {
  const std::string config = folder + "/gateway.json";
  const std::string log = folder + "/gateway.log";
  std::ofstream(config) << fmt::format("{{\"modbus_tcp\": [{{\"listen\": \"127.0.0.1:{}\"{}{}}}],\n\"buses\": [{}]}}\n",
                                       port_, listener.empty() ? "" : ", ", listener, buses);
  process_.emplace(
      processor,
      [&] {
        become(program, {"run", config, "--log-level", "warning"}, log);
      },
      SIGTERM);
  try {
    await_axes();
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}; it said:\n{}", error.what(), text_of(log)));
  }
}

void GatewayProcess::await_axes() {
  const auto end = SteadyClock::now() + std::chrono::seconds(30);
  int online = 0;
  while (SteadyClock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    try {
      ModbusClient client(port_);
      online = client.read(3, 1).front();
      if (online < axes_) continue;
      int ready = 0;
      for (int axis = 1; axis <= axes_; ++axis)
        ready += client.read(static_cast<std::uint16_t>(100 * axis + 18), 1).front() == 2 ? 1 : 0;
      if (ready == axes_) return;
    } catch (const std::exception&) {
      if (process_->ended()) throw std::runtime_error("the gateway ended");
    }
  }
  throw std::runtime_error(fmt::format("{} of {} axes online after 30 s", online, axes_));
}

std::chrono::nanoseconds GatewayProcess::processor_time() const {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process_->id(), &clock) != 0 || ::clock_gettime(clock, &time) != 0)
    throw std::runtime_error("the gateway's processor time is not told");
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

GatewayProcess::Memory GatewayProcess::memory() const {
  std::ifstream in(fmt::format("/proc/{}/status", process_->id()));
  Memory memory;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("VmRSS:")) memory.resident = std::stoul(line.substr(6));
    if (line.starts_with("RssAnon:")) memory.anonymous = std::stoul(line.substr(8));
  }
  if (memory.resident == 0) throw std::runtime_error("the gateway's memory is not told");
  return memory;
}

}  // namespace axisgate::bench
