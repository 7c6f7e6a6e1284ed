#include "tests/bench/bare_loop.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace axisgate::bench {

using simulated::FrameCommand;
using simulated::TenByteFrame;
using SteadyClock = std::chrono::steady_clock;

BareLoop::BareLoop(const std::string& device) : port_(::open(device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
  if (port_ < 0) throw std::runtime_error(device + ": " + std::strerror(errno));
}

BareLoop::~BareLoop() { ::close(port_); }

std::chrono::nanoseconds BareLoop::exchange(const TenByteFrame& request) const {
  const auto began = SteadyClock::now();
  if (::write(port_, request.data(), request.size()) != static_cast<ssize_t>(request.size()))
    throw std::runtime_error("the port takes no bytes");
  TenByteFrame reply;
  for (std::size_t got = 0; got < reply.size();) {
    pollfd ready{port_, POLLIN, 0};
    if (::poll(&ready, 1, 1000) <= 0) throw std::runtime_error("no reply for 1 s");
    const ssize_t more = ::read(port_, reply.data() + got, reply.size() - got);
    if (more <= 0) throw std::runtime_error("the port hung up");
    got += static_cast<std::size_t>(more);
  }
  return SteadyClock::now() - began;
}

std::vector<double> bare_exchanges(const std::string& device, std::chrono::milliseconds lasting) {
  const TenByteFrame writes[] = {simulated::seal(1, FrameCommand::write_4, 0x6081, 0, 100'000),
                                 simulated::seal(1, FrameCommand::write_4, 0x6081, 0, 200'000)};
  const TenByteFrame read = simulated::seal(1, FrameCommand::read, 0x6041, 0, 0);
  const BareLoop loop(device);
  std::vector<double> microseconds;
  const auto end = SteadyClock::now() + lasting;
  for (std::size_t i = 0; SteadyClock::now() < end; ++i) {
    for (const TenByteFrame* frame : {&writes[i % 2], &read})
      microseconds.push_back(std::chrono::duration<double, std::micro>(loop.exchange(*frame)).count());
  }
  return microseconds;
}

}  // namespace axisgate::bench
