// SPDX-License-Identifier: Apache-2.0
// What the motor did in the last seconds, to hold against what is shown of it. Promises to allow for the way of a
// value from the drive to the reader. Never asks the gateway.
#pragma once

#include <deque>
#include <functional>

#include "tests/model/contract.hpp"

namespace axisgate::test::judged {

class History {
 public:
  void add(const reference::Sight& sight) {
    seen_.push_back(sight);
    if (seen_.size() > kMost) seen_.pop_front();
  }
  /// Within the last `age_ms`, or too long ago to tell.
  [[nodiscard]] bool was_at(std::int64_t position, std::int64_t age_ms) const;
  [[nodiscard]] bool was_enabled(bool enabled, std::int64_t age_ms) const;
  /// Within the last `ms`, or too long ago to tell, it was one that this holds for.
  [[nodiscard]] bool was(std::int64_t ms, const std::function<bool(const reference::Sight&)>& holds) const;

 private:
  static constexpr std::size_t kMost = 4'000;
  /// From the drive's answer to its sample, a slow line's frames included.
  static constexpr std::int64_t kReadingMs = 60;
  std::deque<reference::Sight> seen_;
};

}  // namespace axisgate::test::judged
