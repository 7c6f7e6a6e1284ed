// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/modbus_server/served.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"

namespace axisgate::test {

std::vector<Byte> read_request(std::uint16_t transaction, std::uint16_t address, std::uint16_t count) {
  std::vector<Byte> adu(12);
  store_be16(adu, 0, transaction);
  store_be16(adu, 4, 6);
  adu[6] = 0xFF;
  adu[7] = 0x03;
  store_be16(adu, 8, address);
  store_be16(adu, 10, count);
  return adu;
}

std::vector<Byte> write_request(std::uint16_t transaction, std::uint16_t address, std::uint16_t value) {
  std::vector<Byte> adu = read_request(transaction, address, value);
  adu[7] = 0x06;
  return adu;
}

Served::Served() {
  fill_image(image, 2, runtime.now());
  listeners.emplace_back();
  listeners.back().port = 0;
}

Served::~Served() {
  if (server) server->stop();
}

void Served::start() {
  std::uint32_t wanted = 0;
  for (const auto& listener : listeners) wanted += listener.max_clients;
  start(modbus_tcp::take_descriptors({.clients = wanted, .listeners = listeners.size()}));
}

void Served::start(const modbus_tcp::DescriptorPlan& descriptors) {
  server = std::make_unique<modbus_tcp::Server>(
      io, runtime, listeners, image, port, clients, log,
      modbus_tcp::ServerReports{[this](EventKind, std::string text) { events.push_back(std::move(text)); },
                                [this](bool down) { listener_down = down; }});
  server->start(descriptors);
}

bool Served::await(const std::function<bool()>& seen) {
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  while (!seen()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    io.restart();
    io.run_one_for(std::chrono::milliseconds(1));
    runtime.run_due();
  }
  return true;
}

void Served::settle() {
  do {
    io.restart();
    runtime.run_due();
  } while (io.poll() != 0);
}

void Served::pass(Duration time) {
  settle();
  runtime.advance_by(time);
  settle();
}

TestClient::TestClient(Served& served, std::size_t listener, Family family) : served_(served) {
  connect(listener, family, 0);
}

std::unique_ptr<TestClient> TestClient::with_small_buffer(Served& served) {
  std::unique_ptr<TestClient> client(new TestClient(served, Unconnected{}));
  client->connect(0, Family::v4, 1);  // the system rounds it up to its least
  return client;
}

TestClient::~TestClient() { leave(); }

void TestClient::connect(std::size_t listener, Family family, int receive_buffer) {
  const std::uint16_t port = served_.server->ports().at(listener);
  socket_ = ::socket(family == Family::v6 ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_GE(socket_, 0);
  const int on = 1;
  ASSERT_EQ(::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on), 0);
  if (receive_buffer != 0) {
    ASSERT_EQ(::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer), 0);
  }
  // The system completes a connection before the server accepts it: this does not wait for our own loop.
  int failed = -1;
  if (family == Family::v6) {
    sockaddr_in6 to{};
    to.sin6_family = AF_INET6;
    to.sin6_port = htons(port);
    to.sin6_addr = in6addr_loopback;
    failed = ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  } else {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    failed = ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  ASSERT_EQ(failed, 0) << errno;
  ASSERT_EQ(::fcntl(socket_, F_SETFL, O_NONBLOCK), 0);
}

void TestClient::send(const std::vector<Byte>& bytes) {
  std::size_t sent = 0;
  ASSERT_TRUE(served_.await([&] {
    sent += send_what_fits({bytes.begin() + static_cast<std::ptrdiff_t>(sent), bytes.end()});
    return sent == bytes.size() || ended_;
  }));
}

std::size_t TestClient::send_what_fits(const std::vector<Byte>& bytes) {
  const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent < 0 && errno != EAGAIN) ended_ = true;
  return sent < 0 ? 0 : static_cast<std::size_t>(sent);
}

void TestClient::take() {
  std::array<Byte, 65536> part;
  for (;;) {
    const ssize_t got = ::recv(socket_, part.data(), part.size(), 0);
    if (got > 0) {
      received_.insert(received_.end(), part.begin(), part.begin() + got);
      continue;
    }
    if (got == 0 || (errno != EAGAIN && errno != EINTR)) ended_ = true;
    return;
  }
}

std::vector<Byte> TestClient::receive(std::size_t bytes) {
  EXPECT_TRUE(served_.await([&] {
    take();
    return received_.size() >= bytes || ended_;
  }));
  const std::size_t got = std::min(bytes, received_.size());
  std::vector<Byte> result(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(got));
  received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(got));
  return result;
}

std::size_t TestClient::received_so_far() {
  take();
  return received_.size();
}

bool TestClient::closed_by_server() {
  return served_.await([&] {
    take();
    return ended_;
  });
}

void TestClient::leave(bool reset) {
  if (socket_ < 0) return;
  if (reset) {
    const linger none{1, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &none, sizeof none);
  }
  ::close(socket_);
  socket_ = -1;
  ended_ = true;
}

}  // namespace axisgate::test
