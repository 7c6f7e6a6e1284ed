// SPDX-License-Identifier: Apache-2.0
// An exact rational number for unit conversions, held in lowest terms.
// Promises exact products and one rounding, half away from zero, at the very end; a result that does not fit is no
// value. Never wraps and never goes through floating point, except to_double() for DDS, which gives the nearest double.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace axisgate {

__extension__ using Int128 = __int128;

class Rational {
 public:
  constexpr Rational() = default;
  /// `denominator` not 0. Throws std::overflow_error where lowest terms do not fit 64 bits (start-up only).
  Rational(std::int64_t numerator, std::int64_t denominator = 1);

  /// "1.414", "-3", and of two such numbers "10000/60"; "0.5e3" is not taken: as makers print them. No value where the
  /// text is none, or 64 bits do not hold it.
  [[nodiscard]] static std::optional<Rational> parse(std::string_view text);

  [[nodiscard]] std::int64_t numerator() const { return numerator_; }
  [[nodiscard]] std::int64_t denominator() const { return denominator_; }

  friend Rational operator*(const Rational& a, const Rational& b);
  /// `b` not 0.
  friend Rational operator/(const Rational& a, const Rational& b);
  friend bool operator==(const Rational&, const Rational&) = default;

  /// value * this, rounded half away from zero; no value where it does not fit 64 bits.
  [[nodiscard]] std::optional<std::int64_t> scale(std::int64_t value) const;
  /// this / divisor, rounded in the same way; no value where the divisor is 0 either.
  [[nodiscard]] std::optional<std::int64_t> over(std::int64_t divisor) const;
  /// Of 0: throws std::overflow_error.
  [[nodiscard]] Rational inverse() const;
  [[nodiscard]] double to_double() const;

 private:
  static std::optional<std::int64_t> rounded(Int128 numerator, Int128 denominator);
  static std::optional<Rational> parse_decimal(std::string_view decimal);
  static Rational reduced(Int128 numerator, Int128 denominator);
  std::int64_t numerator_ = 0;
  std::int64_t denominator_ = 1;
};

}  // namespace axisgate
