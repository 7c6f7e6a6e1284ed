// SPDX-License-Identifier: Apache-2.0
// Since when a motor has not turned, by its positions: a drive's speed may be a filter's time old, so that a motor that
// has just begun to turn would be reported to stand. Its position would not. Pure.
// Promises that a motor that is held on its place and trembles has not turned. Never judges by a speed.
#pragma once

#include <optional>

#include "gateway/core/clock.hpp"

namespace axisgate::commands {

class StandWatch {
 public:
  void look(std::optional<double> turns, Instant now) {
    constexpr double kTremble = 0.01;  // turns
    if (!turns) return;
    const double away = *turns - still_at_.value_or(*turns);
    if (away > kTremble || away < -kTremble) turned_at_ = now;
    if (!still_at_ || turned_at_ == now) still_at_ = turns;
  }
  [[nodiscard]] Duration still_for(Instant now) const { return now - turned_at_; }

 private:
  std::optional<double> still_at_;  ///< turns
  Instant turned_at_ = kLongAgo;
};

}  // namespace axisgate::commands
