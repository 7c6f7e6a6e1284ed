// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/host/packet_socket.hpp"

#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cerrno>
#include <utility>

#include "gateway/upstream/link/coder.hpp"

namespace axisgate::host {

PacketSocket::PacketSocket(boost::asio::io_context& context, int descriptor)
    : descriptor_(context, descriptor), buffer_(link::kMaxPacket) {}

PacketSocket::Sent PacketSocket::send(Bytes packet) {
  ssize_t sent = 0;
  do {
    sent = ::send(descriptor_.native_handle(), packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  if (sent >= 0) return Sent::yes;
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS || errno == ENOMEM ? Sent::no_room : Sent::closed;
}

std::size_t PacketSocket::unread() const {
  int bytes = 0;
  return ::ioctl(descriptor_.native_handle(), SIOCOUTQ, &bytes) == 0 ? static_cast<std::size_t>(bytes) : 0;
}

PacketSocket::Received PacketSocket::receive() {
  ssize_t got = 0;
  do {
    got = ::recv(descriptor_.native_handle(), buffer_.data(), buffer_.size(), MSG_DONTWAIT | MSG_TRUNC);
  } while (got < 0 && errno == EINTR);
  if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return {};
  // No record is empty, so that 0 bytes are the end, as recv() tells it.
  if (got <= 0) return {Got::closed};
  const auto size = static_cast<std::size_t>(got);
  if (size > buffer_.size()) return {Got::too_long};
  return {Got::packet, Bytes(buffer_).first(size)};
}

void PacketSocket::wait(Wait::wait_type what, std::function<void()> call) {
  descriptor_.async_wait(what, [call = std::move(call), alive = std::weak_ptr(alive_)](const auto& error) {
    if (!alive.expired() && !error) call();
  });
}

}  // namespace axisgate::host
