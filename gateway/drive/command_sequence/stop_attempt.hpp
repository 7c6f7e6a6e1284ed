// SPDX-License-Identifier: Apache-2.0
// The stop of a command sequence: how often it was sent, how long it may take to show, and whether it has shown. Pure.
// Promises that it is sent three times at most, that its time in all begins with its first look however often it is
// repeated, and that it counts as confirmed only where nothing of it was withheld. Never sends.
#pragma once

#include <algorithm>

#include "gateway/core/clock.hpp"

namespace axisgate::drive {

class StopAttempt {
 public:
  static constexpr int kAttempts = 3;  // design 3.4
  static constexpr int kLooks = 3;     // as many as an object is asked before it is given up

  [[nodiscard]] bool may_repeat() const { return attempts_ + 1 < kAttempts; }
  void repeat() { ++attempts_; }

  /// A wait of it begins that would end at `until`; not shown by `repeat_at`, the stop is sent once more. Gives when
  /// the wait ends. `by_motor`: the motor alone shows its end; such waits have a time of their own.
  [[nodiscard]] Instant begin_wait(bool by_motor, Instant until, Instant repeat_at) {
    Instant& in_all = by_motor ? motor_until_ : until_;
    if (in_all == kNever) in_all = until;
    repeat_at_ = repeat_at;
    return in_all;
  }
  [[nodiscard]] bool repeat_is_due(Instant now) const { return now >= repeat_at_; }
  /// It was acknowledged, and a state read later shows that the drive goes on.
  void was_not_heeded() { unheeded_ = true; }
  [[nodiscard]] bool unheeded() const { return unheeded_; }

  /// A look for its effect came to nothing: false after kLooks in a row. An axis whose state nobody tells must not keep
  /// its line.
  [[nodiscard]] bool may_look_again() { return ++looks_ < kLooks; }
  void was_answered() { looks_ = 0; }

  /// Something of it was not sent, as it could have enabled, or not seen to act.
  void withhold() { withheld_ = true; }
  /// A state was read after its last sending.
  void state_was_read() { confirmed_ = confirmed_ || !withheld_; }
  [[nodiscard]] bool confirmed() const { return confirmed_; }

  /// The rest of its write batch was queued again, without the stop's precedence.
  void hand_over() { handed_over_ = true; }
  [[nodiscard]] bool handed_over() const { return handed_over_; }

 private:
  int looks_ = 0;                 ///< in vain, in a row
  int attempts_ = 0;              ///< beyond the first
  Instant until_ = kNever;        ///< of its waits together
  Instant motor_until_ = kNever;  ///< and of those that the motor alone shows the end of
  Instant repeat_at_ = kNever;
  bool unheeded_ = false;
  bool withheld_ = false;
  bool confirmed_ = false;
  bool handed_over_ = false;
};

}  // namespace axisgate::drive
