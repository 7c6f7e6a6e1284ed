// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/web/looking.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace axisgate::bench {
namespace {

constexpr std::chrono::seconds kPatience{10};

int connected(std::uint16_t port, std::string_view path) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port = htons(port);
  const std::string request = "GET " + std::string(path) + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                              "\r\nConnection: close\r\n\r\n";
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0 ||
      ::send(socket, request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size())) {
    ::close(socket);
    throw std::runtime_error("axisgate-web does not take a connection");
  }
  return socket;
}

}  // namespace

std::string Looking::get(std::uint16_t port, std::string_view path) {
  const int socket = connected(port, path);
  std::string answer;
  std::array<char, 65536> part{};
  for (ssize_t got = 0; (got = ::recv(socket, part.data(), part.size(), 0)) > 0;)
    answer.append(part.data(), static_cast<std::size_t>(got));
  ::close(socket);
  return answer;
}

Looking::Looking(std::uint16_t port, int pages, int period_ms, const std::string& series)
    : seen_(static_cast<std::size_t>(pages)), left_(seen_.size()) {
  for (int page = 0; page < pages; ++page)
    sockets_.push_back(connected(
        port, "/api/v1/stream?period_ms=" + std::to_string(period_ms) + (series.empty() ? "" : "&series=" + series)));
  if (pages == 0) return;
  thread_ = std::thread([this] { read(); });
  if (all_seen_.get_future().wait_for(kPatience) != std::future_status::ready)
    throw std::runtime_error("not every stream has begun");
}

Looking::~Looking() {
  ends_ = true;
  for (const int socket : sockets_) ::shutdown(socket, SHUT_RDWR);
  if (thread_.joinable()) thread_.join();
  for (const int socket : sockets_) ::close(socket);
}

void Looking::read() {
  std::vector<pollfd> waits;
  for (const int socket : sockets_) waits.push_back({socket, POLLIN, 0});
  std::array<char, 65536> part{};
  while (!ends_) {
    if (::poll(waits.data(), waits.size(), 1000) < 0) return;
    for (std::size_t page = 0; page < waits.size(); ++page) {
      if (waits[page].revents == 0) continue;
      const ssize_t got = ::recv(waits[page].fd, part.data(), part.size(), 0);
      if (got <= 0) {
        waits[page].fd = -1;
        continue;
      }
      bytes_ += static_cast<std::uint64_t>(got);
      take(page, {part.data(), static_cast<std::size_t>(got)});
    }
  }
}

void Looking::take(std::size_t page, std::string_view text) {
  if (!seen_[page] && text.find("event: axes") != text.npos) {
    seen_[page] = true;
    if (--left_ == 0) all_seen_.set_value();
  }
  if (page != 0) return;
  const std::lock_guard lock(mutex_);
  if (wanted_.empty()) return;
  tail_ += text;
  if (tail_.find(wanted_) != tail_.npos) {
    found_.set_value(std::chrono::steady_clock::now());
    wanted_.clear();
  }
  tail_.erase(0, tail_.size() - std::min(tail_.size(), std::size_t{256}));
}

void Looking::look_for(std::string text) {
  const std::lock_guard lock(mutex_);
  wanted_ = std::move(text);
  tail_.clear();
  found_ = {};
  asked_ = std::chrono::steady_clock::now();
}

std::chrono::duration<double> Looking::until_first_page_reads(const std::string& text) {
  auto found = found_.get_future();
  if (found.wait_for(kPatience) != std::future_status::ready) throw std::runtime_error("no page has read " + text);
  return found.get() - asked_;
}

}  // namespace axisgate::bench
