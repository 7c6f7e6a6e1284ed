// SPDX-License-Identifier: Apache-2.0
// The lines of a Lawicel adapter's text as they become whole. Promises them without their CR; BELL ends one as well.
// Never looks into one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace axisgate::bench {

class LawicelLines {
 public:
  [[nodiscard]] std::optional<std::string> take(std::uint8_t byte) {
    if (byte == '\r' || byte == '\a') return std::exchange(begun_, {});
    if (begun_.size() < kLongest) begun_ += static_cast<char>(byte);
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kLongest = 64;
  std::string begun_;
};

}  // namespace axisgate::bench
