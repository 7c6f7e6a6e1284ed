// SPDX-License-Identifier: Apache-2.0
// Whether a motor that should stand moves (axis alarm unexpected_motion). Pure: what the drive shows, and whether
// anything explains that it moves, go in. Promises to say nothing of what settles, creeps, was found moving or gets
// slower, and nothing by a single sample: a false alarm is worse than none. Never looks at a motor without torque, and
// never sends.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/drive/watch/slowing.hpp"
#include "gateway/drive/watch/timed_value.hpp"

namespace axisgate::drive {

class MotionWatch {
 public:
  struct Rules {
    double travel = 0.1;  ///< turns
    Duration settle = std::chrono::seconds(1);
    double standstill = 1000;  ///< 0.001 rpm: without a position it stands below, and moves above ten times
    Duration lag{};            ///< a velocity may still show what was so long ago
    bool by_position = true;   ///< false: the drive tells none
  };
  struct Seen {
    Instant at = kLongAgo;                 ///< now
    bool there = false;                    ///< it answers
    bool torque = false;                   ///< and shows torque
    bool explained = false;                ///< something but a stop explains that it moves
    std::uint64_t asked = 0;               ///< the point of what was accepted last that explains some motion
    std::uint64_t stops = 0;               ///< the point of the newest stop
    Duration window{};                     ///< in each of these a stop must make it slower
    std::optional<TimedValue> position{};  ///< turns of the motor
    std::optional<TimedValue> velocity{};  ///< 0.001 rpm, signed
  };
  struct Unexpected {
    std::optional<double> from{};  ///< turns: where it should stand; none: judged by its velocity
    double now = 0;                ///< turns, or 0.001 rpm
  };

  /// A stop may take so long to reach its drive.
  static constexpr Duration kStopGoesOut = std::chrono::seconds(1);
  /// What stays within this part of `travel` for `settle` stands.
  static constexpr double kPartStanding = 20;

  explicit MotionWatch(const Rules& rules) : rules_(rules) {}

  /// New samples, or time has passed. What is unexpected is reported once; what goes on moving after that is again.
  [[nodiscard]] std::optional<Unexpected> observe(const Seen& seen);
  /// The drive counts from elsewhere, has restarted or is another: as if it was never seen.
  void reset() { *this = MotionWatch(rules_); }

 private:
  enum class Phase : std::uint8_t {
    unwatched,
    powerless,  ///< torque that comes by itself explains no more than a stop does
    explained,
    ends,     ///< until it stands; after a stop, as long as it gets slower
    settles,  ///< until the reference
    watches,
  };
  void begin_end(Instant at, bool by_stop);
  void end_explanation(Instant at) {
    phase_ = Phase::settles;
    settled_ = at + rules_.settle;
  }
  void take_speed(double speed, Instant at, Duration window);
  [[nodiscard]] std::optional<Unexpected> take_velocity(const TimedValue& velocity, Duration window);
  [[nodiscard]] std::optional<Unexpected> take_position(const TimedValue& position, bool tells_velocity,
                                                        Duration window);
  void look_for_rest(const TimedValue& position);
  void derive_speed(const TimedValue& position, Duration window);
  /// A sample that shows it where, or as fast as, it should not be; true: the second of two.
  [[nodiscard]] bool is_second(bool beyond, Instant at);

  Rules rules_;
  Phase phase_ = Phase::unwatched;
  std::uint64_t asked_ = 0;
  std::uint64_t stops_ = 0;
  Instant ended_ = kLongAgo;        ///< what explained it was over, or the stop accepted
  Instant settled_ = kLongAgo;      ///< from then on a sample is a reference
  std::optional<TimedValue> rest_;  ///< where it has been since then
  std::optional<TimedValue> reference_;
  std::optional<Instant> beyond_;  ///< the first sample of those that show it elsewhere
  Instant position_at_ = kLongAgo;
  Instant velocity_at_ = kLongAgo;
  std::optional<TimedValue> derived_from_;
  std::optional<Slowing> slowing_;  ///< the explanation is a stop, and it was not seen to stand since
};

}  // namespace axisgate::drive
