#include "tests/bench/simulator_process.hpp"

#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/bench/server_process.hpp"

namespace axisgate::bench {
namespace {

constexpr std::chrono::seconds kPatience{10};
constexpr std::size_t kLongestAnswer = 4096;

std::string answer_to(int socket, const std::string& path, const std::string& line) {
  const timeval patience{5, 0};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  path.copy(to.sun_path, sizeof to.sun_path - 1);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) return "nobody listens";
  if (::send(socket, line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size())) return "not sent";
  std::string answer;
  while (answer.size() < kLongestAnswer) {
    char byte = 0;
    if (::recv(socket, &byte, 1, 0) != 1 || byte == '\n') break;
    answer += byte;
  }
  return answer;
}

}  // namespace

SimulatorProcess::SimulatorProcess(const std::vector<std::string>& lines, std::string control)
    : control_(std::move(control)) {
  begin(lines);
  std::vector<std::string> paths;
  for (const std::string& line : lines) paths.push_back(line.substr(0, line.find(':')));
  if (!control_.empty()) paths.push_back(control_);
  try {
    await(paths);
  } catch (...) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    throw;
  }
}

void SimulatorProcess::begin(const std::vector<std::string>& lines) {
  std::vector<const char*> words{"axisgate-sim"};
  for (const std::string& line : lines) words.insert(words.end(), {"--line", line.c_str()});
  if (!control_.empty()) words.insert(words.end(), {"--control", control_.c_str()});
  words.push_back(nullptr);
  std::fflush(nullptr);
  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("no process");
  if (process_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  stay_on_processor(1);
  go_before_others();
  static_cast<void>(!::freopen("/dev/null", "w", stdout));
  ::execv(AXISGATE_SIM, const_cast<char* const*>(words.data()));
  std::perror(AXISGATE_SIM);
  ::_exit(127);
}

void SimulatorProcess::await(const std::vector<std::string>& paths) const {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (const std::string& path : paths) {
    while (!std::filesystem::exists(path)) {
      if (std::chrono::steady_clock::now() > end || ::waitpid(process_, nullptr, WNOHANG) == process_)
        throw std::runtime_error("the simulator made no " + path);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
}

SimulatorProcess::~SimulatorProcess() {
  ::kill(process_, SIGTERM);
  ::waitpid(process_, nullptr, 0);
}

std::string SimulatorProcess::ask(std::string_view line) const {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const std::string answer = answer_to(socket, control_, std::string(line) + '\n');
  ::close(socket);
  if (!answer.starts_with("ok")) throw std::runtime_error("the simulator answered '" + answer + "'");
  return answer.substr(std::min<std::size_t>(3, answer.size()));
}

}  // namespace axisgate::bench
