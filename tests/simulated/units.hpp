// SPDX-License-Identifier: Apache-2.0
// The internal units of the Kinco drives (JD 5, MD 7) in 64-bit arithmetic.
// Promises: one DEC of speed is exactly 1/16384 count per millisecond, and one DEC of acceleration changes the speed by
// exactly one DEC per millisecond (both follow from 512 * enc / 1875 and 65536 * enc / 4000000), so a 1 ms step is
// exact. Never uses floating point.
#pragma once

#include <cstdint>

namespace axisgate::simulated {

using Dec = std::int64_t;           // speed, or acceleration, or current, in the drive's unit
using FinePosition = std::int64_t;  // 1/16384 count

inline constexpr std::int64_t fine_per_count = 16384;

constexpr std::int64_t divide_rounded(std::int64_t numerator, std::int64_t denominator) {
  return (numerator >= 0 ? numerator + denominator / 2 : numerator - denominator / 2) / denominator;
}

constexpr Dec speed_dec(std::int64_t rpm, std::int64_t encoder_counts) {
  return divide_rounded(rpm * 512 * encoder_counts, 1875);
}

// `scale` 1 gives rpm, 100 gives hundredths of a rpm.
constexpr std::int64_t rpm_of(Dec speed, std::int64_t encoder_counts, std::int64_t scale = 1) {
  return divide_rounded(speed * 1875 * scale, 512 * encoder_counts);
}

constexpr Dec acceleration_dec(std::int64_t rps_per_s, std::int64_t encoder_counts) {
  return divide_rounded(rps_per_s * 65536 * encoder_counts, 4000000);
}

constexpr std::int64_t rps_per_s_of(Dec acceleration, std::int64_t encoder_counts) {
  return divide_rounded(acceleration * 4000000, 65536 * encoder_counts);
}

// Whole counts, rounded down, so that a position never jumps at zero.
constexpr std::int64_t counts_of(FinePosition position) { return position >> 14; }

}  // namespace axisgate::simulated
