// SPDX-License-Identifier: Apache-2.0
// How often objects that wear out the drive's memory may be written (profile key "nvm"): 10 at once, then one a minute.
// Promises that a PLC which writes without end cannot use up a drive in a year, and that one which sets a drive up is
// not hindered. Never sees a stop: those are exempt. Pure.
#pragma once

#include <cstdint>

#include "gateway/core/clock.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::drive {

class NvmBudget {
 public:
  static constexpr int kAtOnce = 10;
  static constexpr Duration kOneMore = std::chrono::minutes(1);
  /// Where the storage is not known (nvm "unknown"), writes are counted, and this many raise the alarm: a tenth of the
  /// million a maker allows where one says so.
  static constexpr std::uint32_t kManyUnknown = 100000;

  /// Whether a write may be sent now; it counts as sent then.
  [[nodiscard]] bool take(model::Nvm nvm, Instant now);
  /// A write was refused and no other may be sent yet, or too many of unknown storage were.
  [[nodiscard]] bool alarm(Instant now) const;
  [[nodiscard]] std::uint32_t stored() const { return stored_; }    ///< writes of nvm "yes" that were sent
  [[nodiscard]] std::uint32_t unknown() const { return unknown_; }  ///< and of nvm "unknown"

 private:
  /// When the budget is whole again. Each write puts it off by kOneMore.
  Instant whole_at_ = kLongAgo;
  bool refused_ = false;
  std::uint32_t stored_ = 0;
  std::uint32_t unknown_ = 0;
};

}  // namespace axisgate::drive
