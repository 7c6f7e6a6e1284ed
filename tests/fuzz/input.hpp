// SPDX-License-Identifier: Apache-2.0
// Bytes as operations: takes numbers and runs of bytes off the front of an input.
// Promises an answer also where the input is at its end: 0, and nothing. Never reads past it.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/bytes.hpp"

namespace axisgate::fuzz {

/// One argument a line, behind the name of the program.
inline std::vector<std::string> words_of(const char* program, Bytes content) {
  std::vector<std::string> words{program};
  std::string word;
  for (const Byte byte : content) {
    if (byte == 0) break;  // no argument holds one
    if (byte != '\n') {
      word += static_cast<char>(byte);
    } else {
      words.push_back(std::exchange(word, {}));
    }
  }
  if (!word.empty()) words.push_back(word);
  return words;
}

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  [[nodiscard]] bool more() const { return !rest_.empty(); }
  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t first = rest_.front();
    rest_ = rest_.subspan(1);
    return first;
  }
  std::uint16_t word() {
    const std::uint8_t high = byte();
    return static_cast<std::uint16_t>(high << 8 | byte());
  }
  std::uint32_t number() {
    const std::uint32_t high = word();
    return high << 16 | word();
  }
  /// 0 to below `limit`.
  std::size_t below(std::size_t limit) { return byte() % limit; }
  bool yes() { return (byte() & 1) != 0; }
  /// At most so many.
  Bytes bytes(std::size_t count) {
    const Bytes taken = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }

 private:
  Bytes rest_;
};

}  // namespace axisgate::fuzz
