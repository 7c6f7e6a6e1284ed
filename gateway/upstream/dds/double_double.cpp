// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/double_double.hpp"

#include <cmath>

namespace axisgate::dds {
namespace {

// T. J. Dekker, "A floating-point technique for extending the available precision", 1971.
DoubleDouble sum(double larger, double smaller) {
  const double high = larger + smaller;
  return {high, smaller - (high - larger)};
}

DoubleDouble product(double a, double b) {
  const double high = a * b;
  return {high, std::fma(a, b, -high)};
}

}  // namespace

DoubleDouble DoubleDouble::of(std::int64_t value) {
  // Two halves of 32 bits each are exact, and so is their sum in two doubles.
  constexpr double kHalf = 4294967296.0;
  const auto upper = static_cast<double>(value >> 32) * kHalf;
  const auto lower = static_cast<double>(value & 0xFFFFFFFF);
  return std::fabs(upper) >= lower ? sum(upper, lower) : sum(lower, upper);
}

DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = product(a.high, b.high);
  return sum(high.high, high.low + (a.high * b.low + a.low * b.high));
}

DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double quotient = a.high / b.high;
  const DoubleDouble back = product(quotient, b.high);
  const double rest = (((a.high - back.high) - back.low) + a.low) - quotient * b.low;
  return sum(quotient, rest / b.high);
}

double rounded(const DoubleDouble& value) {
  const double whole = std::trunc(value.high);
  const double toward = value.high < 0 ? -1 : 1;
  const double part = std::fabs(value.high - whole);
  if (part != 0.5) {
    // Where `high` is whole, `low` is less than a half and changes nothing.
    return part > 0.5 ? whole + toward : whole;
  }
  // A half, as far as one double can tell. What is only the arithmetic's own error does not make it less.
  constexpr double kError = 1e-29;
  const bool less = value.low * toward < -kError * std::fabs(value.high);
  return less ? whole : whole + toward;
}

}  // namespace axisgate::dds
