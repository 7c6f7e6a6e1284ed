// SPDX-License-Identifier: Apache-2.0
// Which lines the log takes: of what is outside us one a minute of a kind and its subject, of what was commanded one a
// second. Pure: lines and instants in, verdicts out.
// Promises that the first line of a kind is told as it is, that what is left out is counted and told within a minute,
// and that memory is bounded whatever is said. Never looks at a clock, and never alters a line.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/log_source.hpp"

namespace axisgate {

enum class LogLevel : std::uint8_t { error, warning, info, debug };

/// How often a line of one kind may come.
enum class LogPace : std::uint8_t {
  minute,  ///< what lines, drives and clients can repeat
  second,  ///< what an accepted command, a stop of the gateway or a fault did
  each,    ///< what a person asked this process for: its start, a reload, --decode
};

/// A line without what differs between two of its kind: its numbers. Those that say who stay: an IPv4 address, a node,
/// an axis, a place in the configuration.
[[nodiscard]] std::string log_kind(std::string_view message);

class LogLimit {
 public:
  static constexpr Duration kMinute = std::chrono::minutes(1);
  static constexpr Duration kSecond = std::chrono::seconds(1);
  /// Kinds of a minute that are told apart. What is new beyond them is counted in one line.
  static constexpr std::size_t kMaxKinds = 1024;
  /// Of them for commands, stops and faults alone, however many kinds come from outside.
  static constexpr std::size_t kKindsOfCommands = 256;

  struct Line {
    LogLevel level = LogLevel::info;
    const LogSource& source;
    std::string_view message;
  };
  /// With how many of its kind were left out since the last one; none: it is left out as well.
  [[nodiscard]] std::optional<std::uint64_t> takes(const Line& line, LogPace pace, Instant now);

  /// Lines that were left out, and that no other has told of within their minute.
  struct LeftOut {
    LogLevel level = LogLevel::info;
    LogSource source{};
    std::string newest{};
    std::uint64_t lines = 0;
  };
  [[nodiscard]] std::vector<LeftOut> over(Instant now);

 private:
  struct Kind {
    Instant told = kLongAgo;
    LeftOut left_out{};
  };
  [[nodiscard]] bool has_room(LogPace pace, Instant now);

  std::map<std::string, Kind, std::less<>> kinds_;
  std::uint64_t of_other_kinds_ = 0;
  Instant others_told_ = kLongAgo;
};

}  // namespace axisgate
