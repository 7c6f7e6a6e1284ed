// SPDX-License-Identifier: Apache-2.0
#include "gateway/model/real32.hpp"

#include <cstdlib>

namespace axisgate::model {
namespace {

constexpr int kFractionBits = 23;
constexpr std::int64_t kImplied = std::int64_t{1} << kFractionBits;
/// value = fraction * 2^(field - kBias), with the implied bit in the fraction.
constexpr int kBias = 127 + kFractionBits;
constexpr int kLargestField = 254;

}  // namespace

std::optional<std::int64_t> real_of(Int128 numerator, Int128 denominator) {
  if (numerator == 0) return 0;
  const bool negative = numerator < 0;
  Int128 above = negative ? -numerator : numerator;
  // So that the quotient has one bit more than a fraction: it and the rest say how to round.
  int field = kBias + 1;
  for (; above / denominator < 2 * kImplied; --field) above *= 2;
  for (; above / denominator >= 4 * kImplied; ++field) denominator *= 2;
  const auto quotient = static_cast<std::int64_t>(above / denominator);
  std::int64_t fraction = quotient / 2;
  const bool half = quotient % 2 != 0;
  if (half && (above % denominator != 0 || fraction % 2 != 0)) ++fraction;
  if (fraction == 2 * kImplied) {
    fraction = kImplied;
    ++field;
  }
  if (field > kLargestField) return std::nullopt;
  if (field < 1) return 0;  // nearer to 0 than 64 bits by 64 bits come
  const std::int64_t magnitude = (std::int64_t{field} << kFractionBits) + fraction - kImplied;
  return negative ? -magnitude : magnitude;
}

std::optional<std::int64_t> scaled_real(std::int64_t real, const Rational& by) {
  constexpr Int128 kFar = Int128{1} << 125;
  const std::int64_t magnitude = std::abs(real);
  if (magnitude > kLargestReal) return std::nullopt;
  const std::int64_t field = magnitude >> kFractionBits;
  const std::int64_t fraction = magnitude % kImplied + (field == 0 ? 0 : kImplied);
  Int128 above = Int128{fraction} * std::abs(by.numerator());
  Int128 below = by.denominator();
  int exponent = static_cast<int>(field == 0 ? 1 : field) - kBias;
  for (; exponent > 0; --exponent) {
    if (above >= kFar) return std::nullopt;  // and `below` has 63 bits at most
    above *= 2;
  }
  for (; exponent < 0; ++exponent) {
    if (below >= kFar) return 0;  // and `above` has 87 bits at most
    below *= 2;
  }
  const Int128 rest = above % below;
  const Int128 whole = above / below + (rest >= below - rest ? 1 : 0);
  if (whole > INT64_MAX) return std::nullopt;
  return (real < 0) != (by.numerator() < 0) ? -static_cast<std::int64_t>(whole) : static_cast<std::int64_t>(whole);
}

}  // namespace axisgate::model
