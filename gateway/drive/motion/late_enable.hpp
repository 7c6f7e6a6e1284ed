// SPDX-License-Identifier: Apache-2.0
// An enable that may still come although its client was answered that it has failed, or that nobody knows. Pure:
// instants go in. Promises that torque which comes so late is to be taken away again as long as it can be that
// enable's, and never once a later enable was accepted. Never sends.
#pragma once

#include "gateway/core/clock.hpp"

namespace axisgate::drive {

class LateEnable {
 public:
  /// So long after its answer an enable may come late.
  static constexpr Duration kWatched = std::chrono::seconds(5);

  /// It was withdrawn.
  void withdrawn(Instant now) { withdrawn_until_ = now + kWatched; }
  /// Its outcome is unknown.
  void unknown(Instant now) { unknown_until_ = now + kWatched; }
  /// The drive is out of sight: an axis that is enabled when it comes back is adopted. A withdrawal stands.
  void lost() { unknown_until_ = kLongAgo; }
  /// An enable was accepted: torque is wanted.
  void wanted() { withdrawn_until_ = unknown_until_ = kLongAgo; }

  [[nodiscard]] bool of_unknown(Instant now) const { return now < unknown_until_; }
  /// Torque that comes now is nobody's.
  [[nodiscard]] bool expected(Instant now) const { return of_unknown(now) || now < withdrawn_until_; }
  /// It has come, and is taken back.
  void taken_back() { unknown_until_ = kLongAgo; }

 private:
  Instant withdrawn_until_ = kLongAgo;
  Instant unknown_until_ = kLongAgo;
};

}  // namespace axisgate::drive
