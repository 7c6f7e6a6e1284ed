// SPDX-License-Identifier: Apache-2.0
// Whether a motor gets slower after its stop: at first, so that the stop can be answered (FirstFall), and from then on
// (Slowing). Pure: what the drive shows goes in. Promises that noise of a few rpm is taken neither for a fall nor for a
// motor that turns on, and that a ramp of forty seconds is seen to fall within one. Never looks at the state, and never
// sends.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "gateway/core/clock.hpp"
#include "gateway/model/watch_rules.hpp"

namespace axisgate::drive {

class FirstFall {
 public:
  /// A fall that noise may be counts where nothing rises for so long, and what it shows falls so often: a drive may
  /// hold what it shows for 200 ms.
  static constexpr Duration kSteadily = std::chrono::milliseconds(300);
  static constexpr int kSteps = 3;
  /// One part in so many of the speed is such a fall.
  static constexpr std::int64_t kPartSteadily = 100;

  /// How fast it was before its stop: 0.001 rpm, signed.
  void before(std::int64_t velocity);
  /// A velocity sampled after it. `standstill`: 0.001 rpm, what flickers by it does not rise. True: it falls.
  [[nodiscard]] bool falls(std::int64_t velocity, Instant sampled, std::int64_t standstill);
  /// It has been on the other side of 0: it stood, or is noise.
  [[nodiscard]] bool turned_round() const { return turned_round_; }

 private:
  std::int64_t fastest_ = 0;
  bool turned_round_ = false;
  struct {
    Instant since = kNever;
    std::int64_t from = 0;
    std::int64_t lowest = 0;
    int steps = 0;  ///< so often it was lower than ever
  } steady_;        ///< nothing has risen since
};

class Slowing {
 public:
  /// What was answered done is taken back no sooner: a ramp of forty seconds gets slower once in each of these.
  static constexpr Duration kPatience = std::chrono::seconds(1);

  /// Until then it need not get slower, and what it shows may be of before its stop.
  explicit Slowing(Instant from) : from_(from), slower_at_(from) {}
  /// A speed, without sign. True: it is slower than when it got slower last.
  bool take(double speed, Instant sampled) {
    if (!at_stop_) slower_at_ = std::max(slower_at_, sampled);
    // The speed at the stop of what had just started is shown later.
    if (!at_stop_ || (speed > slowest_ && (!slows_ || sampled < from_))) {
      at_stop_ = slowest_ = speed;
      return false;
    }
    if (speed > slowest_ - std::max(*at_stop_ / model::kPartSlower, 1.0)) return false;
    slows_ = true;
    slowest_ = speed;
    slower_at_ = std::max(slower_at_, sampled);
    return true;
  }
  /// It did not get slower within the last `window` before this sample.
  [[nodiscard]] bool ended(Instant sampled, Duration window) const { return sampled - slower_at_ >= window; }

 private:
  Instant from_;
  std::optional<double> at_stop_;
  bool slows_ = false;  ///< it has got slower once
  double slowest_ = 0;  ///< when it was seen to get slower last
  Instant slower_at_;
};

}  // namespace axisgate::drive
