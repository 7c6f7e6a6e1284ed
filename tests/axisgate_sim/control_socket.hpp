// SPDX-License-Identifier: Apache-2.0
// The control socket: a Unix stream socket that takes text lines and answers each with one.
// Promises at most `client_limit` clients and `line_limit` bytes per line; what exceeds them is closed.
// Never understands a line: Control does.
#pragma once

#include <poll.h>

#include <map>
#include <string>
#include <vector>

#include "tests/axisgate_sim/control.hpp"
#include "tests/axisgate_sim/descriptor.hpp"

namespace axisgate::simulated {

class ControlSocket {
 public:
  static constexpr std::size_t client_limit = 16;
  static constexpr std::size_t line_limit = 4096;

  // Throws std::runtime_error that names the path and what to change.
  ControlSocket(const std::string& path, Control& control);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  void add_to(std::vector<pollfd>& watched) const;
  void serve(const std::vector<pollfd>& watched);

 private:
  struct Client {
    Descriptor socket;
    std::string pending;
  };
  void accept_one();
  bool talk(Client& client);

  std::string path_;
  Control& control_;
  Descriptor listener_;
  std::map<int, Client> clients_;
};

}  // namespace axisgate::simulated
