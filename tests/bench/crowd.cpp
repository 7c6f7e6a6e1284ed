// SPDX-License-Identifier: Apache-2.0
// A thousand clients of which a fifth is slow, and connections made as fast as the machine goes.
#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <cerrno>
#include <optional>
#include <stdexcept>

#include "tests/bench/benches.hpp"
#include "tests/bench/closed_loop_clients.hpp"
#include "tests/bench/modbus_client.hpp"
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
  ModbusClient connection;
  Clock::time_point due{}, asked{};
  std::size_t received = 0, said = 0;
  bool waits = false, gone = false;
};

bool slow(std::size_t index) { return index % (kClients / kSlow) == 0; }
bool drips(std::size_t index) { return slow(index) && index / (kClients / kSlow) % 2 == 0; }

/// What a slow client says; one that the server has cut stays away.
void say_slowly(One& one, std::size_t index, Bytes request) {
  const Bytes part = drips(index) ? request.subspan(one.said++ % request.size(), 1) : request;
  if (::send(one.connection.socket(), part.data(), part.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0 && errno != EAGAIN)
    one.gone = true;
}

void ask(One& one, Bytes request, Clock::time_point now) {
  if (::send(one.connection.socket(), request.data(), request.size(), MSG_NOSIGNAL) != std::ssize(request))
    throw std::runtime_error("a client that is not slow cannot ask");
  one.waits = true;
  one.asked = now;
}

/// The time of a whole reply.
std::optional<double> take(One& one, std::size_t reply_size) {
  std::array<Byte, 512> part;
  const ssize_t got = ::recv(one.connection.socket(), part.data(), part.size(), MSG_DONTWAIT);
  if (got == 0) throw std::runtime_error("the server closed a connection that was not slow");
  one.received += static_cast<std::size_t>(std::max<ssize_t>(got, 0));
  if (!one.waits || one.received < reply_size) return {};
  one.received = 0;
  one.waits = false;
  return std::chrono::duration<double, std::micro>(Clock::now() - one.asked).count();
}

/// From request to whole reply in microseconds, of all that are not slow.
Samples latencies(std::uint16_t port, const ReadRequest& request, milliseconds lasting) {
  const int ready_set = ::epoll_create1(EPOLL_CLOEXEC);
  std::vector<One> clients;
  clients.reserve(kClients);
  const Clock::time_point begun = Clock::now() + kPeriod;
  for (std::size_t i = 0; i < kClients; ++i) {
    clients.push_back({ModbusClient(port)});
    clients.back().due = begun + kPeriod * i / kClients;
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u64 = i;
    if (!slow(i)) ::epoll_ctl(ready_set, EPOLL_CTL_ADD, clients.back().connection.socket(), &event);
  }
  Samples out;
  std::array<epoll_event, 256> events{};
  std::size_t next = 0;  // they are due in the order of their making
  while (Clock::now() < begun + lasting) {
    const Clock::time_point now = Clock::now();
    for (std::size_t all = 0; all < kClients && clients[next].due <= now; ++all, next = (next + 1) % kClients) {
      One& one = clients[next];
      one.due += kPeriod;
      if (slow(next)) {
        if (!one.gone) say_slowly(one, next, request.bytes);
      } else if (!one.waits) {
        ask(one, request.bytes, now);
      }
    }
    const int ready = ::epoll_wait(ready_set, events.data(), static_cast<int>(events.size()), 0);
    for (int i = 0; i < ready; ++i)
      if (const auto took = take(clients[events.at(static_cast<std::size_t>(i)).data.u64], request.reply_size))
        out.push_back(*took);
  }
  ::close(ready_set);
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
