// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/journal.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <boost/endian/conversion.hpp>
#include <cstdint>
#include <utility>

namespace axisgate::process {
namespace {

/// A value that has lines has its length before it.
void put(std::string& entry, std::string_view field, std::string_view value) {
  entry += field;
  if (value.find('\n') == std::string_view::npos) {
    entry += '=';
  } else {
    entry += '\n';
    std::array<unsigned char, sizeof(std::uint64_t)> length{};
    boost::endian::store_little_u64(length.data(), value.size());
    entry.append(length.begin(), length.end());
  }
  entry += value;
  entry += '\n';
}

}  // namespace

int priority_of(LogLevel level) {
  constexpr std::array<int, 4> kPriorities{3, 4, 6, 7};
  return kPriorities.at(static_cast<std::size_t>(level));
}

std::string journal_entry(LogLevel level, const LogSource& source, std::string_view message) {
  std::string entry;
  put(entry, "PRIORITY", std::to_string(priority_of(level)));
  put(entry, "SYSLOG_IDENTIFIER", "axisgate");
  if (source.axis != 0) put(entry, "AXIS", std::to_string(source.axis));
  if (!source.bus.empty()) put(entry, "BUS", source.bus);
  if (!source.event.empty()) put(entry, "EVENT", source.event);
  put(entry, "MESSAGE", message);
  return entry;
}

Journal::Journal(std::string socket)
    : socket_(std::move(socket)), descriptor_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

// By name each time: a journal that was started anew may have another socket there.
bool Journal::takes(std::string_view entry) const {
  sockaddr_un to{};
  if (descriptor_ < 0 || socket_.size() >= sizeof to.sun_path) return false;
  to.sun_family = AF_UNIX;
  socket_.copy(to.sun_path, socket_.size());
  // The one cast that the interface of sockets asks for.
  const auto* const address = reinterpret_cast<const sockaddr*>(&to);
  return ::sendto(descriptor_, entry.data(), entry.size(), MSG_DONTWAIT | MSG_NOSIGNAL, address, sizeof to) ==
         static_cast<ssize_t>(entry.size());
}

}  // namespace axisgate::process
