// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/history.hpp"

#include <algorithm>

namespace axisgate::test::judged {

using namespace reference;

bool History::was_at(std::int64_t position, std::int64_t age_ms) const {
  std::int64_t least = position, most = position;
  bool any = false;
  // The last one before as well: nobody may have looked since.
  const std::int64_t from_ms = seen_.back().now_ms - age_ms - kReadingMs;
  const auto inside = std::ranges::find_if(seen_, [&](const Sight& sight) { return sight.now_ms >= from_ms; });
  for (const Sight& sight : std::ranges::subrange(inside == seen_.begin() ? inside : std::prev(inside), seen_.end())) {
    least = any ? std::min(least, sight.position) : sight.position;
    most = any ? std::max(most, sight.position) : sight.position;
    any = true;
  }
  if (seen_.front().now_ms > from_ms) return true;
  return !any || (position >= least - kClose && position <= most + kClose);
}

bool History::was(std::int64_t ms, const std::function<bool(const Sight&)>& holds) const {
  const std::int64_t from_ms = seen_.back().now_ms - ms - kReadingMs;
  return seen_.front().now_ms > from_ms ||
         std::ranges::any_of(seen_, [&](const Sight& sight) { return sight.now_ms >= from_ms && holds(sight); });
}

bool History::was_enabled(bool enabled, std::int64_t age_ms) const {
  return was(age_ms, [enabled](const Sight& sight) { return sight.enabled == enabled; });
}

}  // namespace axisgate::test::judged
