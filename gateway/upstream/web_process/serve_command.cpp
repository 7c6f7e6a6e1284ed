// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/serve_command.hpp"

#include <sys/resource.h>

#include <csignal>

#include "gateway/core/log.hpp"
#include "gateway/upstream/program/memory_limit.hpp"
#include "gateway/upstream/program/start_error.hpp"
#include "gateway/upstream/web_process/serve/server.hpp"

namespace axisgate::web {
namespace {

/// As many descriptors as max_connections takes, where the system lets us.
void raise_descriptors(std::size_t connections) {
  constexpr rlim_t kOthers = 64;
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= connections + kOthers) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, connections + kOthers);
  setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

int run(const ServeOptions& options) {
  // Ctrl-C on the terminal means the gateway, which ends us by closing the socket.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  program::limit_memory(options.settings.memory_limit_mb);
  raise_descriptors(options.settings.max_connections);
  Link link(options.link_fd, "axisgate-web");
  try {
    return serve(options.settings, options.captures, link);
  } catch (const program::StartError& error) {
    link.send(LogRecord{static_cast<std::uint8_t>(LogLevel::error), error.what()});
    return error.exit_code;
  }
}

}  // namespace axisgate::web
