// SPDX-License-Identifier: Apache-2.0
#include "tests/web_process/web.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <ctime>
#include <fstream>
#include <stdexcept>

#include "gateway/image/axis_image.hpp"
#include "tests/places.hpp"

namespace axisgate::web::test {
namespace {

const std::string kProgram = axisgate::test::build_path("bin/axisgate-web");
constexpr int kItsLink = 3;

pid_t start(const std::string& settings, int link) {
  const std::string settings_argument = "--settings=" + settings;
  const pid_t pid = fork();
  if (pid != 0) return pid;
  dup2(link, kItsLink);
  execl(kProgram.c_str(), kProgram.c_str(), "serve", "--link-fd=3", settings_argument.c_str(), nullptr);
  _exit(127);
}

}  // namespace

SteadyNs now() {
  timespec at{};
  clock_gettime(CLOCK_MONOTONIC, &at);
  return SteadyNs{at.tv_sec} * kSecond + at.tv_nsec;
}

Web::Web(const std::string& settings, const std::string& listen) {
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) throw std::runtime_error("no socket pair");
  pid_ = start(fmt::format(R"({{"listen": ["{}"]{}{}}})", listen, settings.empty() ? "" : ", ", settings), ends[1]);
  close(ends[1]);
  link_ = ends[0];
  wait_ready();
}

Web::~Web() {
  if (pid_ > 0) kill(pid_, SIGKILL);
  close_link();
  if (pid_ > 0) waitpid(pid_, nullptr, 0);
}

void Web::wait_ready() {
  while (port_ == 0) {
    const std::optional<Record> record = receive();
    if (!record) throw std::runtime_error("axisgate-web has ended instead of being ready");
    if (const auto* ready = std::get_if<ReadyRecord>(&*record)) confined_ = ready->confined;
    const auto* line = std::get_if<LogRecord>(&*record);
    if (line == nullptr || !line->text.starts_with("the page is at http://127.0.0.1:")) continue;
    port_ = static_cast<std::uint16_t>(std::stoi(line->text.substr(line->text.rfind(':') + 1)));
  }
}

std::optional<Record> Web::receive() {
  pollfd readable{link_, POLLIN, 0};
  if (poll(&readable, 1, static_cast<int>(std::chrono::milliseconds(kPatience).count())) != 1)
    throw std::runtime_error("axisgate-web says nothing");
  std::vector<Byte> packet(kMaxPacket);
  const ssize_t size = recv(link_, packet.data(), packet.size(), 0);
  if (size <= 0) return std::nullopt;
  const Decoded decoded = decode(Bytes(packet).first(static_cast<std::size_t>(size)));
  if (decoded.error != link::DecodeError::none) throw std::runtime_error("no record");
  return decoded.record;
}

std::optional<LogRecord> Web::next_line() {
  for (;;) {
    const std::optional<Record> record = receive();
    if (!record) return std::nullopt;
    if (const auto* line = std::get_if<LogRecord>(&*record)) return *line;
  }
}

void Web::send_bytes(const std::vector<Byte>& packet) {
  if (send(link_, packet.data(), packet.size(), MSG_NOSIGNAL) < 0) throw std::runtime_error("axisgate-web is gone");
}

void Web::tell(const Record& record) { send_bytes(encode(record)); }

void Web::tell_of_the_gateway(std::uint16_t axes) {
  tell(HelloRecord{"plant", "0.3.0", 42, now(), axes, 1, false, false});
  BusInfoRecord bus;
  bus.name = "serial";
  tell(bus);
  for (std::uint16_t number = 1; number <= axes; ++number) {
    AxisInfoRecord axis;
    axis.axis = number;
    axis.name = "hoist";
    tell(axis);
  }
}

void Web::tell_position(double turns) {
  AxisSample sample;
  sample.axis = 1;
  sample.link_state = static_cast<std::uint8_t>(LinkState::online);
  sample.supported = sample.valid = bit(Quantity::position_actual);
  sample.lease_ms = sample.result_age_ms = UINT32_MAX;
  constexpr double kUnits = 10000;
  sample.values = {
      {static_cast<std::uint8_t>(Quantity::position_actual), static_cast<std::int32_t>(turns * kUnits), 0}};
  SamplesRecord record;
  record.at = now();
  record.axes = {sample};
  tell(record);
}

void Web::close_link() {
  if (link_ >= 0) close(std::exchange(link_, -1));
}

int Web::exit_code() {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::string Web::status(const std::string& name) const {
  std::ifstream in("/proc/" + std::to_string(pid_) + "/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(name + ":")) return line.substr(line.find_first_not_of(" \t", name.size() + 1));
  return "";
}

}  // namespace axisgate::web::test
