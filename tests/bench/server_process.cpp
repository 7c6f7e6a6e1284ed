#include "tests/bench/server_process.hpp"

#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>

namespace axisgate::bench {

void stay_on_processor(unsigned number) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(number, &set);
  static_cast<void>(::sched_setaffinity(0, sizeof set, &set));
}

void go_before_others() {
  sched_param lowest{};
  lowest.sched_priority = ::sched_get_priority_min(SCHED_FIFO);
  static_cast<void>(::sched_setscheduler(0, SCHED_FIFO, &lowest));
}

ServerProcess::ServerProcess(const std::function<void(const std::function<void(std::uint16_t)>&)>& serve) {
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) throw std::runtime_error("no pipe");
  std::fflush(nullptr);
  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("no process");
  if (process_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::close(pipe[0]);
    stay_on_processor(0);
    try {
      serve([&](std::uint16_t port) { static_cast<void>(!::write(pipe[1], &port, sizeof port)); });
    } catch (const std::exception& error) {
      std::fprintf(stderr, "server: %s\n", error.what());
    }
    ::_exit(1);
  }
  ::close(pipe[1]);
  const bool listening = ::read(pipe[0], &port_, sizeof port_) == sizeof port_;
  ::close(pipe[0]);
  if (!listening) throw std::runtime_error("a server did not start");
}

ServerProcess::~ServerProcess() {
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

}  // namespace axisgate::bench
