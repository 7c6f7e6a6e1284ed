// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/stderr_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "gateway/process/journal.hpp"

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
  if (journal) return fmt::format("<{}>", priority_of(level));
  const auto now = std::chrono::system_clock::now();
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03} ", fmt::localtime(std::chrono::system_clock::to_time_t(now)), ms);
}

/// One call, so that lines of two processes on one terminal do not mix. A full disk takes none of it, and says so only
/// now.
bool stderr_takes(const std::string& lines) {
  return takes_a_line() && std::fwrite(lines.data(), 1, lines.size(), stderr) == lines.size();
}

}  // namespace

Log stderr_log(LogLevel most_detailed, const std::string& journal_socket) {
  // Shared by the copies of the log.
  const auto journal = is_journal() ? std::make_shared<Journal>(journal_socket) : nullptr;
  return Log(
      [lost = std::uint64_t{0}, journal](LogLevel level, const LogSource& source, std::string_view message) mutable {
        const std::string before = lost == 0 ? "" : fmt::format("({} lines lost here: nobody took them)\n", lost);
        const std::string line = fmt::format("{} {}: {}", text(level), source.words, message);
        bool taken = journal != nullptr && journal->takes(journal_entry(level, source, before + line));
        if (!taken) {
          const std::string head = head_of(level, journal != nullptr);
          const std::string first = lost == 0 || journal == nullptr ? before : head + before;
          taken = stderr_takes(first + head + line + "\n");
        }
        lost = taken ? 0 : lost + 1;
      },
      most_detailed);
}

}  // namespace axisgate::process
