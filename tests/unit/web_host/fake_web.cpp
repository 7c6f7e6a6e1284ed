// SPDX-License-Identifier: Apache-2.0
// What a web server of the gateway may meet instead of axisgate-web. FAKE_WEB names how this one behaves.
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/web_link/records.hpp"

namespace {

using namespace axisgate::web;
using axisgate::Byte;

constexpr int kLink = 3;

void send_packet(const std::vector<Byte>& packet) { send(kLink, packet.data(), packet.size(), MSG_NOSIGNAL); }
void send_record(const Record& record) { send_packet(encode(record)); }
void say(const std::string& text) { send_record(LogRecord{2, text}); }
void ready() { send_record(ReadyRecord{"9.9", true}); }

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

/// Says what it gets: each kind once, and each position of axis 1.
int tell_what_comes() {
  ready();
  std::map<std::size_t, bool> seen;
  while (const auto record = receive()) {
    if (!seen[record->index()]) say("kind " + std::to_string(record->index()));
    seen[record->index()] = true;
    const auto* const samples = std::get_if<SamplesRecord>(&*record);
    if (samples == nullptr) continue;
    for (const AxisSample& axis : samples->axes)
      for (const Value& value : axis.values)
        if (axis.axis == 1) say("axis 1 is at " + std::to_string(value.value));
  }
  return axisgate::link::kExitGatewayGone;
}

const std::map<std::string, std::function<int()>> kBehaviours{
    {"normal", [] { return ready(), read_on(); }},
    {"says how nice it is",
     [] { return ready(), say("nice: " + std::to_string(getpriority(PRIO_PROCESS, 0))), read_on(); }},
    {"sends garbage",
     [] {
       return ready(), send_packet({99, 99, 99}), read_on();
     }},
    {"asks for something", [] { return ready(), send_record(SamplesRecord{}), read_on(); }},
    {"is ready twice", [] { return ready(), ready(), read_on(); }},
    {"closes and goes on",
     [] {
       ready();
       close(kLink);
       for (;;) pause();
       return 0;
     }},
    {"tells what comes", tell_what_comes},
};

}  // namespace

int main(int argc, char** argv) {
  const char* const how = std::getenv("FAKE_WEB");
  const std::string name = how == nullptr ? "normal" : how;
  if (name == "says its command line") {
    ready();
    for (int i = 1; i < argc; ++i) say(argv[i]);
    return read_on();
  }
  if (name.starts_with("ends with ")) return std::atoi(name.c_str() + 10);
  return kBehaviours.at(name)();
}
