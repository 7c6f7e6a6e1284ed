// SPDX-License-Identifier: Apache-2.0
// One line an event, to a sink the application chooses: stderr in the product, a vector in tests and simulation.
// Promises that a line is never longer than kMaxLogLine, that writing one never throws or waits for a disk, and, once
// it is limited, that nothing outside can fill it. Never decides anything: a failing log changes no behaviour.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/core/log_limit.hpp"

namespace axisgate {

inline constexpr std::size_t kMaxLogLine = 512;

[[nodiscard]] std::string_view text(LogLevel level);

/// A link could not be opened and goes on trying: a warning in the log, and a reason to end for who does not try again.
struct OpeningFailure {
  const LogSource& source;
  std::string_view why;
};

/// Passed by reference to whoever logs; owned by the composition root.
class Log {
 public:
  using Sink = std::function<void(LogLevel, const LogSource& source, std::string_view message)>;
  using OnOpeningFailure = std::function<void(const OpeningFailure&)>;
  Log() = default;
  /// `on_opening_failure` is called after the line of it was written.
  explicit Log(Sink sink, LogLevel most_detailed = LogLevel::info, OnOpeningFailure on_opening_failure = nullptr);

  void set_level(LogLevel most_detailed) { most_detailed_ = most_detailed; }
  [[nodiscard]] bool wants(LogLevel level) const { return sink_ != nullptr && level <= most_detailed_; }
  /// From here on no kind of line comes more often than its pace allows; lines of debugging are not limited, since
  /// somebody has asked for them.
  void limit(std::function<Instant()> now);
  void write(LogLevel level, const LogSource& source, std::string_view message, LogPace pace = LogPace::minute) const;
  /// Of no axis and no bus: "modbus", "gateway".
  void write(LogLevel level, std::string_view source, std::string_view message, LogPace pace = LogPace::minute) const;
  void write(const OpeningFailure& failure) const;
  /// Of a limited log, from time to time: what was left out and no later line has told.
  void tell_left_out() const;

 private:
  struct Limit {
    std::function<Instant()> now;
    LogLimit of_kinds{};
  };

  std::shared_ptr<Limit> limit_;
  Sink sink_;
  LogLevel most_detailed_ = LogLevel::info;
  OnOpeningFailure on_opening_failure_;
};

}  // namespace axisgate
