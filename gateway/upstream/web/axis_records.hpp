// SPDX-License-Identifier: Apache-2.0
// The image of one axis as records: what is fixed of it, and what is newest of it.
// Promises the numbers that registers show at the same moment, by the rules of gateway/image/shown.hpp, and of the
// values those alone that are other, or were confirmed again, since the sample before. Never changes the image.
#pragma once

#include <array>
#include <cstdint>

#include "gateway/image/axis_image.hpp"
#include "gateway/upstream/web/web_facts.hpp"
#include "gateway/upstream/web_link/records.hpp"

namespace axisgate::web {

/// What a sample said of each quantity last.
class SentValues {
 public:
  /// It is to be said of this one: and it counts as said.
  [[nodiscard]] bool is_new(std::size_t quantity, std::int64_t value, Instant at) {
    const Sent now{value, at};
    if (sent_[quantity] == now) return false;
    sent_[quantity] = now;
    return true;
  }

 private:
  struct Sent {
    std::int64_t value = 0;
    Instant at = kNever;
    friend bool operator==(const Sent&, const Sent&) = default;
  };
  std::array<Sent, kQuantityCount> sent_{};
};

[[nodiscard]] AxisInfoRecord axis_info(const AxisImage& axis, const AxisFacts& facts);
[[nodiscard]] AxisSample axis_sample(const AxisImage& axis, SentValues& sent, Instant now);

/// More than its encoding takes, whatever it says.
[[nodiscard]] std::size_t size_bound(const AxisSample& sample);

}  // namespace axisgate::web
