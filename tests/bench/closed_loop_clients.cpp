// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/closed_loop_clients.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "tests/bench/modbus_client.hpp"

namespace axisgate::bench {
namespace {

using Events = std::array<epoll_event, 128>;

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

class EpollSet {
 public:
  EpollSet() : descriptor_(::epoll_create1(EPOLL_CLOEXEC)) {}
  ~EpollSet() { ::close(descriptor_); }
  EpollSet(const EpollSet&) = delete;
  EpollSet& operator=(const EpollSet&) = delete;
  void add(int socket, std::uint32_t index) const {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u32 = index;
    if (::epoll_ctl(descriptor_, EPOLL_CTL_ADD, socket, &event) != 0) fail("epoll_ctl");
  }
  [[nodiscard]] int wait(Events& events) const {
    const int ready = ::epoll_wait(descriptor_, events.data(), static_cast<int>(events.size()), 2000);
    if (ready == 0) throw std::runtime_error("no reply for 2 s");
    return ready;
  }

 private:
  int descriptor_;
};

struct Client {
  ModbusClient connection;
  std::size_t received = 0;

  void ask(Bytes request) const {
    if (::send(connection.socket(), request.data(), request.size(), MSG_NOSIGNAL) != std::ssize(request)) fail("send");
  }
  /// True: the reply is whole.
  bool take(std::size_t reply_size) {
    std::array<Byte, 512> part;
    const ssize_t got = ::recv(connection.socket(), part.data(), part.size(), MSG_DONTWAIT);
    if (got == 0) throw std::runtime_error("the server closed a connection");
    if (got < 0) fail("recv");
    received += static_cast<std::size_t>(got);
    if (received > reply_size) throw std::runtime_error("the server's reply is too long");
    const bool whole = received == reply_size;
    if (whole) received = 0;
    return whole;
  }
};

}  // namespace

ReadRequest::ReadRequest(std::uint16_t address, std::uint16_t registers)
    : bytes{0, 1, 0, 0, 0, 6, 0xFF, 3}, reply_size(9U + 2U * registers) {
  store_be16(bytes, 8, address);
  store_be16(bytes, 10, registers);
}

double replies_per_second(std::uint16_t port, const ReadRequest& request, int count,
                          std::chrono::milliseconds lasting) {
  using Clock = std::chrono::steady_clock;
  std::vector<Client> clients;
  const EpollSet ready_set;
  for (int i = 0; i < count; ++i) {
    clients.push_back({ModbusClient(port)});
    ready_set.add(clients.back().connection.socket(), static_cast<std::uint32_t>(i));
  }
  for (const Client& client : clients) client.ask(request.bytes);

  const auto counted_from = Clock::now() + lasting / 10;
  const auto end = counted_from + lasting;
  std::uint64_t replies = 0;
  Events events;
  for (;;) {
    const int ready = ready_set.wait(events);
    const auto now = Clock::now();
    if (now >= end) break;
    for (int i = 0; i < ready; ++i) {
      Client& client = clients[events[static_cast<std::size_t>(i)].data.u32];
      if (!client.take(request.reply_size)) continue;
      if (now >= counted_from) ++replies;
      client.ask(request.bytes);
    }
  }
  return static_cast<double>(replies) / std::chrono::duration<double>(lasting).count();
}

}  // namespace axisgate::bench
