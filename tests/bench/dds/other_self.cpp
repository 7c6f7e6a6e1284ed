// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/dds/other_self.hpp"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

extern char** environ;

namespace axisgate::bench {

OtherSelf::OtherSelf(std::string mode, std::uint32_t domain, int type) {
  int pair[2];
  if (::socketpair(AF_UNIX, type | SOCK_CLOEXEC, 0, pair) != 0) throw std::runtime_error(std::strerror(errno));
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, pair[1], kSocket);
  std::string name = "axisgate-dds-bench", number = std::to_string(domain);
  char* arguments[] = {name.data(), mode.data(), number.data(), nullptr};
  const int failed = ::posix_spawn(&pid_, "/proc/self/exe", &actions, nullptr, arguments, environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(pair[1]);
  socket_ = pair[0];
  if (failed != 0) throw std::runtime_error("cannot start \"" + mode + "\": " + std::strerror(failed));
}

OtherSelf::~OtherSelf() {
  ::close(socket_);
  ::waitpid(pid_, nullptr, 0);
}

}  // namespace axisgate::bench
