// SPDX-License-Identifier: Apache-2.0
// One line an event, to a sink the application chooses: stderr in the product, a vector in tests and simulation.
// Promises that a line is never longer than kMaxLogLine and that writing one never throws or waits for a disk.
// Never decides anything: a failing log changes no behaviour.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace axisgate {

enum class LogLevel : std::uint8_t { error, warning, info, debug };
inline constexpr std::size_t kMaxLogLine = 512;

[[nodiscard]] std::string_view text(LogLevel level);

/// A link could not be opened and goes on trying: a warning in the log, and a reason to end for who does not try again.
struct OpeningFailure {
  std::string_view source;
  std::string_view why;
};

/// Passed by reference to whoever logs; owned by the composition root.
class Log {
 public:
  using Sink = std::function<void(LogLevel, std::string_view source, std::string_view message)>;
  using OnOpeningFailure = std::function<void(const OpeningFailure&)>;
  Log() = default;
  /// `on_opening_failure` is called after the line of it was written.
  explicit Log(Sink sink, LogLevel most_detailed = LogLevel::info, OnOpeningFailure on_opening_failure = nullptr);

  void set_level(LogLevel most_detailed) { most_detailed_ = most_detailed; }
  [[nodiscard]] bool wants(LogLevel level) const { return sink_ != nullptr && level <= most_detailed_; }
  /// `source` says who speaks: "bus lift-serial", "axis 1", "modbus 127.0.0.1:50312".
  void write(LogLevel level, std::string_view source, std::string_view message) const;
  void write(const OpeningFailure& failure) const;

 private:
  Sink sink_;
  LogLevel most_detailed_ = LogLevel::info;
  OnOpeningFailure on_opening_failure_;
};

}  // namespace axisgate
