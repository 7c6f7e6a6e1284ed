// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/closed_loop_clients.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace axisgate::bench {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

EpollSet::EpollSet() : descriptor_(::epoll_create1(EPOLL_CLOEXEC)) {}

EpollSet::~EpollSet() { ::close(descriptor_); }

void EpollSet::add(const ModbusClient& client, std::uint32_t index) const {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u32 = index;
  if (::epoll_ctl(descriptor_, EPOLL_CTL_ADD, client.socket(), &event) != 0) fail("epoll_ctl");
}

std::span<const epoll_event> EpollSet::wait(std::chrono::milliseconds patience) {
  const int ready =
      ::epoll_wait(descriptor_, events_.data(), static_cast<int>(events_.size()), static_cast<int>(patience.count()));
  return std::span(events_).first(static_cast<std::size_t>(std::max(ready, 0)));
}

void AskingClient::ask(Bytes request) const {
  if (::send(connection.socket(), request.data(), request.size(), MSG_NOSIGNAL) != std::ssize(request)) fail("send");
}

bool AskingClient::take(std::size_t reply_size) {
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

ReadRequest::ReadRequest(std::uint16_t address, std::uint16_t registers)
    : bytes{0, 1, 0, 0, 0, 6, 0xFF, 3}, reply_size(9U + 2U * registers) {
  store_be16(bytes, 8, address);
  store_be16(bytes, 10, registers);
}

double replies_per_second(std::uint16_t port, const ReadRequest& request, int count,
                          std::chrono::milliseconds lasting) {
  using Clock = std::chrono::steady_clock;
  std::vector<AskingClient> clients;
  EpollSet ready_set;
  for (int i = 0; i < count; ++i) {
    clients.push_back({ModbusClient(port)});
    ready_set.add(clients.back().connection, static_cast<std::uint32_t>(i));
  }
  for (const AskingClient& client : clients) client.ask(request.bytes);

  const auto counted_from = Clock::now() + lasting / 10;
  const auto end = counted_from + lasting;
  std::uint64_t replies = 0;
  for (;;) {
    const auto ready = ready_set.wait(std::chrono::seconds(2));
    if (ready.empty()) throw std::runtime_error("no reply for 2 s");
    const auto now = Clock::now();
    if (now >= end) break;
    for (const epoll_event& event : ready) {
      AskingClient& client = clients[event.data.u32];
      if (!client.take(request.reply_size)) continue;
      if (now >= counted_from) ++replies;
      client.ask(request.bytes);
    }
  }
  return static_cast<double>(replies) / std::chrono::duration<double>(lasting).count();
}

}  // namespace axisgate::bench
