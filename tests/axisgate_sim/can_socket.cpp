// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/can_socket.hpp"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace axisgate::simulated {
namespace {

constexpr int most_frames = 64;  // of one read()

[[noreturn]] void fail(const std::string& what, const std::string& remedy) {
  throw std::runtime_error(what + ": " + std::strerror(errno) + remedy);
}

}  // namespace

CanSocket::CanSocket(const std::string& interface) : interface_(interface) {
  const std::string remedy =
      "; make it with: ip link add dev " + interface + " type vcan && ip link set " + interface + " up";
  const unsigned index = ::if_nametoindex(interface.c_str());
  if (index == 0) fail("no interface is called " + interface, remedy);
  socket_ = Descriptor(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (socket_.get() < 0) fail("cannot open a CAN socket", "; load the kernel module can_raw");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    fail("cannot use " + interface, remedy);
  }
}

std::vector<std::uint8_t> CanSocket::read() {
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < most_frames; ++i) {
    std::array<std::uint8_t, sizeof(can_frame)> frame{};
    if (::read(socket_.get(), frame.data(), frame.size()) != static_cast<ssize_t>(frame.size())) break;
    bytes.insert(bytes.end(), frame.begin(), frame.end());
  }
  return bytes;
}

void CanSocket::write(std::span<const std::uint8_t> bytes) {
  for (; bytes.size() >= sizeof(can_frame); bytes = bytes.subspan(sizeof(can_frame))) {
    (void)!::write(socket_.get(), bytes.data(), sizeof(can_frame));
  }
}

}  // namespace axisgate::simulated
