// SPDX-License-Identifier: Apache-2.0
// One motion of a trial: how long, how fast and how far it may be, and whether what was asked, the position's rate and
// velocity_actual fit each other. Pure: images and instants go in. Promises that it is to be stopped at the first
// sample beyond a bound, whatever the drive says of itself, and that a motion which nobody can see is ended as well.
// Never knows a drive's units: it compares turns with turns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/commands/try/plan/standstill.hpp"

namespace axisgate::commands {

struct MotionAsked {
  enum class Kind : std::uint8_t {
    move,  ///< by `turns`; it ends by itself
    run,   ///< at `rpm` for `time`
    home,
  };
  Kind kind = Kind::move;
  double turns = 0;      ///< signed
  double rpm = 10;       ///< signed as the way
  Duration time{};       ///< run: so long; else at most
  double most = 0;       ///< turns: no further from where it began
  bool judged = true;    ///< false: it only has to turn
  std::uint16_t id = 0;  ///< motion_id that it gets
};

class MotionCheck {
 public:
  enum class Says : std::uint8_t { goes_on, done, stop };
  /// Asked, seen and velocity_actual may differ by so much.
  static constexpr double kWithin = 0.2;
  /// So many times as fast as asked is no overshoot: it is stopped at once.
  static constexpr double kTooFast = 2;
  static constexpr double kNoise = 5;  ///< rpm
  /// A position that was not good for so long is none.
  static constexpr Duration kBlind = std::chrono::milliseconds(500);

  MotionCheck(const MotionAsked& asked, Instant now) : asked_(asked), begun_(now), good_at_(now) {}

  [[nodiscard]] Says look(const AxisImage& image, Instant now);
  /// Why it is to be stopped; of a motion that is done what does not fit, empty: all does.
  [[nodiscard]] const std::string& why() const { return why_; }
  /// What was seen: "10.1 rpm by position, 10.0 rpm by velocity_actual, 10 asked".
  [[nodiscard]] std::string seen() const;

 private:
  struct Point {
    double value = 0;
    Instant at = kLongAgo;
  };
  Says stop(std::string why);
  void take(const AxisImage& image, Instant now);
  [[nodiscard]] std::string broken_bound(const AxisImage& image, Instant now) const;
  [[nodiscard]] std::string position_bound() const;
  [[nodiscard]] bool over(const AxisImage& image, Instant now);
  void judge();
  void judge_rates();
  [[nodiscard]] Duration nominal() const;
  /// Over the time in which it should be steady; none: too few samples.
  [[nodiscard]] std::optional<double> rate() const;
  [[nodiscard]] std::optional<double> velocity() const;
  [[nodiscard]] double way() const { return positions_.back().value - positions_.front().value; }
  [[nodiscard]] bool is_steady(Instant at) const;
  [[nodiscard]] bool long_steady() const;

  MotionAsked asked_;
  Instant begun_;
  Instant good_at_;
  std::optional<Instant> completed_;
  bool has_position_ = false;
  bool has_velocity_ = false;
  std::vector<Point> positions_, velocities_;
  std::string why_;
};

}  // namespace axisgate::commands
