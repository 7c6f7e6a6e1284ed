// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/control_socket.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace axisgate::simulated {

ControlSocket::ControlSocket(const std::string& path, Control& control) : path_(path), control_(control) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) {
    throw std::runtime_error("control socket '" + path + "': the path is too long, at most " +
                             std::to_string(sizeof(address.sun_path) - 1) + " characters");
  }
  std::copy(path.begin(), path.end(), address.sun_path);
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0) {
    if (!S_ISSOCK(there.st_mode)) {
      throw std::runtime_error("control socket '" + path +
                               "': something else is there, remove it or choose another path");
    }
    ::unlink(path.c_str());  // left by an earlier run
  }
  listener_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (listener_.get() < 0 ||
      ::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener_.get(), 8) != 0) {
    throw std::runtime_error("control socket '" + path + "' (does its folder exist?): " + std::strerror(errno));
  }
}

ControlSocket::~ControlSocket() { ::unlink(path_.c_str()); }

void ControlSocket::add_to(std::vector<pollfd>& watched) const {
  watched.push_back({listener_.get(), POLLIN, 0});
  for (const auto& [number, client] : clients_) watched.push_back({number, POLLIN, 0});
}

void ControlSocket::serve(const std::vector<pollfd>& watched) {
  for (const pollfd& ready : watched) {
    if (ready.revents == 0) continue;
    if (ready.fd == listener_.get()) {
      accept_one();
    } else if (const auto client = clients_.find(ready.fd); client != clients_.end() && !talk(client->second)) {
      clients_.erase(client);
    }
  }
}

void ControlSocket::accept_one() {
  Descriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (socket.get() < 0 || clients_.size() >= client_limit) return;
  const int number = socket.get();
  clients_[number].socket = std::move(socket);
}

bool ControlSocket::talk(Client& client) {
  std::array<char, 1024> buffer{};
  const ssize_t got = ::recv(client.socket.get(), buffer.data(), buffer.size(), 0);
  if (got < 0) return errno == EAGAIN || errno == EINTR;
  if (got == 0) return false;
  client.pending.append(buffer.data(), static_cast<std::size_t>(got));
  for (std::size_t end = 0; (end = client.pending.find('\n')) != std::string::npos;) {
    const std::string reply = control_.answer(std::string_view(client.pending).substr(0, end)) + '\n';
    client.pending.erase(0, end + 1);
    // A client that does not read its answers is closed rather than waited for.
    if (::send(client.socket.get(), reply.data(), reply.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(reply.size())) {
      return false;
    }
  }
  return client.pending.size() <= line_limit;
}

}  // namespace axisgate::simulated
