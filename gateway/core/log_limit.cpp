// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/log_limit.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace axisgate {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_hex(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }
bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

bool is_address(std::string_view word) {
  constexpr std::ptrdiff_t kDots = 3;
  return std::ranges::count(word, '.') == kDots && is_digit(word.back()) && word.find("..") == std::string_view::npos;
}

/// A byte as lines of bytes have it, a number in hexadecimal, or a part of a GUID.
bool is_hex_number(std::string_view word) {
  constexpr std::string_view kPrefix = "0x";
  constexpr std::size_t kByte = 2, kGuidPart = 6;
  const bool marked = word.starts_with(kPrefix);
  const bool guid = word.size() >= kGuidPart && std::ranges::any_of(word, is_digit);
  if (!marked && !guid && word.size() != kByte) return false;
  return std::all_of(word.begin() + (marked ? kByte : 0), word.end(), is_hex);
}

void put_number(std::string& out) {
  // Bytes in a row are one number, however many there are.
  if (out.ends_with("# ")) out.pop_back();
  if (!out.ends_with('#')) out += '#';
}

/// What the number behind it names is another subject: "node 5", "/modbus_tcp/0/listen".
bool names_a_subject(std::string_view before) {
  return before.ends_with("node ") || before.ends_with("axis ") || before.ends_with('/');
}

}  // namespace

std::string log_kind(std::string_view message) {
  std::string out;
  out.reserve(message.size());
  while (!message.empty()) {
    const char first = message.front();
    if (!is_word(first)) {
      out += first;
      message.remove_prefix(1);
      continue;
    }
    const auto dotted =
        std::find_if_not(message.begin(), message.end(), [](char c) { return is_digit(c) || c == '.'; });
    const std::string_view number(message.begin(), dotted);
    if (!number.empty() && is_address(number)) {
      out += number;
      message.remove_prefix(number.size());
      continue;
    }
    const auto end = std::find_if_not(message.begin(), message.end(), is_word);
    const std::string_view word(message.begin(), end);
    if (names_a_subject(out)) {
      out += word;
    } else if (is_hex_number(word)) {
      put_number(out);
    } else {
      for (const char c : word) {
        if (is_digit(c))
          put_number(out);
        else
          out += c;
      }
    }
    message.remove_prefix(word.size());
  }
  return out;
}

// Those of which nothing is left to be told make way.
bool LogLimit::has_room(LogPace pace, Instant now) {
  const std::size_t most = pace == LogPace::second ? kMaxKinds : kMaxKinds - kKindsOfCommands;
  if (kinds_.size() < most) return true;
  std::erase_if(
      kinds_, [now](const auto& each) { return each.second.left_out.lines == 0 && now - each.second.told >= kMinute; });
  return kinds_.size() < most;
}

std::optional<std::uint64_t> LogLimit::takes(const Line& line, LogPace pace, Instant now) {
  if (pace == LogPace::each) return 0;
  std::string key(line.source.words);
  key += '\n';
  key += log_kind(line.message);
  auto found = kinds_.find(key);
  if (found == kinds_.end()) {
    if (!has_room(pace, now)) {
      ++of_other_kinds_;
      return std::nullopt;
    }
    kinds_.emplace(std::move(key), Kind{now, {}});
    return 0;
  }
  Kind& kind = found->second;
  if (now - kind.told >= (pace == LogPace::second ? kSecond : kMinute)) {
    kind.told = now;
    return std::exchange(kind.left_out, {}).lines;
  }
  kind.left_out = {line.level, line.source, std::string(line.message), kind.left_out.lines + 1};
  return std::nullopt;
}

std::vector<LogLimit::LeftOut> LogLimit::over(Instant now) {
  std::vector<LeftOut> out;
  for (auto& [key, kind] : kinds_) {
    if (kind.left_out.lines == 0 || now - kind.told < kMinute) continue;
    out.push_back(std::exchange(kind.left_out, {}));
    kind.told = now;
  }
  std::erase_if(kinds_, [now](const auto& each) { return now - each.second.told >= kMinute; });
  if (of_other_kinds_ > 0 && (others_told_ == kLongAgo || now - others_told_ >= kMinute)) {
    others_told_ = now;
    out.push_back({LogLevel::warning,
                   {.words = "log"},
                   "more kinds of lines within a minute than are told apart",
                   std::exchange(of_other_kinds_, 0)});
  }
  return out;
}

}  // namespace axisgate
