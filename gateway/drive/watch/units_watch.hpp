// SPDX-License-Identifier: Apache-2.0
// Whether a drive's velocity and position count as its profile says they do (axis alarm units_disagree). Pure: samples
// go in. Promises to judge only a speed that is steady and above ten times standstill, within one motion (of several
// short ones a slow poll may see the way and never the speed), and to say nothing before three windows without one
// between them that fits. Never knows which of the two is wrong.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/drive/watch/timed_value.hpp"

namespace axisgate::drive {

class UnitsWatch {
 public:
  struct Rules {
    double standstill = 1;  ///< rpm
    Duration lag{};         ///< a velocity may still show what was so long ago
  };
  struct Seen {
    bool counts = false;                   ///< it answers, and does a motion whose position counts on: no homing
    std::uint64_t motion = 0;              ///< which one: none of another is in the same window
    Duration window{};                     ///< over which the change of position is taken
    std::optional<TimedValue> position{};  ///< turns
    std::optional<TimedValue> velocity{};  ///< rpm, signed
  };
  /// Both in rpm, of the newest window.
  struct Disagreement {
    double velocity = 0;
    double position = 0;
  };
  static constexpr int kWindows = 3;
  static constexpr double kSteady = 0.1;  ///< velocities of a window differ by less, as a part of the largest
  static constexpr double kOff = 0.25;    ///< more than this part of the larger of the two is off

  explicit UnitsWatch(const Rules& rules) : rules_(rules) {}

  /// New samples. Reported once; then never again until reset().
  [[nodiscard]] std::optional<Disagreement> observe(const Seen& seen);
  void reset() { *this = UnitsWatch(rules_); }

 private:
  struct Window {  ///< a time of steady velocity
    TimedValue from;
    std::optional<TimedValue> to;  ///< it is whole; velocities count for the lag longer
    double lowest = 0;
    double highest = 0;
    double sum = 0;
    int velocities = 0;
  };
  void take_velocity(const TimedValue& velocity);
  [[nodiscard]] std::optional<Disagreement> judge(const Window& window);

  Rules rules_;
  std::optional<Window> window_;
  std::uint64_t motion_ = 0;
  int off_ = 0;
  bool reported_ = false;
  Instant position_at_ = kLongAgo;
  Instant velocity_at_ = kLongAgo;
};

}  // namespace axisgate::drive
