// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/host/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <optional>
#include <utility>

#include "gateway/upstream/host/restart_plan.hpp"

namespace axisgate::host {
namespace {

// <sys/pidfd.h> of glibc 2.36 cannot be linked from C++.
int open_pidfd(pid_t pid) { return static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)); }
void send_signal(int pidfd, int signal) { ::syscall(SYS_pidfd_send_signal, pidfd, signal, nullptr, 0); }

/// What a shell's exit code is where a program cannot be executed.
constexpr int kCannotExecute = 127;

/// In the new process, before it is the program: async-signal-safe calls alone, since threads of ours may have held any
/// lock when it was made.
[[noreturn]] void become(const char* program, char* const* argv, int nicer, int link) {
  // A group of its own: Ctrl-C goes to the gateway, which ends it.
  ::setpgid(0, 0);
  // No real-time priority of a service's; and below the gateway. A refusal changes nothing but who is served first.
  const sched_param usual{};
  ::sched_setscheduler(0, SCHED_OTHER, &usual);
  ::setpriority(PRIO_PROCESS, 0, ::getpriority(PRIO_PROCESS, 0) + nicer);
  ::signal(SIGPIPE, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  // Where it is that number already, dup2() would leave it to be closed by exec.
  if (link == kLinkDescriptor)
    ::fcntl(link, F_SETFD, 0);
  else
    ::dup2(link, kLinkDescriptor);
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::close_range(kLinkDescriptor + 1, ~0U, 0);
  ::execve(program, argv, environ);
  ::_exit(kCannotExecute);
}

/// Not posix_spawn(): that waits until the program runs, tens of milliseconds on a busy machine. -1: errno.
pid_t begin_process(const std::string& program, const std::vector<std::string>& arguments, int nicer, int link) {
  if (::access(program.c_str(), X_OK) != 0) return -1;
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t pid = ::_Fork();
  if (pid == 0) become(program.c_str(), argv.data(), nicer, link);
  return pid;
}

ProcessEnd not_started(int error) { return {ProcessEnd::How::not_started, error}; }

ProcessEnd end_of(const siginfo_t& info) {
  return {info.si_code == CLD_EXITED ? ProcessEnd::How::exited : ProcessEnd::How::killed, info.si_status};
}

}  // namespace

std::variant<std::unique_ptr<ChildProcess>, ProcessEnd> ChildProcess::start(
    boost::asio::io_context& context, const std::string& program, const std::vector<std::string>& arguments, int nicer,
    std::function<void(const ProcessEnd&)> on_end) {
  std::array<int, 2> ends{};
  // Ours never blocks by the flag of each call; the program's is as it expects a descriptor to be.
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return not_started(errno);
  const pid_t pid = begin_process(program, arguments, nicer, ends[1]);
  int error = errno;
  ::close(ends[1]);
  if (pid < 0) {
    ::close(ends[0]);
    return not_started(error);
  }
  // It is not waited for yet, so its number cannot be another's.
  const int pidfd = open_pidfd(pid);
  if (pidfd < 0) {
    error = errno;
    ::close(ends[0]);
    ::kill(pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    return not_started(error);
  }
  return std::unique_ptr<ChildProcess>(new ChildProcess(context, pid, pidfd, ends[0], std::move(on_end)));
}

ChildProcess::ChildProcess(boost::asio::io_context& context, pid_t pid, int pidfd, int socket,
                           std::function<void(const ProcessEnd&)> on_end)
    : pid_(pid),
      pidfd_(context, pidfd),
      socket_(std::make_unique<PacketSocket>(context, socket)),
      on_end_(std::move(on_end)) {
  wait();
}

ChildProcess::~ChildProcess() {
  socket_.reset();
  if (ended_) return;
  await_end();
  if (reap()) return;
  kill();
  await_end();
  static_cast<void>(reap());
}

void ChildProcess::await_end() {
  pollfd ended{pidfd_.native_handle(), POLLIN, 0};
  const auto patience = std::chrono::duration_cast<std::chrono::milliseconds>(kEndsWithin).count();
  // A signal cuts it short: who presses Ctrl-C twice is in a hurry.
  ::poll(&ended, 1, static_cast<int>(patience));
}

void ChildProcess::kill() { send_signal(pidfd_.native_handle(), SIGKILL); }

void ChildProcess::wait() {
  pidfd_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                    [this, alive = std::weak_ptr(alive_)](const boost::system::error_code& error) {
                      if (alive.expired() || error) return;
                      const auto end = reap();
                      if (!end) return wait();
                      // Its owner may destroy us in it.
                      std::exchange(on_end_, {})(*end);
                    });
}

std::optional<ProcessEnd> ChildProcess::reap() {
  siginfo_t info{};
  const int reaped = waitid(P_PIDFD, static_cast<id_t>(pidfd_.native_handle()), &info, WEXITED | WNOHANG);
  if (reaped == 0 && info.si_pid == 0) return std::nullopt;
  ended_ = true;
  return reaped == 0 ? end_of(info) : ProcessEnd{};
}

}  // namespace axisgate::host
