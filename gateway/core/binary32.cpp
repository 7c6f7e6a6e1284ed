// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/binary32.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace axisgate {
namespace {

constexpr int kFractionBits = 23, kBias = 127;
constexpr std::uint32_t kFraction = (1U << kFractionBits) - 1, kHidden = 1U << kFractionBits, kSign = 1U << 31;
constexpr std::uint32_t kLargestExponent = 0xFF;  // infinite, or NaN
constexpr int kLongestNumber = 62;                // bits of what from_binary32() gives
constexpr int kWide = 127;                        // bits of a positive Int128

int bits_of(Int128 number) {
  int bits = 0;
  for (; number != 0; number >>= 1) ++bits;
  return bits;
}

std::uint32_t exponent_of(std::uint32_t bits) { return bits >> kFractionBits & kLargestExponent; }

/// Half away from zero, of two positive numbers; no value beyond kLongestNumber bits.
std::optional<std::int64_t> rounded(Int128 numerator, Int128 denominator) {
  const Int128 whole = numerator / denominator, rest = numerator % denominator;
  const Int128 number = whole + (rest >= denominator - rest ? 1 : 0);
  return bits_of(number) > kLongestNumber ? std::nullopt : std::optional(static_cast<std::int64_t>(number));
}

}  // namespace

bool is_nan_binary32(std::uint32_t bits) { return exponent_of(bits) == kLargestExponent && (bits & kFraction) != 0; }

std::uint32_t to_binary32(std::int64_t value, const Rational& scale) {
  // At most 126 bits by 63; the quotient lies between 2^-63 and 2^126, so it is never denormal and never too large.
  const Int128 product = static_cast<Int128>(value) * scale.numerator();
  if (product == 0) return 0;
  const Int128 numerator = product < 0 ? -product : product;
  const Int128 denominator = scale.denominator();
  // quotient * 2^-exponent has 24 bits, or 23: then one more is wanted of it.
  int exponent = bits_of(numerator) - bits_of(denominator) - kFractionBits;
  const auto divided = [&](int by) {
    const Int128 over = by < 0 ? numerator << -by : numerator;
    const Int128 under = by < 0 ? denominator : denominator << by;
    return std::pair(over / under, std::pair(over % under, under));
  };
  auto [whole, fraction] = divided(exponent);
  if (bits_of(whole) <= kFractionBits) std::tie(whole, fraction) = divided(--exponent);
  const auto& [rest, under] = fraction;
  const Int128 other = under - rest;
  if (rest > other || (rest == other && whole % 2 != 0)) ++whole;
  if (bits_of(whole) > kFractionBits + 1) {
    whole >>= 1;
    ++exponent;
  }
  const auto biased = static_cast<std::uint32_t>(exponent + kFractionBits + kBias);
  return (product < 0 ? kSign : 0U) | biased << kFractionBits | (static_cast<std::uint32_t>(whole) & kFraction);
}

std::optional<std::int64_t> from_binary32(std::uint32_t bits, const Rational& scale) {
  const std::uint32_t biased = exponent_of(bits);
  if (biased == kLargestExponent) return std::nullopt;
  const std::uint32_t mantissa = (bits & kFraction) | (biased == 0 ? 0 : kHidden);
  if (mantissa == 0 || scale.numerator() == 0) return 0;
  const bool negative = ((bits & kSign) != 0) != (scale.numerator() < 0);
  const int exponent = static_cast<int>(std::max(biased, 1U)) - kBias - kFractionBits;
  Int128 numerator = static_cast<Int128>(mantissa) * scale.numerator();  // at most 87 bits
  if (numerator < 0) numerator = -numerator;
  Int128 denominator = scale.denominator();
  const Int128 shifted = exponent > 0 ? numerator : denominator;
  const int by = exponent > 0 ? exponent : -exponent;
  // What does not fit any more is so large, or so small, that the other side of the fraction does not matter.
  if (bits_of(shifted) + by > kWide - 1) return exponent > 0 ? std::nullopt : std::optional<std::int64_t>(0);
  (exponent > 0 ? numerator : denominator) = shifted << by;
  const auto number = rounded(numerator, denominator);
  return number && negative ? std::optional(-*number) : number;
}

}  // namespace axisgate
