// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/modbus_client.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace axisgate::bench {
namespace {

constexpr std::size_t kMbap = 7;

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error("Modbus client: " + what); }

void receive(int socket, std::span<Byte> into) {
  for (std::size_t got = 0; got < into.size();) {
    const ssize_t more = ::recv(socket, into.data() + got, into.size() - got, 0);
    if (more <= 0) fail(more == 0 ? "the gateway closed the connection" : std::strerror(errno));
    got += static_cast<std::size_t>(more);
  }
}

}  // namespace

ModbusClient::ModbusClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const int on = 1;
  const timeval patience{5, 0};
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return;
  ::close(socket_);
  fail(std::strerror(errno));
}

ModbusClient::~ModbusClient() { close(); }

void ModbusClient::close() {
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
}

void ModbusClient::reset() {
  const linger at_once{1, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  close();
}

ModbusClient::ModbusClient(ModbusClient&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

Bytes ModbusClient::ask(std::span<const Byte> pdu) {
  std::array<Byte, 260> request{};
  store_be16(request, 0, ++transaction_);
  store_be16(request, 4, static_cast<std::uint16_t>(pdu.size() + 1));
  request[6] = 0xFF;
  std::copy(pdu.begin(), pdu.end(), request.begin() + kMbap);
  const std::size_t size = kMbap + pdu.size();
  if (::send(socket_, request.data(), size, MSG_NOSIGNAL) != static_cast<ssize_t>(size)) fail(std::strerror(errno));
  std::array<Byte, kMbap> header{};
  receive(socket_, header);
  if (load_be16(header, 0) != transaction_) fail("a reply to another request");
  reply_.resize(load_be16(header, 4) - 1U);
  receive(socket_, reply_);
  return reply_;
}

std::vector<std::uint16_t> ModbusClient::read(std::uint16_t address, std::uint16_t count) {
  std::array<Byte, 5> pdu{3};
  store_be16(pdu, 1, address);
  store_be16(pdu, 3, count);
  const Bytes reply = ask(pdu);
  if (reply[0] != 3 || reply.size() != 2U + 2U * count) fail("exception " + std::to_string(reply[1]) + " to a read");
  std::vector<std::uint16_t> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(load_be16(reply, 2 + 2 * i));
  return values;
}

int ModbusClient::write(std::uint16_t address, std::span<const std::uint16_t> values) {
  std::vector<Byte> pdu(6 + 2 * values.size());
  pdu[0] = 16;
  store_be16(pdu, 1, address);
  store_be16(pdu, 3, static_cast<std::uint16_t>(values.size()));
  pdu[5] = static_cast<Byte>(2 * values.size());
  for (std::size_t i = 0; i < values.size(); ++i) store_be16(pdu, 6 + 2 * i, values[i]);
  const Bytes reply = ask(pdu);
  return reply[0] == 16 ? 0 : reply[1];
}

int ModbusClient::write_coil(std::uint16_t address, bool on) {
  std::array<Byte, 5> pdu{5};
  store_be16(pdu, 1, address);
  pdu[3] = on ? 0xFF : 0x00;
  const Bytes reply = ask(pdu);
  return reply[0] == 5 ? 0 : reply[1];
}

bool ModbusClient::read_object(std::uint8_t node, std::uint16_t index, std::uint8_t sub) {
  constexpr Byte kEncapsulated = 0x2B, kGeneralReference = 0x0D;
  std::array<Byte, 12> pdu{kEncapsulated, kGeneralReference, 0, 0, node};  // start 0, count 0: all there are
  store_be16(pdu, 5, index);
  pdu[7] = sub;
  return ask(pdu)[0] == kEncapsulated;
}

}  // namespace axisgate::bench
