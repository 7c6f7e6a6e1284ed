// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/support/bounded_run.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace axisgate::commands::support {
namespace {

using Clock = std::chrono::steady_clock;
/// Of one that was killed.
constexpr std::chrono::milliseconds kDies{1000};

/// Words of messages as they stand in manuals, and no colours.
std::vector<std::string> plain_environment() {
  std::vector<std::string> out{"LC_ALL=C.UTF-8", "NO_COLOR=1", "SYSTEMD_COLORS=0"};
  for (char** each = environ; *each != nullptr; ++each) {
    const std::string_view variable(*each);
    if (!variable.starts_with("LC_ALL=") && !variable.starts_with("NO_COLOR=") &&
        !variable.starts_with("SYSTEMD_COLORS="))
      out.emplace_back(variable);
  }
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

/// 0, or why not.
int start(const std::vector<std::string>& words, int output, pid_t& pid) {
  std::vector<std::string> arguments = words, environment = plain_environment();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
  const int error = ::posix_spawnp(&pid, words.front().c_str(), &actions, nullptr, pointers(arguments).data(),
                                   pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/// What it says until it closes its output, or until `end`. True: it has closed it.
bool read_until(int from, Clock::time_point end, const RunLimits& limits, RunEnd& run) {
  std::array<char, 16384> piece{};
  bool lost = false;
  bool closed = false;
  while (!closed) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd readable{from, POLLIN, 0};
    if (left <= 0 || (::poll(&readable, 1, static_cast<int>(left)) < 0 && errno != EINTR)) break;
    if (readable.revents == 0) continue;
    const ssize_t count = ::read(from, piece.data(), piece.size());
    closed = count == 0 || (count < 0 && errno != EINTR);
    if (count <= 0) continue;
    const auto came = static_cast<std::size_t>(count);
    if (limits.newest_is_last) {
      run.text.append(piece.data(), came);
      if (run.text.size() > 2 * limits.bytes) {
        run.text.erase(0, run.text.size() - limits.bytes);
        lost = true;
      }
    } else {
      const std::size_t room = limits.bytes - std::min(limits.bytes, run.text.size());
      run.text.append(piece.data(), std::min(room, came));
      lost = lost || room < came;
    }
  }
  if (lost) run.problem = fmt::format("it said more than the {} bytes that are kept", limits.bytes);
  return closed;
}

/// Of a process that is not waited for yet, so that its number is no other's.
bool ended(int pidfd, pid_t pid, Clock::time_point by, int& status) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(by - Clock::now()).count();
  pollfd end{pidfd, POLLIN, 0};
  if (pidfd >= 0) ::poll(&end, 1, static_cast<int>(std::max<std::int64_t>(left, 0)));
  return ::waitpid(pid, &status, WNOHANG) == pid;
}

}  // namespace

RunEnd run_program(const std::vector<std::string>& words, const RunLimits& limits) {
  RunEnd run;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    run.problem = std::strerror(errno);
    return run;
  }
  const auto end = Clock::now() + limits.patience;
  pid_t pid = 0;
  const int error = start(words, ends[1], pid);
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    run.problem = error == ENOENT ? "there is no " + words.front() + " here" : std::strerror(error);
    return run;
  }
  const int pidfd = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
  const bool closed = read_until(ends[0], end, limits, run);
  ::close(ends[0]);
  int status = 0;
  if (closed && ended(pidfd, pid, end, status)) {
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (WIFSIGNALED(status)) run.problem = fmt::format("it was killed by signal {}", WTERMSIG(status));
  } else {
    ::kill(pid, SIGKILL);
    // One that waits for a disk that is gone cannot even be killed.
    static_cast<void>(ended(pidfd, pid, Clock::now() + kDies, status));
    run.problem =
        fmt::format("no end within {:g} s: it was killed", static_cast<double>(limits.patience.count()) / 1e3);
  }
  if (pidfd >= 0) ::close(pidfd);
  return run;
}

}  // namespace axisgate::commands::support
