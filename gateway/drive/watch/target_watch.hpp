// SPDX-License-Identifier: Apache-2.0
// A move that stands and has no end, or has one elsewhere than at its target: its window in the drive is too narrow, it
// waits for something, or position and target do not count alike. Pure: what is seen goes in, in turns. Promises to
// report each such move once. Never ends it.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "gateway/core/clock.hpp"

namespace axisgate::drive {

class TargetWatch {
 public:
  static constexpr Duration kPatience = std::chrono::seconds(5);
  /// Where the end was shown, a position is looked at once the motor had this time to settle.
  static constexpr Duration kSettled = std::chrono::seconds(1);
  /// Further than this it does not stand, turns.
  static constexpr double kStill = 0.005;

  enum class End : std::uint8_t { none, reached, failed };
  struct Seen {
    Instant at = kLongAgo;
    std::uint64_t move = 0;  ///< which one
    End end = End::none;     ///< what was shown of it
    double position = 0;
    double target = 0;
  };
  enum class Finding : std::uint8_t {
    not_reached,  ///< it stands at its target, and the drive does not say that it is there
    held,         ///< it stands elsewhere, and has not ended
    elsewhere,    ///< the drive says that it is at its target, and its position says where else
    short_of_it,  ///< it has failed
  };

  /// None: no move of the gateway's stands, or nobody knows where. `travel`: turns that are no way.
  [[nodiscard]] std::optional<Finding> observe(const std::optional<Seen>& seen, double travel) {
    if (!seen) {
      since_ = kNever;
      return std::nullopt;
    }
    if (seen->move != move_) *this = {};
    move_ = seen->move;
    if (since_ == kNever || seen->end != end_ || std::abs(seen->position - from_) > kStill) {
      since_ = seen->at;
      end_ = seen->end;
      from_ = seen->position;
    }
    if (reported_ || seen->at - since_ < (seen->end == End::none ? kPatience : kSettled)) return std::nullopt;
    const bool there = std::abs(seen->position - seen->target) <= travel;
    if (seen->end == End::reached && there) return std::nullopt;
    reported_ = true;
    if (seen->end == End::failed) return Finding::short_of_it;
    if (seen->end == End::reached) return Finding::elsewhere;
    return there ? Finding::not_reached : Finding::held;
  }

 private:
  std::uint64_t move_ = 0;
  Instant since_ = kNever;
  End end_ = End::none;
  double from_ = 0;
  bool reported_ = false;
};

}  // namespace axisgate::drive
