// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/log.hpp"

#include <array>
#include <utility>

#include "gateway/core/bytes.hpp"

namespace axisgate {

std::string_view text(LogLevel level) {
  static constexpr std::array<std::string_view, 4> kNames{"error", "warning", "info", "debug"};
  return kNames.at(static_cast<std::size_t>(level));
}

Log::Log(Sink sink, LogLevel most_detailed, OnOpeningFailure on_opening_failure)
    : sink_(std::move(sink)), most_detailed_(most_detailed), on_opening_failure_(std::move(on_opening_failure)) {}

void Log::write(LogLevel level, std::string_view source, std::string_view message) const {
  if (wants(level)) sink_(level, source, message.substr(0, kMaxLogLine));
}

void Log::write(const OpeningFailure& failure) const {
  write(LogLevel::warning, failure.source, std::string(failure.why) + "; trying again each second");
  if (on_opening_failure_) on_opening_failure_(failure);
}

std::string hex_text(Bytes bytes) {
  static constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  out.reserve(bytes.size() * 3);
  for (const Byte b : bytes) {
    if (!out.empty()) out += ' ';
    out += kDigits[b >> 4];
    out += kDigits[b & 0x0F];
  }
  return out;
}

}  // namespace axisgate
