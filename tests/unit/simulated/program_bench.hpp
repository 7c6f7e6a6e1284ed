// axisgate-sim itself, started as a user would, in a folder of its own.
// Promises that no process and no file stays behind a test.
// Never checks anything by itself.
#pragma once

#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/axisgate_sim/descriptor.hpp"
#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {

namespace fs = std::filesystem;

class ProgramBench : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = fs::temp_directory_path() / "axisgate-sim-XXXXXX";
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder = pattern;
  }
  void TearDown() override {
    if (child > 0) end(SIGKILL);
    fs::remove_all(folder);
  }

  void start(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), AXISGATE_SIM_PROGRAM);
    child = ::fork();
    if (child == 0) {
      const int log = ::open((folder / "log").c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
      ::dup2(log, STDOUT_FILENO);
      ::dup2(log, STDERR_FILENO);
      std::vector<char*> words;
      for (std::string& word : arguments) words.push_back(word.data());
      words.push_back(nullptr);
      ::execv(words[0], words.data());
      ::_exit(127);
    }
  }
  int end(int signal) {
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    child = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  std::string log() const {
    std::ifstream file(folder / "log");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  bool wait_for_log(const std::string& text) const {
    for (int i = 0; i < 6000 && log().find(text) == std::string::npos; ++i) {
      std::this_thread::sleep_for(milliseconds(10));
    }
    return log().find(text) != std::string::npos;
  }

  std::string control(const std::string& line) const {
    Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = folder / "control";
    std::copy(path.begin(), path.end(), address.sun_path);
    if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return "no socket";
    const std::string text = line + "\n";
    (void)::send(socket.get(), text.data(), text.size(), MSG_NOSIGNAL);
    std::string reply(4096, '\0');
    const ssize_t got = ::recv(socket.get(), reply.data(), reply.size(), 0);
    reply.resize(got > 0 ? static_cast<std::size_t>(got) - 1 : 0);
    return reply;
  }

  Descriptor open_port(const char* name) const {
    return Descriptor(::open((folder / name).c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
  }
  static Bytes exchange(const Descriptor& port, const Bytes& request, std::size_t length, int timeout_ms = 60000) {
    (void)!::write(port.get(), request.data(), request.size());
    Bytes reply;
    while (reply.size() < length) {
      pollfd ready{port.get(), POLLIN, 0};
      if (::poll(&ready, 1, timeout_ms) <= 0) break;
      Bytes piece(256);
      const ssize_t got = ::read(port.get(), piece.data(), piece.size());
      if (got <= 0) break;
      reply.insert(reply.end(), piece.begin(), piece.begin() + got);
    }
    return reply;
  }

  fs::path folder;
  pid_t child = 0;
};

}  // namespace axisgate::simulated
