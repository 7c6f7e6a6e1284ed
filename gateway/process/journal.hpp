// SPDX-License-Identifier: Apache-2.0
// A line of the log as systemd's journal takes it with fields of its own, so that it can be asked for an axis.
// Promises that whoever writes never waits, and hears at once of what was not taken. sd_journal_sendv(3) waits for a
// journal that hangs: so the datagram is made here (https://systemd.io/JOURNAL_NATIVE_PROTOCOL). Never keeps a line.
#pragma once

#include <boost/noncopyable.hpp>
#include <string>
#include <string_view>

#include "gateway/core/log.hpp"

namespace axisgate::process {

inline constexpr std::string_view kJournalSocket = "/run/systemd/journal/socket";

/// As sd-daemon(3) counts: 3 error, 4 warning, 6 info, 7 debug.
[[nodiscard]] int priority_of(LogLevel level);
/// PRIORITY, SYSLOG_IDENTIFIER, AXIS, BUS and EVENT where there is one, MESSAGE.
[[nodiscard]] std::string journal_entry(LogLevel level, const LogSource& source, std::string_view message);

class Journal : boost::noncopyable {
 public:
  explicit Journal(std::string socket);
  ~Journal();
  /// False: it is gone, or full, or too slow.
  [[nodiscard]] bool takes(std::string_view entry) const;

 private:
  std::string socket_;
  int descriptor_;
};

}  // namespace axisgate::process
