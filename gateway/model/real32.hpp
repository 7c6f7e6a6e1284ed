// SPDX-License-Identifier: Apache-2.0
// IEEE 754 single precision (REAL32) as a whole number that is in the same order: its sign, and the bits below the
// sign. Promises that 0 and -0 are 0, that neighbours are one apart, and one rounding. Never goes through floating
// point.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/core/rational.hpp"

namespace axisgate::model {

/// Of the largest one; what lies above is infinite or no number.
inline constexpr std::int64_t kLargestReal = 0x7F7FFFFF;
inline constexpr std::uint32_t kRealSign = 0x80000000;

/// Of its 32 bits.
[[nodiscard]] constexpr std::int64_t real_of_bits(std::uint32_t bits) {
  const auto magnitude = static_cast<std::int64_t>(bits & ~kRealSign);
  return (bits & kRealSign) != 0 ? -magnitude : magnitude;
}
[[nodiscard]] constexpr std::uint32_t bits_of_real(std::int64_t real) {
  return static_cast<std::uint32_t>(real < 0 ? -real : real) | (real < 0 ? kRealSign : 0U);
}
/// The nearest to numerator / denominator, of two the even one; none where that is beyond the largest. `denominator`
/// above 0, below 2^63; `numerator` within 2^126.
[[nodiscard]] std::optional<std::int64_t> real_of(Int128 numerator, Int128 denominator);
/// Its value times this, rounded half away from zero; none where it has no value, or 64 bits do not hold it.
[[nodiscard]] std::optional<std::int64_t> scaled_real(std::int64_t real, const Rational& by);

}  // namespace axisgate::model
