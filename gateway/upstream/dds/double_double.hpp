// SPDX-License-Identifier: Apache-2.0
// A number as the unevaluated sum of two doubles, about 106 bits: so that a value scaled by a rational and by pi
// becomes the double nearest to the exact result. Promises that products and quotients are right to some 30 digits.
// Never says anything of infinities and NaN: whoever uses it has sorted them out.
#pragma once

#include <cstdint>

namespace axisgate::dds {

struct DoubleDouble {
  double high = 0;
  double low = 0;  ///< at most half a unit of `high`'s last place

  DoubleDouble() = default;
  explicit DoubleDouble(double value) : high(value) {}
  DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}
  /// Exactly.
  [[nodiscard]] static DoubleDouble of(std::int64_t value);
};

/// A turn in radians.
inline const DoubleDouble kTwoPi{6.283185307179586477, 2.449293598294706414e-16};

[[nodiscard]] DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b);
/// `b` not 0.
[[nodiscard]] DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b);

/// The nearest whole number, half away from zero.
[[nodiscard]] double rounded(const DoubleDouble& value);

}  // namespace axisgate::dds
