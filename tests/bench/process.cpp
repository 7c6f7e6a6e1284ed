// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/process.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <utility>

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

Process::Process(unsigned processor, const std::function<void()>& body, int end_by) : end_by_(end_by) {
  std::fflush(nullptr);
  id_ = ::fork();
  if (id_ < 0) throw std::runtime_error("no process");
  if (id_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  stay_on_processor(processor);
  try {
    body();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "process of a bench: %s\n", error.what());
  }
  ::_exit(1);
}

Process::~Process() {
  if (ended_) return;
  ::kill(id_, end_by_);
  ::waitpid(id_, nullptr, 0);
}

bool Process::ended() {
  ended_ = ended_ || ::waitpid(id_, nullptr, WNOHANG) == id_;
  return ended_;
}

void become(const std::string& program, const std::vector<std::string>& arguments, const std::string& output) {
  const int out = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(out, STDERR_FILENO);
  std::vector<char*> words{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  ::execv(program.c_str(), words.data());
  std::perror(program.c_str());
  ::_exit(127);
}

ServerProcess::Pipe::Pipe() {
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
}

ServerProcess::Pipe::~Pipe() {
  for (const int end : ends)
    if (end >= 0) ::close(end);
}

ServerProcess::ServerProcess(const std::function<void(const Ready&)>& serve, unsigned processor)
    : process_(processor, [&] {
        serve([&](std::uint16_t port) { static_cast<void>(!::write(pipe_.ends[1], &port, sizeof port)); });
      }) {
  ::close(std::exchange(pipe_.ends[1], -1));
  if (::read(pipe_.ends[0], &port_, sizeof port_) != sizeof port_) throw std::runtime_error("a server did not start");
}

}  // namespace axisgate::bench
