// SPDX-License-Identifier: Apache-2.0
// Bytes as operations: takes numbers and runs of bytes off the front of an input.
// Promises an answer also where the input is at its end: 0, and nothing. Never reads past it.
#pragma once

#include <algorithm>

#include "gateway/core/bytes.hpp"

namespace axisgate::fuzz {

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
