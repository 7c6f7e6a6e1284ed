// SPDX-License-Identifier: Apache-2.0
// What the DDS library has to say, as lines for the gateway's log.
// Promises at most kMaxLogLinesWaiting lines between two looks and kMaxLogLinesPerSecond; what is left out is counted.
// Never writes to a terminal or a file.
#pragma once

#include <deque>
#include <mutex>
#include <optional>

#include "gateway/upstream/dds_link/records.hpp"
#include "gateway/upstream/program/wake.hpp"

namespace axisgate::dds {

inline constexpr std::size_t kMaxLogLinesWaiting = 32;
inline constexpr std::size_t kMaxLogLinesPerSecond = 5;

class DdsLog {
 public:
  explicit DdsLog(program::Wake& wake) : wake_(wake) {}

  /// From any thread.
  void add(LogRecord line);
  /// The next line that may go out now.
  [[nodiscard]] std::optional<LogRecord> next(SteadyNs now);

 private:
  program::Wake& wake_;
  std::mutex mutex_;
  std::deque<LogRecord> lines_;
  std::size_t left_out_ = 0;
  SteadyNs second_ = 0;
  std::size_t in_second_ = 0;
};

/// The library's own output goes there from now on; the log must outlive the library's use. Errors alone.
void take_over_library_log(DdsLog& log);
/// Before the log goes. All lines written so far are in it then.
void release_library_log();

}  // namespace axisgate::dds
