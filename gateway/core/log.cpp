// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/log.hpp"

#include <array>
#include <utility>

#include "gateway/core/bytes.hpp"
#include "gateway/core/line_bucket.hpp"

namespace axisgate {

std::string_view text(LogLevel level) {
  static constexpr std::array<std::string_view, 4> kNames{"error", "warning", "info", "debug"};
  return kNames.at(static_cast<std::size_t>(level));
}

Log::Log(Sink sink, LogLevel most_detailed, OnOpeningFailure on_opening_failure)
    : sink_(std::move(sink)), most_detailed_(most_detailed), on_opening_failure_(std::move(on_opening_failure)) {}

void Log::limit(std::function<Instant()> now) { limit_ = std::make_shared<Limit>(Limit{std::move(now)}); }

void Log::write(LogLevel level, const LogSource& source, std::string_view message, LogPace pace) const {
  if (!wants(level)) return;
  message = message.substr(0, kMaxLogLine);
  if (limit_ == nullptr || level == LogLevel::debug) return sink_(level, source, message);
  const auto left_out = limit_->of_kinds.takes({level, source, message}, pace, limit_->now());
  if (!left_out) return;
  if (*left_out == 0) return sink_(level, source, message);
  const std::string counted = left_out_text(*left_out);
  sink_(level, source, std::string(message.substr(0, kMaxLogLine - counted.size())) + counted);
}

void Log::write(LogLevel level, std::string_view source, std::string_view message, LogPace pace) const {
  if (wants(level)) write(level, LogSource{.words = std::string(source)}, message, pace);
}

void Log::tell_left_out() const {
  if (limit_ == nullptr) return;
  for (const LogLimit::LeftOut& each : limit_->of_kinds.over(limit_->now())) {
    const std::string counted =
        each.lines == 1 ? " (told late)" : " (the newest of " + std::to_string(each.lines) + " left out)";
    sink_(each.level, each.source, each.newest.substr(0, kMaxLogLine - counted.size()) + counted);
  }
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
