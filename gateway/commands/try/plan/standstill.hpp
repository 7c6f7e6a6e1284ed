// SPDX-License-Identifier: Apache-2.0
// Whether a motor stands, by its position: by samples of it alone, and by when each was taken. Pure. Promises that one
// which only trembles stands, and that a position nobody has sampled since says nothing. Never looks at a velocity.
#pragma once

#include <optional>

#include "gateway/image/axis_image.hpp"
#include "gateway/model/cia402.hpp"

namespace axisgate::commands {

inline constexpr double kSecondsPerMinute = 60;
[[nodiscard]] inline double in_seconds(Duration time) { return std::chrono::duration<double>(time).count(); }
/// Turns of the motor; none: not good now.
[[nodiscard]] std::optional<double> turns_of(const AxisImage& image);
/// rpm, signed; none: not good now.
[[nodiscard]] std::optional<double> rpm_of(const AxisImage& image);
/// Its motor has torque, or may have it: input quick_stop_active says no more than that a stop is latched.
[[nodiscard]] bool may_hold_torque(const AxisImage& image);

class Standstill {
 public:
  /// A motor that has not moved for so long stands.
  static constexpr Duration kStill = std::chrono::milliseconds(300);
  /// Less is no motion.
  static constexpr double kTremble = 0.003;  // turns

  /// `from`: samples before it say nothing.
  explicit Standstill(Instant from) : from_(from) {}
  void look(const AxisImage& image);
  [[nodiscard]] bool stands() const { return at_ && newest_ - here_since_ >= kStill; }
  /// When it was seen to turn last; `from` where it was not.
  [[nodiscard]] Instant turned() const { return turned_; }

 private:
  Instant from_;
  Instant newest_ = from_;
  Instant turned_ = from_;
  Instant here_since_ = from_;  ///< the first sample that showed it where it is
  std::optional<double> at_;
};

}  // namespace axisgate::commands
