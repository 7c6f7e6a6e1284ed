// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/stderr_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>

namespace axisgate::app {
namespace {

/// A pipe whose reader hangs, a terminal held with Ctrl-S: writing would wait, and the motors with it.
bool takes_a_line() {
  pollfd out{STDERR_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & POLLOUT) != 0;
}

}  // namespace

Log stderr_log(LogLevel most_detailed) {
  return Log(
      [lost = std::uint64_t{0}](LogLevel level, std::string_view source, std::string_view message) mutable {
        if (!takes_a_line()) {
          ++lost;
          return;
        }
        const std::string before =
            lost == 0 ? std::string() : fmt::format("({} lines lost here: nobody took them)\n", lost);
        const auto now = std::chrono::system_clock::now();
        const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
        const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
        const std::string line = before + fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03} {} {}: {}\n", fmt::localtime(seconds),
                                                      ms, text(level), source, message);
        // One call, so that lines of two processes on one terminal do not mix.
        // A full disk takes none of it, and says so only now.
        lost = std::fwrite(line.data(), 1, line.size(), stderr) == line.size() ? 0 : lost + 1;
      },
      most_detailed);
}

}  // namespace axisgate::app
