// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/stderr_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace axisgate::process {
namespace {

/// A pipe whose reader hangs, a terminal held with Ctrl-S: writing would wait, and the motors with it.
bool takes_a_line() {
  pollfd out{STDERR_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & POLLOUT) != 0;
}

/// systemd says which of our descriptors the journal reads, by device and inode (systemd.exec(5), JOURNAL_STREAM); what
/// a shell has redirected since is another.
bool is_journal() {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat own {};
  return stream != nullptr && ::fstat(STDERR_FILENO, &own) == 0 &&
         fmt::format("{}:{}", own.st_dev, own.st_ino) == stream;
}

/// For the journal, which has a time of its own, with the priority that sd-daemon(3) reads; else with the time of day.
std::string head_of(LogLevel level, bool journal) {
  if (journal) {
    constexpr std::array<int, 4> kPriorities{3, 4, 6, 7};
    return fmt::format("<{}>", kPriorities.at(static_cast<std::size_t>(level)));
  }
  const auto now = std::chrono::system_clock::now();
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03} ", fmt::localtime(std::chrono::system_clock::to_time_t(now)), ms);
}

}  // namespace

Log stderr_log(LogLevel most_detailed) {
  return Log(
      [lost = std::uint64_t{0}, journal = is_journal()](LogLevel level, std::string_view source,
                                                        std::string_view message) mutable {
        if (!takes_a_line()) {
          ++lost;
          return;
        }
        const std::string head = head_of(level, journal);
        const std::string before =
            lost == 0 ? std::string()
                      : fmt::format("{}({} lines lost here: nobody took them)\n", journal ? head : std::string(), lost);
        const std::string line = before + fmt::format("{}{} {}: {}\n", head, text(level), source, message);
        // One call, so that lines of two processes on one terminal do not mix.
        // A full disk takes none of it, and says so only now.
        lost = std::fwrite(line.data(), 1, line.size(), stderr) == line.size() ? 0 : lost + 1;
      },
      most_detailed);
}

}  // namespace axisgate::process
