// SPDX-License-Identifier: Apache-2.0
// Whose state a reader is to be sent next: each axis on change, at most each min_period, at least each max_period.
// Promises that of several the one that is due longest comes first, so that none is passed over for ever, and that an
// axis waits in one place only: where the reader is slow, the newest state is what it gets. Never holds a state.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "gateway/image/axis_image.hpp"

namespace axisgate::feed {

class AxisFeed {
 public:
  AxisFeed(Duration min_period, Duration max_period) : min_period_(min_period), max_period_(max_period) {}

  /// An axis that there is, due at once.
  void add(AxisNumber axis, Instant now);
  /// It is gone.
  void remove(AxisNumber axis);
  /// Something in its state has changed. An axis that was not added: nothing.
  void changed(AxisNumber axis, Instant now);
  /// Whoever reads knows nothing yet.
  void all_due(Instant now);
  /// The axis whose turn it is; it counts as sent.
  [[nodiscard]] std::optional<AxisNumber> next(Instant now);
  /// How many are due now.
  [[nodiscard]] std::size_t waiting(Instant now) const;
  /// When the next one is due; kNever without axes.
  [[nodiscard]] Instant due() const { return queue_.empty() ? kNever : queue_.begin()->at; }

 private:
  struct Turn {
    Instant at;
    std::uint64_t order = 0;  ///< of those due at one instant, the one that waits longest
    AxisNumber axis = 0;
    friend auto operator<=>(const Turn&, const Turn&) = default;
  };
  struct Place {
    Instant sent = kLongAgo;
    Turn turn;
  };
  void place(Place& place, Instant at);

  Duration min_period_;
  Duration max_period_;
  std::map<AxisNumber, Place> places_;
  std::set<Turn> queue_;  ///< one turn for each axis
  std::uint64_t order_ = 0;
};

}  // namespace axisgate::feed
