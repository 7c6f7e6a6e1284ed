// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/rational.hpp"

#include <limits>
#include <stdexcept>

namespace axisgate {
namespace {

Int128 gcd(Int128 a, Int128 b) {
  while (b != 0) {
    const Int128 rest = a % b;
    a = b;
    b = rest;
  }
  return a < 0 ? -a : a;
}

constexpr Int128 kMax = std::numeric_limits<std::int64_t>::max();
constexpr Int128 kMin = std::numeric_limits<std::int64_t>::min();
// 18 decimal digits always fit 64 bits.
constexpr std::size_t kMaxDigits = 18;

}  // namespace

Rational::Rational(std::int64_t numerator, std::int64_t denominator) { *this = reduced(numerator, denominator); }

Rational Rational::reduced(Int128 numerator, Int128 denominator) {
  if (denominator == 0) throw std::overflow_error("division by zero in a unit conversion");
  if (denominator < 0) {
    numerator = -numerator;
    denominator = -denominator;
  }
  const Int128 divisor = numerator == 0 ? denominator : gcd(numerator, denominator);
  numerator /= divisor;
  denominator /= divisor;
  if (numerator > kMax || numerator < kMin || denominator > kMax)
    throw std::overflow_error("a unit conversion needs more than 64 bits");
  Rational out;
  out.numerator_ = static_cast<std::int64_t>(numerator);
  out.denominator_ = static_cast<std::int64_t>(denominator);
  return out;
}

std::optional<Rational> Rational::parse(std::string_view text) {
  const std::size_t slash = text.find('/');
  const std::optional<Rational> above = parse_decimal(text.substr(0, slash));
  if (slash == std::string_view::npos) return above;
  const std::optional<Rational> below = parse_decimal(text.substr(slash + 1));
  if (!above || !below || below->numerator() == 0) return std::nullopt;
  try {
    return *above / *below;
  } catch (const std::overflow_error&) {
    return std::nullopt;
  }
}

std::optional<Rational> Rational::parse_decimal(std::string_view decimal) {
  bool negative = false;
  if (!decimal.empty() && (decimal.front() == '-' || decimal.front() == '+')) {
    negative = decimal.front() == '-';
    decimal.remove_prefix(1);
  }
  std::int64_t digits = 0;
  std::int64_t denominator = 1;
  std::size_t count = 0;
  bool fraction = false;
  for (const char c : decimal) {
    if (c == '.' && !fraction) {
      fraction = true;
    } else if (c >= '0' && c <= '9' && ++count <= kMaxDigits) {
      digits = digits * 10 + (c - '0');
      if (fraction) denominator *= 10;
    } else {
      return std::nullopt;
    }
  }
  if (count == 0) return std::nullopt;
  return Rational(negative ? -digits : digits, denominator);
}

Rational operator*(const Rational& a, const Rational& b) {
  return Rational::reduced(static_cast<Int128>(a.numerator_) * b.numerator_,
                           static_cast<Int128>(a.denominator_) * b.denominator_);
}

Rational operator/(const Rational& a, const Rational& b) {
  return Rational::reduced(static_cast<Int128>(a.numerator_) * b.denominator_,
                           static_cast<Int128>(a.denominator_) * b.numerator_);
}

Rational Rational::inverse() const {
  if (numerator_ <= 0) return Rational(denominator_, numerator_);
  // Lowest terms stay lowest terms: this is done for each value of each sample.
  Rational out;
  out.numerator_ = denominator_;
  out.denominator_ = numerator_;
  return out;
}

// `denominator` above 0.
std::optional<std::int64_t> Rational::rounded(Int128 numerator, Int128 denominator) {
  Int128 quotient = numerator / denominator;
  const Int128 rest = numerator - quotient * denominator;
  const Int128 magnitude = rest < 0 ? -rest : rest;
  if (magnitude >= denominator - magnitude) quotient += numerator < 0 ? -1 : 1;
  if (quotient > kMax || quotient < kMin) return std::nullopt;
  return static_cast<std::int64_t>(quotient);
}

std::optional<std::int64_t> Rational::scale(std::int64_t value) const {
  return rounded(static_cast<Int128>(value) * numerator_, denominator_);
}

std::optional<std::int64_t> Rational::over(std::int64_t divisor) const {
  if (divisor == 0) return std::nullopt;
  const Int128 denominator = static_cast<Int128>(divisor) * denominator_;
  return divisor < 0 ? rounded(-Int128{numerator_}, -denominator) : rounded(numerator_, denominator);
}

double Rational::to_double() const {
  return static_cast<double>(static_cast<long double>(numerator_) / static_cast<long double>(denominator_));
}

}  // namespace axisgate
