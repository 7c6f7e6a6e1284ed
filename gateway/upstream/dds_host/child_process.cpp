#include "gateway/upstream/dds_host/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <spawn.h>
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

#include "gateway/upstream/dds_host/restart_plan.hpp"

namespace axisgate::dds {
namespace {

// <sys/pidfd.h> of glibc 2.36 cannot be linked from C++.
int open_pidfd(pid_t pid) { return static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)); }
void send_signal(int pidfd, int signal) { ::syscall(SYS_pidfd_send_signal, pidfd, signal, nullptr, 0); }

/// posix_spawn's two objects, with all that the program must not inherit from us.
class SpawnSettings {
 public:
  explicit SpawnSettings(int link) {
    posix_spawn_file_actions_init(&files_);
    posix_spawn_file_actions_adddup2(&files_, link, kLinkDescriptor);
    posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&files_, kLinkDescriptor + 1);
    posix_spawnattr_init(&attributes_);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
    sigset_t ignored_by_us;
    sigemptyset(&ignored_by_us);
    sigaddset(&ignored_by_us, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes_, &ignored_by_us);
    // A group of its own: Ctrl-C goes to the gateway, which ends it. And no real-time priority of a service's.
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setschedpolicy(&attributes_, SCHED_OTHER);
    const sched_param usual{};
    posix_spawnattr_setschedparam(&attributes_, &usual);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP |
                                               POSIX_SPAWN_SETSCHEDULER);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  /// errno's words for a failure; 0: started.
  int spawn(pid_t& pid, const std::string& program, const std::vector<std::string>& arguments) {
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (auto& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    return posix_spawn(&pid, program.c_str(), &files_, &attributes_, argv.data(), environ);
  }

 private:
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

void lower_priority(pid_t pid) {
  const auto who = static_cast<id_t>(pid);
  // A refusal changes nothing but who gets the processor first.
  static_cast<void>(setpriority(PRIO_PROCESS, who, getpriority(PRIO_PROCESS, 0) + kNicer));
}

ProcessEnd not_started(int error) { return {ProcessEnd::How::not_started, error}; }

ProcessEnd end_of(const siginfo_t& info) {
  return {info.si_code == CLD_EXITED ? ProcessEnd::How::exited : ProcessEnd::How::killed, info.si_status};
}

}  // namespace

std::variant<std::unique_ptr<ChildProcess>, ProcessEnd> ChildProcess::start(
    boost::asio::io_context& context, const std::string& program, const std::vector<std::string>& arguments,
    std::function<void(const ProcessEnd&)> on_end) {
  std::array<int, 2> ends{};
  // Ours never blocks by the flag of each call; the program's is as it expects a descriptor to be.
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return not_started(errno);
  pid_t pid = 0;
  int error = SpawnSettings(ends[1]).spawn(pid, program, arguments);
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    return not_started(error);
  }
  lower_priority(pid);
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

}  // namespace axisgate::dds
