// SPDX-License-Identifier: Apache-2.0
// What a long command says on stderr while it works: lines that stay, and one that tells how far it is.
// Promises that on a terminal the progress is one line that is written over, and elsewhere a line now and then.
// Never writes to stdout, which is the result's.
#pragma once

#include <fmt/format.h>
#include <unistd.h>
#include <boost/noncopyable.hpp>

#include <cstdio>
#include <string_view>

#include "gateway/core/clock.hpp"

namespace axisgate::commands {

class ScanProgress : boost::noncopyable {
 public:
  static constexpr Duration kOnTerminal = std::chrono::milliseconds(100);
  static constexpr Duration kElsewhere = std::chrono::seconds(2);

  ScanProgress() : terminal_(::isatty(STDERR_FILENO) == 1) {}
  ~ScanProgress() { clear(); }

  void say(std::string_view line) {
    clear();
    fmt::print(stderr, "{}\n", line);
  }
  /// Shown if the last one is old enough.
  [[nodiscard]] bool due(Instant now) const { return now >= next_; }
  void show(std::string_view line, Instant now) {
    next_ = now + (terminal_ ? kOnTerminal : kElsewhere);
    clear();
    fmt::print(stderr, "{}{}", line, terminal_ ? "" : "\n");
    std::fflush(stderr);
    on_line_ = terminal_;
  }
  void clear() {
    if (on_line_) fmt::print(stderr, "\r\x1b[K");
    on_line_ = false;
  }

 private:
  bool terminal_;
  bool on_line_ = false;
  Instant next_ = kLongAgo;
};

}  // namespace axisgate::commands
