// SPDX-License-Identifier: Apache-2.0
#include "tests/dds_process/child.hpp"
#include "tests/places.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <stdexcept>

namespace axisgate::dds::test {
namespace {

const std::string kProgram = axisgate::test::build_path("bin/axisgate-dds");
constexpr int kChildLink = 3;

pid_t start(const std::vector<std::string>& arguments, int link, int errors) {
  std::vector<char*> argv{const_cast<char*>(kProgram.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t pid = fork();
  if (pid != 0) return pid;
  dup2(errors, STDERR_FILENO);
  dup2(errors, STDOUT_FILENO);
  if (link >= 0) dup2(link, kChildLink);
  execv(kProgram.c_str(), argv.data());
  _exit(127);
}

int wait_for(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::string all_of(int file) {
  std::string text;
  std::array<char, 4096> part{};
  lseek(file, 0, SEEK_SET);
  for (ssize_t size = 0; (size = read(file, part.data(), part.size())) > 0;) {
    text.append(part.data(), static_cast<std::size_t>(size));
  }
  return text;
}

/// Claimed by a name in the kernel, as the stories do, for as long as this program runs.
std::uint32_t reserve_domain() {
  constexpr std::uint32_t kDomains = 100;
  const int claim = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  for (std::uint32_t i = 0; i < kDomains; ++i) {
    const std::uint32_t domain = 1 + (static_cast<std::uint32_t>(getpid()) + i) % kDomains;
    const std::string name = "axisgate-dds-domain-" + std::to_string(domain);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path + 1, sizeof address.sun_path - 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    if (bind(claim, reinterpret_cast<const sockaddr*>(&address), size) == 0) return domain;
  }
  throw std::runtime_error("all DDS domains of the tests are taken");
}

}  // namespace

std::uint32_t test_domain() {
  static const std::uint32_t domain = reserve_domain();
  return domain;
}

Child::Child(const std::vector<std::string>& more, bool ready) {
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) throw std::runtime_error("no socket pair");
  errors_ = memfd_create("axisgate-dds stderr", MFD_CLOEXEC);
  std::vector<std::string> arguments{"serve", "--link-fd", std::to_string(kChildLink), "--domain",
                                     std::to_string(test_domain())};
  arguments.insert(arguments.end(), more.begin(), more.end());
  link_ = ends[0];
  pid_ = start(arguments, ends[1], errors_);
  close(ends[1]);
  if (ready) wait_ready();
}

void Child::wait_ready() {
  std::string lines;
  while (const std::optional<Record> record = receive()) {
    if (std::holds_alternative<ReadyRecord>(*record)) return;
    if (const auto* line = std::get_if<LogRecord>(&*record)) lines += line->text + "\n";
  }
  throw std::runtime_error("axisgate-dds did not get ready: " + lines + all_of(errors_));
}

std::pair<int, std::string> Child::run(const std::vector<std::string>& arguments) {
  const int errors = memfd_create("axisgate-dds stderr", MFD_CLOEXEC);
  const int code = wait_for(start(arguments, -1, errors));
  std::pair<int, std::string> result{code, all_of(errors)};
  close(errors);
  return result;
}

Child::~Child() {
  close_link();
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    wait_for(pid_);
  }
  close(errors_);
}

void Child::send(const Record& record) { send_bytes(encode(record)); }

void Child::send_bytes(const std::vector<Byte>& packet) {
  if (::send(link_, packet.data(), packet.size(), MSG_NOSIGNAL) < 0) throw std::runtime_error("axisgate-dds is gone");
}

std::optional<Record> Child::receive(std::chrono::milliseconds within) {
  pollfd readable{link_, POLLIN, 0};
  if (poll(&readable, 1, static_cast<int>(within.count())) <= 0) return std::nullopt;
  std::vector<Byte> packet(kMaxPacket);
  const ssize_t size = recv(link_, packet.data(), packet.size(), 0);
  if (size <= 0) return std::nullopt;
  packet.resize(static_cast<std::size_t>(size));
  Decoded decoded = decode(packet);
  if (decoded.error != DecodeError::none) throw std::runtime_error("axisgate-dds sent no record");
  return decoded.record;
}

void Child::close_link() {
  if (link_ >= 0) close(link_);
  link_ = -1;
}

bool Child::hung_up() const {
  pollfd end{link_, 0, 0};
  return poll(&end, 1, 0) > 0 && (end.revents & POLLHUP) != 0;
}

int Child::exit_code() {
  const int code = wait_for(pid_);
  pid_ = -1;
  return code;
}

std::string Child::error_output() { return all_of(errors_); }

}  // namespace axisgate::dds::test
