// SPDX-License-Identifier: Apache-2.0
// The requests of a Modbus RTU master as they become whole, told by their length: a real drive waits for the silence,
// which would be time of its own. Promises those with a right checksum. Never looks further into one.
#pragma once

#include <optional>
#include <utility>

#include "tests/simulated/rtu_frame.hpp"

namespace axisgate::bench {

class RtuRequests {
 public:
  [[nodiscard]] std::optional<simulated::RtuFrame> take(std::uint8_t byte, simulated::Time now) {
    if (now - last_ > kLongestPause) begun_.clear();
    last_ = now;
    begun_.push_back(byte);
    if (begun_.size() < kHead || begun_.size() < whole()) return std::nullopt;
    return simulated::open_rtu(std::exchange(begun_, {}));
  }

 private:
  static constexpr simulated::Time kLongestPause = std::chrono::milliseconds(20);
  static constexpr std::size_t kHead = 7;  // up to the byte count of a write of several registers

  [[nodiscard]] std::size_t whole() const {
    return begun_[1] == simulated::function::write_several ? kHead + begun_[6] + 2U : 8U;
  }

  simulated::RtuBytes begun_;
  simulated::Time last_{};
};

}  // namespace axisgate::bench
