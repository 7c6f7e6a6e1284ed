// SPDX-License-Identifier: Apache-2.0
// What a DDS server of the gateway may meet instead of axisgate-dds. FAKE_DDS names how this one behaves.
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "gateway/upstream/dds_link/records.hpp"
#include "gateway/upstream/link/exit_codes.hpp"

namespace {

using namespace axisgate::dds;
using axisgate::Byte;

constexpr int kLink = 3;
constexpr std::uint64_t kRequests = 1000;

void send_packet(const std::vector<Byte>& packet) { send(kLink, packet.data(), packet.size(), MSG_NOSIGNAL); }
void send_record(const Record& record) { send_packet(encode(record)); }
void say(const std::string& text) { send_record(LogRecord{2, text}); }
void ready() { send_record(ReadyRecord{"9.9"}); }

[[noreturn]] void sleep_for_ever() {
  for (;;) pause();
}

/// No value: the gateway is gone.
std::optional<Record> receive() {
  static std::array<Byte, kMaxPacket> buffer;
  const ssize_t got = recv(kLink, buffer.data(), buffer.size(), 0);
  if (got <= 0) return std::nullopt;
  return decode(axisgate::Bytes(buffer).first(static_cast<std::size_t>(got))).record;
}

int read_on() {
  while (receive()) {
  }
  return axisgate::link::kExitGatewayGone;
}

/// As a crash is without a sanitizer that has its own words for it.
[[noreturn]] void die_of(int signal) {
  std::signal(signal, SIG_DFL);
  raise(signal);
  sleep_for_ever();
}

int tell_what_was_inherited() {
  ready();
  receive();  // whoever started us has done all that belongs to that by now
  std::string open;
  for (int descriptor = 0; descriptor < 1024; ++descriptor)
    if (fcntl(descriptor, F_GETFD) >= 0) open += " " + std::to_string(descriptor);
  sigset_t blocked;
  sigprocmask(SIG_SETMASK, nullptr, &blocked);
  say("open:" + open);
  say("input: " + std::filesystem::read_symlink("/proc/self/fd/0").string());
  say("blocked: " + std::to_string(sigismember(&blocked, SIGTERM)));
  struct sigaction action {};
  sigaction(SIGPIPE, nullptr, &action);
  say(std::string("SIGPIPE: ") + (action.sa_handler == SIG_DFL ? "default" : "ignored"));
  say("nice: " + std::to_string(getpriority(PRIO_PROCESS, 0)));
  say("group of its own: " + std::to_string(getpgrp() == getpid()));
  say("last");
  return read_on();
}

/// Reads nothing before SIGUSR1, then tells each state of axis 499 that it gets.
int read_late() {
  sigset_t usr1;
  sigemptyset(&usr1);
  sigaddset(&usr1, SIGUSR1);
  sigprocmask(SIG_BLOCK, &usr1, nullptr);
  ready();
  int signal = 0;
  sigwait(&usr1, &signal);
  while (const auto record = receive()) {
    const auto* state = std::get_if<StateRecord>(&*record);
    if (state != nullptr && state->axis == 499) say("499 is at " + std::to_string(state->sequence));
  }
  return 0;
}

/// Requests as fast as they are taken, replies as they come; then how many of each there were.
int ask_much() {
  ready();
  std::map<std::uint64_t, int> replies;
  std::uint64_t asked = 0;
  while (replies.size() < kRequests) {
    pollfd link{kLink, static_cast<short>(POLLIN | (asked < kRequests ? POLLOUT : 0)), 0};
    poll(&link, 1, -1);
    if ((link.revents & POLLIN) != 0) {
      const auto record = receive();
      if (!record) return 0;
      if (const auto* reply = std::get_if<ReplyRecord>(&*record)) ++replies[reply->request_id];
    }
    if ((link.revents & POLLOUT) != 0) {
      CommandRecord command;
      command.axis = 1;
      command.request_id = asked + 1;
      command.command = 4;  // halt
      const auto packet = encode(command);
      if (send(kLink, packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT) >= 0) ++asked;
    }
  }
  bool once_each = true;
  for (const auto& [id, count] : replies) once_each = once_each && count == 1;
  say(std::to_string(replies.size()) + " replies, " + (once_each ? "one each" : "NOT one each"));
  return read_on();
}

int chatter() {
  ready();
  for (int i = 0; i < 500; ++i) say("line " + std::to_string(i) + "\nwith another line");
  usleep(2'000'000);  // until a line is free again, also for a gateway that stood still meanwhile
  say("last");
  return read_on();
}

void send_garbage() {
  ready();
  send_packet({99, 99, 99});
  read_on();
}

const std::map<std::string, std::function<int()>> kBehaviours{
    {"normal", [] { return ready(), read_on(); }},
    {"says why and ends", [] { return say("no interface eth7"), axisgate::link::kExitCannotServe; }},
    {"crashes at once", [] { return die_of(SIGSEGV), 0; }},
    {"crashes when ready", [] { return ready(), die_of(SIGSEGV), 0; }},
    {"is never ready", [] { return read_on(); }},
    {"reads nothing", [] { return ready(), sleep_for_ever(), 0; }},
    {"reads late", read_late},
    {"sends garbage", [] { return send_garbage(), 0; }},
    {"sends a longer packet than there is",
     [] { return ready(), send_packet(std::vector<Byte>(kMaxPacket + 1)), read_on(); }},
    {"sends what only the gateway sends", [] { return ready(), send_record(StateRecord{}), read_on(); }},
    {"asks before it is ready", [] { return send_record(CommandRecord{}), read_on(); }},
    {"closes and goes on", [] { return ready(), close(kLink), sleep_for_ever(), 0; }},
    {"does not end", [] { return ready(), read_on(), sleep_for_ever(), 0; }},
    {"asks much", ask_much},
    {"chatters", chatter},
    {"tells what it inherited", tell_what_was_inherited},
};

}  // namespace

int main() {
  const char* const how = std::getenv("FAKE_DDS");
  const std::string name = how == nullptr ? "normal" : how;
  if (name.starts_with("ends with ")) return std::atoi(name.c_str() + 10);
  if (name.starts_with("dies of ")) die_of(std::atoi(name.c_str() + 8));
  return kBehaviours.at(name)();
}
