// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/program/link_socket.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/start_error.hpp"

namespace axisgate::program {

LinkSocket::LinkSocket(int fd, const std::string& hint) : fd_(fd), buffer_(link::kMaxPacket) {
  int type = 0;
  socklen_t size = sizeof(type);
  if (getsockopt(fd_, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_SEQPACKET) {
    throw StartError(link::kExitUsage, "--link-fd " + std::to_string(fd) +
                                           ": no SOCK_SEQPACKET socket. The gateway gives this option" + hint);
  }
  fcntl(fd_, F_SETFD, FD_CLOEXEC);
}

LinkSocket::~LinkSocket() { close(fd_); }

LinkSocket::Packet LinkSocket::receive() {
  ssize_t size = 0;
  do {
    size = recv(fd_, buffer_.data(), buffer_.size(), MSG_DONTWAIT | MSG_TRUNC);
  } while (size < 0 && errno == EINTR);
  if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return {};
  if (size <= 0) return {Received::closed};
  const auto length = static_cast<std::size_t>(size);
  if (length > buffer_.size()) return {Received::garbage, {}, "a packet of " + std::to_string(length) + " bytes"};
  return {Received::packet, Bytes(buffer_).first(length)};
}

bool LinkSocket::send(std::vector<Byte> packet) {
  if (waiting_.size() >= kMaxPacketsWaiting) return false;
  waiting_.push_back(std::move(packet));
  flush();
  return true;
}

bool LinkSocket::flush() {
  while (!gone_ && !waiting_.empty()) {
    const std::vector<Byte>& packet = waiting_.front();
    if (::send(fd_, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) {
      waiting_.pop_front();
    } else if (errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS) {
      break;
    } else if (errno != EINTR) {
      gone_ = true;
    }
  }
  return !gone_;
}

}  // namespace axisgate::program
