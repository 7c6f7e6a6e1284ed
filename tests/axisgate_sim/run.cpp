// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/run.hpp"

#include <poll.h>
#include <sys/signalfd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace axisgate::simulated {
namespace {

// A moving motor is brought up to date at least so often, so that no request finds a long way to compute.
constexpr Time longest_sleep = std::chrono::milliseconds(100);

timespec until(std::optional<Time> event, Time now) {
  const Time wait = std::clamp(event.value_or(now + longest_sleep) - now, Time{}, longest_sleep);
  return {wait / std::chrono::seconds(1), (wait % std::chrono::seconds(1)).count()};
}

void serve_ports(Simulator& simulator, const std::vector<pollfd>& watched) {
  for (const pollfd& ready : watched) {
    if (ready.revents == 0) continue;
    for (auto& [name, port] : simulator.lines()) {
      if (port.port && ready.fd == port.port->closings()) port.port->user_closed();
      if (!port.port || ready.fd != port.port->readable()) continue;
      const auto bytes = port.port->read();
      if (!bytes.empty()) port.line->from_host(bytes, simulator.now());
    }
  }
}

}  // namespace

Descriptor block_end_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  if (::sigprocmask(SIG_BLOCK, &signals, nullptr) != 0) throw std::runtime_error(std::strerror(errno));
  Descriptor descriptor(::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
  if (descriptor.get() < 0) throw std::runtime_error(std::strerror(errno));
  return descriptor;
}

void run(Simulator& simulator, ControlSocket* control, const Descriptor& end_signals) {
  std::vector<pollfd> watched;
  for (;;) {
    const auto next = simulator.advance();
    watched.clear();
    watched.push_back({end_signals.get(), POLLIN, 0});
    for (const auto& [name, port] : simulator.lines()) {
      if (!port.port) continue;
      watched.push_back({port.port->readable(), POLLIN, 0});
      if (port.port->closings() >= 0) watched.push_back({port.port->closings(), POLLIN, 0});
    }
    if (control != nullptr) control->add_to(watched);
    const timespec wait = until(next, simulator.now());
    if (::ppoll(watched.data(), watched.size(), &wait, nullptr) <= 0) continue;
    if (watched.front().revents != 0) return;
    serve_ports(simulator, watched);
    if (control != nullptr) control->serve(watched);
  }
}

}  // namespace axisgate::simulated
