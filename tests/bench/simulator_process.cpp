// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/simulator_process.hpp"

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <thread>
#include <utility>

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
    : control_(std::move(control)),
      process_(
          1,
          [&] {
            std::vector<std::string> words;
            for (const std::string& line : lines) words.insert(words.end(), {"--line", line});
            if (!control_.empty()) words.insert(words.end(), {"--control", control_});
            go_before_others();
            become(AXISGATE_SIM, words, "/dev/null");
          },
          SIGTERM) {
  for (const std::string& line : lines) await(line.substr(0, line.find(':')));
  if (!control_.empty()) await(control_);
}

void SimulatorProcess::await(const std::string& path) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!std::filesystem::exists(path)) {
    if (std::chrono::steady_clock::now() > end || process_.ended())
      throw std::runtime_error("the simulator made no " + path);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

std::string SimulatorProcess::ask(std::string_view line) const {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const std::string answer = answer_to(socket, control_, std::string(line) + '\n');
  ::close(socket);
  if (!answer.starts_with("ok")) throw std::runtime_error("the simulator answered '" + answer + "'");
  return answer.substr(std::min<std::size_t>(3, answer.size()));
}

}  // namespace axisgate::bench
