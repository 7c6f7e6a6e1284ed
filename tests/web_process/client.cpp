// SPDX-License-Identifier: Apache-2.0
#include "tests/web_process/client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "tests/web_process/web.hpp"

namespace axisgate::web::test {

std::string get_of(const std::string& target, const std::string& fields) {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n";
}

Client::Client(std::uint16_t port, int receive_buffer) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (receive_buffer != 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(socket_);
    throw std::runtime_error("nobody listens");
  }
}

Client::~Client() { close(socket_); }

bool Client::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (size < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
  return true;
}

bool Client::more() {
  pollfd readable{socket_, POLLIN, 0};
  if (poll(&readable, 1, static_cast<int>(std::chrono::milliseconds(kPatience).count())) != 1)
    throw std::runtime_error("axisgate-web answers nothing");
  std::array<char, 65536> part{};
  const ssize_t size = recv(socket_, part.data(), part.size(), 0);
  if (size <= 0) return false;
  bytes_.append(part.data(), static_cast<std::size_t>(size));
  return true;
}

std::optional<std::string> Client::until(const std::string& text) {
  std::size_t at = 0;
  while ((at = bytes_.find(text)) == std::string::npos)
    if (!more()) return std::nullopt;
  std::string out = bytes_.substr(0, at + text.size());
  bytes_.erase(0, at + text.size());
  return out;
}

Answered Client::answer() {
  const auto header = until("\r\n\r\n");
  if (!header) return {};
  Answered out{static_cast<unsigned>(std::stoul(header->substr(9, 3))), *header, ""};
  const std::size_t length = header->find("Content-Length: ");
  if (length == std::string::npos) return out;
  const std::size_t size = std::stoul(header->substr(length + 16));
  while (bytes_.size() < size)
    if (!more()) return out;
  out.body = bytes_.substr(0, size);
  bytes_.erase(0, size);
  return out;
}

Client::Whole Client::chunks() {
  constexpr int kHex = 16;
  Whole out;
  for (;;) {
    const auto length = until("\r\n");
    if (!length) return out;
    const std::size_t size = std::stoul(*length, nullptr, kHex);
    while (bytes_.size() < size + 2)
      if (!more()) return out;
    out.body += bytes_.substr(0, size);
    bytes_.erase(0, size + 2);
    if (size == 0) out.complete = true;
    if (size == 0) return out;
  }
}

Answered Client::get(const std::string& target, const std::string& fields) {
  send(get_of(target, fields));
  return answer();
}

std::optional<nlohmann::json> Client::event(const std::string& name) {
  for (;;) {
    const auto frame = until("\n\n");
    if (!frame) return std::nullopt;
    if (frame->find("event: " + name + "\n") == std::string::npos) continue;
    const std::size_t data = frame->find("data: ");
    return nlohmann::json::parse(frame->substr(data + 6));
  }
}

std::string Client::rest() {
  while (more()) {
  }
  return std::exchange(bytes_, {});
}

bool Client::closed() {
  while (more()) {
  }
  return true;
}

}  // namespace axisgate::web::test
