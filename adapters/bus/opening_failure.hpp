// SPDX-License-Identifier: Apache-2.0
// The line in the log by which a link tells that it could not be opened, and goes on trying: for the links that write
// it and for the scans, which do not go on and end with the reason. Promises that who reads it knows it by the words
// that were written. Never opens or ends anything.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/log.hpp"

namespace axisgate::bus {

inline constexpr std::string_view kGoesOnTrying = "; trying again";

inline void log_opening_failure(const Log& log, std::string_view source, const std::string& why) {
  log.write(LogLevel::warning, source, why + std::string(kGoesOnTrying) + " each second");
}

/// Why the link could not be opened; none: the line tells something else. Without such a line a scan ends all the same,
/// at its time limit.
[[nodiscard]] inline std::optional<std::string_view> opening_failure_in(std::string_view message) {
  const std::size_t words = message.find(kGoesOnTrying);
  if (words == std::string_view::npos) return std::nullopt;
  return message.substr(0, words);
}

}  // namespace axisgate::bus
