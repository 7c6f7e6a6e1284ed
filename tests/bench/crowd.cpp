// SPDX-License-Identifier: Apache-2.0
// A thousand clients of which a fifth is slow, and connections made as fast as the machine goes.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <cerrno>

#include "tests/bench/benches.hpp"
#include "tests/bench/closed_loop_clients.hpp"
#include "tests/bench/process.hpp"
#include "tests/bench/servers.hpp"

namespace axisgate::bench {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t kClients = 1000, kSlow = 200;  // of them
constexpr milliseconds kPeriod(100);

/// One of a thousand. Of the slow ones every other says a byte at a time, and the rest never read.
struct One {
  AskingClient client;
  Clock::time_point due{}, asked{};
  std::size_t said = 0;
  bool waits = false, gone = false;
};

bool slow(std::size_t index) { return index % (kClients / kSlow) == 0; }
bool drips(std::size_t index) { return slow(index) && index / (kClients / kSlow) % 2 == 0; }

/// What a slow client says; one that the server has cut stays away.
void say_slowly(One& one, std::size_t index, Bytes request) {
  const Bytes part = drips(index) ? request.subspan(one.said++ % request.size(), 1) : request;
  if (::send(one.client.connection.socket(), part.data(), part.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0 &&
      errno != EAGAIN)
    one.gone = true;
}

/// From request to whole reply in microseconds, of all that are not slow.
Samples latencies(std::uint16_t port, const ReadRequest& request, milliseconds lasting) {
  EpollSet ready_set;
  std::vector<One> clients;
  clients.reserve(kClients);
  const Clock::time_point begun = Clock::now() + kPeriod;
  for (std::size_t i = 0; i < kClients; ++i) {
    clients.push_back({.client = {ModbusClient(port)}, .due = begun + kPeriod * i / kClients});
    if (!slow(i)) ready_set.add(clients.back().client.connection, static_cast<std::uint32_t>(i));
  }
  Samples out;
  std::size_t next = 0;  // they are due in the order of their making
  while (Clock::now() < begun + lasting) {
    const Clock::time_point now = Clock::now();
    for (std::size_t all = 0; all < kClients && clients[next].due <= now; ++all, next = (next + 1) % kClients) {
      One& one = clients[next];
      one.due += kPeriod;
      if (slow(next)) {
        if (!one.gone) say_slowly(one, next, request.bytes);
      } else if (!one.waits) {
        one.client.ask(request.bytes);
        one.waits = true;
        one.asked = now;
      }
    }
    for (const epoll_event& event : ready_set.wait({})) {
      One& one = clients[event.data.u32];
      if (!one.client.take(request.reply_size)) continue;
      one.waits = false;
      out.push_back(std::chrono::duration<double, std::micro>(Clock::now() - one.asked).count());
    }
  }
  return out;
}

double connects_per_second(std::uint16_t port, milliseconds lasting) {
  int made = 0;
  const Clock::time_point begun = Clock::now();
  for (; Clock::now() < begun + lasting; ++made) {
    ModbusClient one(port);
    one.reset();  // no port of ours is kept for it
  }
  return made / std::chrono::duration<double>(Clock::now() - begun).count();
}

void allow_descriptors() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

void crowd(const BenchOptions& options) {
  allow_descriptors();
  stay_on_processor(1);  // the servers are on processor 0
  const ReadRequest request(100, kRegisters);
  const ServerProcess ours(serve_axisgate);
  const ServerProcess echo(
      [&](const ServerProcess::Ready& ready) { serve_echo(request.bytes.size(), request.reply_size, ready); });
  Samples took, echo_took, rates, echo_rates;
  for (int round = 0; round < options.times(5); ++round) {
    append(took, latencies(ours.port(), request, options.lasting(milliseconds(3000))));
    append(echo_took, latencies(echo.port(), request, options.lasting(milliseconds(3000))));
    rates.push_back(connects_per_second(ours.port(), options.lasting(milliseconds(1000))));
    echo_rates.push_back(connects_per_second(echo.port(), options.lasting(milliseconds(1000))));
  }
  options.report.rows(fmt::format("read of {} clients, {} of them slow, us", kClients, kSlow), took, "echo server",
                      echo_took);
  options.report.row("connections made and reset per second", median(rates), bare(median(echo_rates)));
}

}  // namespace axisgate::bench
